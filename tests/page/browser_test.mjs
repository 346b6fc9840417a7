// browser_test.mjs CHROMIUM FOLDER [all]: every control of the pages in FOLDER does what it says; all: how they look, on screens of all widths.
// Prints each check; fails with the list of those that did not hold.
import { finish } from './checking.mjs';

for (const part of process.argv[4] === 'all' ? ['look'] : ['diagram', 'orbit', 'text', 'picture', 'look']) await import(`./${part}_checks.mjs`);
await finish();
