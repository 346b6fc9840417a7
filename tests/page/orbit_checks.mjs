// The picked orbit: going along its family, its motion and paths, and what can be taken out.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { pause } from './browser.mjs';
import { checkPage, folder, fragment, item, pixels, rows, text, watchClipboard } from './checking.mjs';

await checkPage('the stable period-doubled orbit is found and its state copied with all digits', 'pendulum', {}, async (page) => {
  await watchClipboard(page);
  await page.select('.tree select', 'period-doubling');
  await page.click('#only-stable');
  const names = await page.$$eval('[role=treeitem] .name', (e) => e.map((n) => n.textContent));
  assert.ok(names.includes('IDb') && !names.includes('In-Phase') && !names.includes('IDa'), names.join());
  await (await item(page, 'IDb')).click();
  assert.match(await text(page, '.badge'), /^stable$/);
  await page.click('#copy-state');
  await page.waitForFunction(() => window.copied);
  const copied = JSON.parse(await page.evaluate(() => window.copied));
  const first = rows.findIndex((row) => row.period === undefined);
  assert.equal(first, -1);
  const { step } = await fragment(page);
  const row = rows.find((r) => ['th1', 'th2', 'w1', 'w2'].every((n, i) => Number(r[`state_${n}`]) === copied[i]));
  assert.ok(row, 'the state is none of the archive, to the last bit');
  assert.equal(row.step, step);
  await page.click('#copy-json');
  await page.waitForFunction(() => window.copied.startsWith('{'));
  const json = JSON.parse(await page.evaluate(() => window.copied));
  assert.deepEqual(json.state, copied);
  assert.equal(json.period, Number(row.period));
  assert.equal(json.system, 'double_pendulum');
  assert.equal(json.parameters.m1, 1);
});

await checkPage('slider and keys go along the family, brackets to others, the tree by arrows', 'pendulum', {}, async (page) => {
  await (await item(page, 'In-Phase')).click();
  const step = async () => Number((await fragment(page)).step);
  const from = await step();
  await page.keyboard.press('.');
  assert.equal(await step(), from + 1);
  await page.keyboard.press(',');
  assert.equal(await step(), from);
  await page.click('[aria-label="Next orbit"]');
  assert.equal(await step(), from + 1);
  await page.$eval('[aria-label="Orbit along the family"]', (e) => {
    e.value = '2';
    e.dispatchEvent(new Event('input'));
  });
  assert.match(await text(page, '.place'), /^Orbit 3 of/);
  await page.keyboard.press(']');
  assert.notEqual((await fragment(page)).family, 'In-Phase');
  await page.keyboard.press('[');
  assert.equal((await fragment(page)).family, 'In-Phase');
  await (await item(page, 'In-Phase')).focus();
  await page.keyboard.press('ArrowDown');
  assert.equal((await fragment(page)).family, 'IDa');
  await page.keyboard.press('ArrowUp');
  const open = (await page.$$('[role=treeitem]')).length;
  await page.keyboard.press('ArrowLeft');
  assert.ok((await page.$$('[role=treeitem]')).length < open, 'closes');
  await page.keyboard.press('ArrowRight');
  assert.equal((await page.$$('[role=treeitem]')).length, open);
  await page.click('.strip .tick');
  assert.equal(await page.$eval('.crossing', (e) => e.hidden), false);
  await page.keyboard.press('/');
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('role')), 'combobox');
});

