// browser_test.mjs CHROMIUM FOLDER: every control of the pages in FOLDER does what it says. Prints each check; fails with the list of those
// that did not hold.
import { finish } from './checking.mjs';

for (const part of ['diagram', 'orbit', 'text', 'picture', 'look']) await import(`./${part}_checks.mjs`);
await finish();
