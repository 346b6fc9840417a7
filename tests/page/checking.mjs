// What the checks of the pages share: a browser, how a check is reported, the table of orbits that the pages must agree with, and ways to ask
// a page. Its words: CHROMIUM FOLDER, the folder with the pages.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { launch, open, pause } from './browser.mjs';

const [chromium, folderOfPages] = process.argv.slice(2);
export const folder = folderOfPages;
export const browser = await launch(chromium);
const failures = [];

async function check(name, test) {
  const begin = Date.now();
  try {
    await test();
    console.log(`ok      ${name} (${Date.now() - begin} ms)`);
  } catch (error) {
    console.log(`FAILED  ${name}: ${error.message}`);
    failures.push(name);
  }
}

/** Opens a page, runs the test, and asks that nothing was logged and nothing requested. */
export async function checkPage(name, file, options, test) {
  await check(name, async () => {
    const opened = await open(browser, `${folder}/${file}.html`, options);
    try {
      await test(opened.page);
      assert.deepEqual(opened.troubles, [], 'console');
      assert.deepEqual(opened.requests, [], 'requests');
    } finally {
      await opened.page.close();
    }
  });
}

/** Closes the browser, and fails with the list of the checks that did not hold. */
export async function finish() {
  await browser.close();
  if (!failures.length) return;
  console.error(`${failures.length} checks failed:\n  ${failures.join('\n  ')}`);
  process.exit(1);
}

// --- the table of orbits, as `orbweaver show` has it
const [head, ...lines] = readFileSync(`${folder}/pendulum.csv`, 'utf8').trim().split('\n');
const columns = head.split(',');
export const rows = lines.map((line) => Object.fromEntries(line.split(',').map((value, i) => [columns[i], value])));

export const text = (page, selector) => page.$eval(selector, (e) => e.textContent);
export const fragment = (page) => pause(250).then(() => page.evaluate(() => Object.fromEntries(location.hash.slice(1).split('&').map((w) => w.split('=').map(decodeURIComponent)))));
export const pixels = (page, selector) => page.$eval(selector, (c) => c.toDataURL());
export const change = (page, selector, value) => page.select(selector, value);
export const item = (page, name) => page.evaluateHandle((n) => [...document.querySelectorAll('[role=treeitem]')].find((e) => e.querySelector('.name').textContent === n), name);

/** Looks over the diagram for a place where something is to be picked, and returns what the hint says there. */
export async function findOrbit(page, begin = '') {
  const found = await page.$eval('#diagram1', (canvas, wanted) => {
    const box = canvas.getBoundingClientRect();
    const tip = document.querySelector('.diagram .tip');
    for (let x = box.left + 60; x < box.right - 20; x += 5)
      for (let y = box.top + 20; y < box.bottom - 50; y += 5) {
        canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: x, clientY: y, pointerId: 99 }));
        if (!tip.hidden && tip.textContent.startsWith(wanted)) return { x, y };
      }
    return null;
  }, begin);
  assert.ok(found, `the diagram shows no ${begin}`);
  await page.mouse.move(found.x, found.y);
  return { ...found, hint: await text(page, '.diagram .tip') };
}

/** Stands in for the clipboard, which headless browsers refuse. */
export const watchClipboard = (page) => page.evaluate(() => {
  navigator.clipboard.writeText = async (copied) => void (window.copied = copied);
});

/** Stops the orbit at a part of its period. */
export const scrubTo = (page, time) => page.$eval('.player input', (e, t) => {
  e.value = t;
  e.dispatchEvent(new Event('input'));
}, String(time)).then(() => pause(150));