await checkPage('the orbit moves when it is played, and all its views with it', 'pendulum', {}, async (page) => {
  const views = ['.picture canvas', '.plane canvas'];
  // On a busy machine the first picture may come late; one that moves is never the same twice.
  const shown = () => Promise.all(views.map((v) => pixels(page, v)));
  let still = await shown();
  let later = [];
  for (let tries = 0; tries < 10 && `${later}` !== `${still}`; ++tries) {
    if (tries > 0) still = later;
    await pause(300);
    later = await shown();
  }
  assert.deepEqual(later, still, 'it stands at first: less motion was asked for');
  await page.click('[aria-label=Play]');
  await pause(500);
  const moved = await Promise.all(views.map((v) => pixels(page, v)));
  moved.forEach((now, i) => assert.notEqual(now, still[i], views[i]));
  await page.click('[aria-label=Stop]');
  await page.$eval('[aria-label="Time in the period"]', (e) => {
    e.value = '0.5';
    e.dispatchEvent(new Event('input'));
  });
  await pause(100);
  assert.notEqual(await pixels(page, views[0]), moved[0]);
  const course = await pixels(page, '[aria-label^="Time courses"]');
  await page.evaluate(() => document.querySelector('.chips input').click());
  await pause(100);
  assert.notEqual(await pixels(page, '[aria-label^="Time courses"]'), course);
  assert.match(await text(page, '.values'), /Over the period.*\|μ\| = /);
  const before = await pixels(page, '.plane canvas');
  await page.select('[aria-label="Vertical axis of path 1"]', '3');
  await pause(100);
  assert.notEqual(await pixels(page, '.plane canvas'), before);
});

await checkPage('the wheel scrolls the panel of the orbit, and zooms a plot in it that was clicked', 'pendulum', {}, async (page) => {
  const box = await (await page.$('.picture canvas')).boundingBox();
  const before = await pixels(page, '.picture canvas');
  const scrolled = () => page.$eval('.orbit', (e) => e.scrollTop);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.wheel({ deltaY: 200 });
  await pause(300);
  assert.ok((await scrolled()) > 0);
  assert.equal(await pixels(page, '.picture canvas'), before);
  await page.$eval('.orbit', (e) => (e.scrollTop = 0));
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.wheel({ deltaY: 200 });
  await pause(300);
  assert.equal(await scrolled(), 0);
  assert.notEqual(await pixels(page, '.picture canvas'), before);
});

await checkPage('the path in three coordinates turns', 'pendulum', {}, async (page) => {
  await page.evaluate(() => [...document.querySelectorAll('summary')].find((e) => e.textContent === 'Path in three coordinates').click());
  await pause(200);
  const canvas = '.space canvas';
  const before = await pixels(page, canvas);
  await page.$eval(canvas, (c) => c.scrollIntoView({ block: 'center' }));
  const box = await (await page.$(canvas)).boundingBox();
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 160, box.y + 120, { steps: 3 });
  await page.mouse.up();
  await pause(100);
  const dragged = await pixels(page, canvas);
  assert.notEqual(dragged, before);
  await page.focus(canvas);
  await page.keyboard.press('ArrowLeft');
  await pause(100);
  assert.notEqual(await pixels(page, canvas), dragged);
});

await checkPage('a family is downloaded as CSV with the digits of the archive', 'pendulum', {}, async (page) => {
  const client = await page.createCDPSession();
  await client.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: `${folder}/downloads`, eventsEnabled: true });
  mkdirSync(`${folder}/downloads`, { recursive: true });
  writeFileSync(`${folder}/downloads/IDb.csv`, '');
  const done = new Promise((resolve) => client.on('Browser.downloadProgress', (e) => e.state === 'completed' && resolve(e)));
  const named = new Promise((resolve) => client.on('Browser.downloadWillBegin', (e) => resolve(e.suggestedFilename)));
  await (await item(page, 'IDb')).click();
  await page.click('#csv');
  assert.equal(await named, 'IDb.csv');
  const { filePath } = await done;
  const [heads, ...values] = readFileSync(filePath ?? `${folder}/downloads/IDb.csv`, 'utf8').trim().split('\r\n').map((line) => line.split(','));
  for (const line of values) {
    const mine = Object.fromEntries(heads.map((name, i) => [name, Number(line[i])]));
    const row = rows.find((r) => Number(r.period) === mine.period && Number(r.energy) === mine.energy);
    assert.ok(row, `no such row: ${line}`);
    for (const name of ['action', 'arclength', 'state_th1', 'state_w2', 'stability_0']) assert.equal(mine[name], Number(row[name] ?? row[name.replace('_0', '')]), name);
  }
  assert.ok(values.length >= 5);
});
