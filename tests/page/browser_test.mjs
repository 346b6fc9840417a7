// browser_test.mjs CHROMIUM FOLDER: every control of the pages in FOLDER does what it says. Prints each check; fails with the list of those
// that did not hold.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import pixelmatch from 'pixelmatch';
import { PNG } from 'pngjs';
import { launch, open, pause } from './browser.mjs';

const [chromium, folder] = process.argv.slice(2);
const references = process.env.ORBWEAVER_PAGE_REFERENCES;
const browser = await launch(chromium);
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
async function checkPage(name, file, options, test) {
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

// --- the table of orbits, as `orbweaver show` has it
const [head, ...lines] = readFileSync(`${folder}/pendulum.csv`, 'utf8').trim().split('\n');
const columns = head.split(',');
const rows = lines.map((line) => Object.fromEntries(line.split(',').map((value, i) => [columns[i], value])));

const text = (page, selector) => page.$eval(selector, (e) => e.textContent);
const fragment = (page) => pause(250).then(() => page.evaluate(() => Object.fromEntries(location.hash.slice(1).split('&').map((w) => w.split('=').map(decodeURIComponent)))));
const pixels = (page, selector) => page.$eval(selector, (c) => c.toDataURL());
const change = (page, selector, value) => page.select(selector, value);
const item = (page, name) => page.evaluateHandle((n) => [...document.querySelectorAll('[role=treeitem]')].find((e) => e.querySelector('.name').textContent === n), name);

/** Looks over the diagram for a place where something is to be picked, and returns what the hint says there. */
async function findOrbit(page, begin = '') {
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
const watchClipboard = (page) => page.evaluate(() => {
  navigator.clipboard.writeText = async (copied) => void (window.copied = copied);
});

await checkPage('opens from disk, without a message or a request, and says what it shows', 'pendulum', {}, async (page) => {
  const drawn = await page.evaluate(() => performance.getEntriesByName('drawn')[0].startTime);
  console.log(`        first drawn after ${drawn.toFixed(0)} ms`);
  assert.equal(await page.title(), 'Ideal double pendulum – Orbweaver');
  const names = await page.$$eval('[role=treeitem] .name', (e) => e.map((n) => n.textContent));
  for (const name of ['In-Phase', 'IDa', 'IDb', 'Out-Phase', 'Up-Down', 'Down-Up']) assert.ok(names.includes(name), name);
  const label = await page.$eval('#diagram1', (c) => c.getAttribute('aria-label'));
  assert.match(label, new RegExp(`energy E against period T: ${names.length} families, ${rows.length} orbits`));
  assert.match(await text(page, '.legend'), /stable.*unstable.*period doubling/);
});

await checkPage('a click picks the orbit that the hint names', 'pendulum', {}, async (page) => {
  const { x, y, hint } = await findOrbit(page, 'OBDa, step');  // one with orbits close together
  await page.mouse.click(x, y);
  const [, name, step] = /^(.*), step (-?\d+)/.exec(hint);
  assert.match(await text(page, '.orbit h2'), new RegExp(`^${name}`));
  const state = await fragment(page);
  assert.equal(state.family, name);
  assert.equal(state.step, step);
  // Where on the diagram that is, by zooming there and beside it.
  const place = async (px, py) => {
    await page.mouse.move(px, py);
    for (let i = 0; i < 60; ++i) await page.mouse.wheel({ deltaY: -200 });
    const view = (await fragment(page)).view.split(',').map(Number);
    await page.focus('#diagram1');
    await page.keyboard.press('0');
    return [(view[0] + view[1]) / 2, (view[2] + view[3]) / 2];
  };
  const [t, e] = await place(x, y);
  const box = await (await page.$('#diagram1')).boundingBox();
  const up = y > box.y + box.height / 2 ? -60 : 60;
  const [tBeside, eBeside] = await place(x + 60, y + up);
  const far = (row) => 60 * Math.hypot((row.period - t) / (tBeside - t), (row.energy - e) / (eBeside - e));
  const nearest = rows.reduce((best, row) => (far(row) < far(best) ? row : best));
  assert.ok(far(nearest) < 28);
  const json = JSON.parse(await page.evaluate(() => new Promise((done) => {
    navigator.clipboard.writeText = async (copied) => done(copied);
    document.getElementById('copy-json').click();
  })));
  const picked = rows.find((row) => Number(row.period) === json.period && Number(row.energy) === json.energy);
  assert.ok(far(picked) < far(nearest) + 0.5, 'another orbit is nearer');  // twins are at one place
});

await checkPage('a click picks a crossing and says what is born there', 'pendulum', {}, async (page) => {
  const { x, y, hint } = await findOrbit(page, 'period doubling on In-Phase');
  await page.mouse.click(x, y);
  assert.match(await text(page, '.crossing'), /Period doubling.*Born here: I/);
  assert.ok(hint.includes('m 2'));
  await page.evaluate(() => [...document.querySelectorAll('.crossing .link')][0].click());
  assert.match(await text(page, '.orbit h2'), /^ID/);
  assert.ok(await page.$eval('.crossing', (e) => e.hidden));
});

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

await checkPage('search finds names, periods and energies', 'pendulum', {}, async (page) => {
  const hits = async (query) => {
    await page.$eval('.search input', (e) => (e.value = ''));
    await page.type('.search input', query);
    return page.$$eval('#hits li', (e) => e.map((n) => n.textContent));
  };
  assert.match((await hits('ida'))[0], /^IDa/);
  assert.match((await hits('ob'))[0], /^OB\d/, 'the name itself comes first');
  const periods = await hits('T=9');
  assert.match(periods[0], /T 9\.?|T 8\.9/);
  assert.ok(periods.every((hit) => !hit.includes('does not reach')));
  assert.match((await hits('E = -0.76'))[0], /E −0\.7/);
  assert.match((await hits('zzz'))[0], /Nothing found/);
  await hits('IDb');
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  assert.match(await text(page, '.orbit h2'), /^IDb/);
});

await checkPage('wheel, keys and buttons zoom and pan, down to the last digit of a double', 'pendulum', {}, async (page) => {
  const box = await (await page.$('#diagram1')).boundingBox();
  const { x, y } = await findOrbit(page, 'In-Phase, step');
  await page.mouse.move(x, y);
  const ranges = async () => (await fragment(page)).view?.split(',').map(Number);
  assert.equal(await ranges(), undefined);
  const before = await pixels(page, '#diagram1');
  await page.mouse.wheel({ deltaY: -400 });
  const [x0, x1] = await ranges();
  assert.ok(x1 - x0 < 30);
  assert.notEqual(await pixels(page, '#diagram1'), before);
  await page.focus('#diagram1');
  await page.keyboard.press('ArrowRight');
  assert.ok((await ranges())[0] > x0, 'pan');
  for (let i = 0; i < 220; ++i) await page.mouse.wheel({ deltaY: -200 });
  const deep = await ranges();
  assert.ok(deep[1] - deep[0] < 1e-12 && deep[1] > deep[0], `reaches ${deep[1] - deep[0]}`);
  assert.ok(deep[3] - deep[2] < 1e-11 && deep[3] > deep[2]);
  await page.keyboard.press('0');
  assert.equal(await ranges(), undefined);
  await page.click('[aria-label="Zoom into the diagram"]');
  assert.ok(await ranges());
  await page.mouse.click(box.x + box.width - 40, box.y + box.height - 60, { clickCount: 2 });
  assert.equal(await ranges(), undefined);
  await page.click('[aria-label="Show the picked family in the diagram"]');
  assert.ok(await ranges());
});

const tenth = rows.find((row) => row.family === '0' && row.step === '10');
const around = [tenth.period, tenth.energy].flatMap((v) => [Number(v) - 1.5e-13, Number(v) + 1.5e-13]).join(',');
await checkPage('a stored orbit is where it is, to the last digit', 'pendulum', { hash: `family=In-Phase&step=10&x=T&y=E&view=${around}` }, async (page) => {
  const view = (await fragment(page)).view.split(',').map(Number);
  assert.ok(view[1] - view[0] < 4e-13);
  const [px, py] = await page.$eval('#diagram1', (canvas) => {
    // The ring around the picked orbit: the mean place of its colour.
    const { data, width } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const hex = getComputedStyle(document.documentElement).getPropertyValue('--pick').trim();
    const ink = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
    let [n, x, y] = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4)
      if (ink.every((v, c) => Math.abs(data[at + c] - v) < 4)) [n, x, y] = [n + 1, x + ((at / 4) % width), y + Math.floor(at / 4 / width)];
    return [x / n, y / n];
  });
  const box = await (await page.$('#diagram1')).boundingBox();
  await page.mouse.move(box.x + px, box.y + py);
  assert.match(await text(page, '.diagram .tip'), /^In-Phase, step 10,/);
  // A hundred pixels beside it there is none: these are 1e-13.
  await page.mouse.move(box.x + px + 100, box.y + py);
  assert.ok(await page.$eval('.diagram .tip', (tip) => tip.hidden || !tip.textContent.includes('step 10')));
});

await checkPage('dragging pans, zooms to a rectangle, or selects in all views', 'pendulum', {}, async (page) => {
  const box = await (await page.$('#diagram1')).boundingBox();
  const drag = async (...key) => {
    for (const k of key) await page.keyboard.down(k);
    await page.mouse.move(box.x + box.width * 0.3, box.y + box.height * 0.3);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.5, box.y + box.height * 0.5, { steps: 4 });
    await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.8, { steps: 4 });
    await page.mouse.up();
    for (const k of key) await page.keyboard.up(k);
  };
  const all = (await page.$$('[role=treeitem]')).length;
  await drag('Shift');
  const count = Number(/(\d+) orbit/.exec(await text(page, '.brushed'))[1]);
  const inside = (await page.$$('[role=treeitem]')).length;
  assert.ok(count > 0 && count < rows.length, `${count} selected`);
  assert.ok(inside > 0 && inside < all);
  assert.equal(await page.$$eval('.brushed', (e) => e.filter((n) => !n.hidden).length), 2, 'both diagrams say so');
  await page.keyboard.press('Escape');
  assert.equal((await page.$$('[role=treeitem]')).length, all);
  await page.click('#tool-brush');
  await drag();
  assert.match(await text(page, '.brushed'), new RegExp(`^${count} orbit`));
  await page.click('.clear');
  await page.click('#tool-pan');
  await drag();
  const panned = (await fragment(page)).view.split(',').map(Number);
  await page.click('[aria-label="Show all of the diagram"]');
  await page.click('#tool-zoom');
  await drag();
  const zoomed = (await fragment(page)).view.split(',').map(Number);
  assert.ok(zoomed[1] - zoomed[0] < 0.5 * (panned[1] - panned[0]));
});

await checkPage('two fingers zoom', 'pendulum', { width: 360, height: 740, touch: true }, async (page) => {
  const box = await (await page.$('#diagram1')).boundingBox();
  const client = await page.createCDPSession();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const fingers = (by) => [{ x: x - by, y, id: 1 }, { x: x + by, y, id: 2 }];
  await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: fingers(20) });
  for (const by of [30, 45, 60, 80]) await client.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: fingers(by) });
  await client.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  const view = (await fragment(page)).view.split(',').map(Number);
  const periods = rows.map((row) => Number(row.period));
  const whole = Math.max(...periods) - Math.min(...periods);
  assert.ok(view[1] - view[0] < 0.35 * whole, `${view} of ${whole}`);
});

await checkPage('axes, colours, crossings, the family alone, and the second diagram change what is drawn', 'pendulum', {}, async (page) => {
  if (await page.$eval('#second', (e) => !e.checked)) await page.click('#second');
  const canvas = '#diagram1';
  let before = await pixels(page, canvas);
  const differs = async (what) => {
    await pause(120);
    const now = await pixels(page, canvas);
    assert.notEqual(now, before, what);
    before = now;
  };
  for (const axis of await page.$$eval('[aria-label="Vertical axis of the diagram"] option', (e) => e.map((o) => o.value))) {
    if (axis === 'E') continue;
    await change(page, '[aria-label="Vertical axis of the diagram"]', axis);
    await differs(`vertical ${axis}`);
  }
  await change(page, '[aria-label="Vertical axis of the diagram"]', 'E');
  await differs('vertical E');
  await change(page, '[aria-label="Horizontal axis of the diagram"]', 'action');
  await differs('horizontal');
  await change(page, '#colour', 'family');
  await differs('colour');
  await page.click('#show-crossings');
  await differs('crossings');
  await page.click('#isolate');
  await differs('only this family');
  const state = await fragment(page);
  assert.equal(state.x, 'action');
  assert.equal(state.colour, 'family');
  assert.equal(state.crossings, '0');
  assert.equal(state.isolate, '1');
  await page.click('#second');
  assert.equal(await page.$eval('#diagram2', (e) => e.offsetParent === null), true);
});

await checkPage('a link leads back to the same view', 'pendulum', {}, async (page) => {
  await watchClipboard(page);
  await (await item(page, 'IDb')).click();
  await change(page, '[aria-label="Vertical axis of the diagram"]', 'k');
  await page.click('[aria-label="Show the picked family in the diagram"]');
  await change(page, '#colour', 'family');
  await page.keyboard.press('.');
  await pause(200);
  await page.click('#copy-link');
  await page.waitForFunction(() => window.copied);
  const link = await page.evaluate(() => window.copied);
  const place = await text(page, '.place');
  const other = await open(browser, `${folder}/pendulum.html`, { hash: link.split('#')[1] });
  assert.match(await text(other.page, '.orbit h2'), /^IDb/);
  assert.equal(await text(other.page, '.place'), place);
  const state = await fragment(page);
  assert.deepEqual(await fragment(other.page), state);
  for (const name of ['family', 'step', 'x', 'y', 'view', 'colour']) assert.ok(state[name], name);
  await other.page.close();
  const odd = await open(browser, `${folder}/pendulum.html`, { hash: 'family=%zz&view=1,2,NaN,4&x=nothing&crossing=-7&step=1e99' });
  assert.deepEqual(odd.troubles, []);
  assert.match(await text(odd.page, '.orbit h2'), /^In-Phase/);
  await odd.page.close();
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
  const still = await Promise.all(views.map((v) => pixels(page, v)));
  await pause(300);
  assert.deepEqual(await Promise.all(views.map((v) => pixels(page, v))), still, 'it stands at first: less motion was asked for');
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

await checkPage('dark and light, larger text, help and about', 'pendulum', {}, async (page) => {
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await paper();
  await page.click('#theme');
  assert.notEqual(await paper(), light);
  await page.keyboard.press('t');
  assert.equal(await paper(), light);
  const size = () => page.evaluate(() => parseFloat(getComputedStyle(document.documentElement).fontSize));
  const normal = await size();
  await page.click('#size');
  assert.equal(await size(), 1.25 * normal);
  await page.click('#help');
  assert.ok(await page.$('dialog[open][aria-label=Help]'));
  await page.keyboard.press('Escape');
  await page.click('#about');
  const about = await text(page, 'dialog[open]');
  assert.match(about, /What is cut: .* of its range/);
  assert.match(about, /d3-array .*Permission to use, copy, modify/s);
  assert.match(about, /name: double-pendulum/);
});

await checkPage('names of an archive are text, never markup', 'hostile', {}, async (page) => {
  const names = await page.$$eval('[role=treeitem] .name', (e) => e.map((n) => n.textContent));
  assert.ok(names.includes('</script><script>window.hacked = 1</script>'));
  assert.ok(names.includes('<img src=x onerror="window.hacked = 2">'));
  for (let i = 0; i < names.length; ++i) {
    await page.evaluate((n) => document.querySelectorAll('[role=treeitem]')[n].click(), i);
    await pause(30);
    assert.ok((await text(page, '.orbit h2')).startsWith(names[i]));
    const link = await page.evaluate(() => new Promise((done) => setTimeout(() => done(location.hash), 200)));
    const family = new Map(link.slice(1).split('&').map((w) => w.split('='))).get('family');
    assert.equal(decodeURIComponent(family), names[i]);
    const again = await open(browser, `${folder}/hostile.html`, { hash: link.slice(1) });
    assert.ok((await text(again.page, '.orbit h2')).startsWith(names[i]));
    await again.page.close();
  }
  await findOrbit(page);
  await page.type('.search input', '<img');
  await page.click('#about');
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal((await page.$$('img, svg, iframe, script[src], #app script')).length, 0);
});

await checkPage('an atlas without orbits says so', 'empty', {}, async (page) => {
  assert.match(await text(page, '.orbit h2'), /no orbits/);
});

for (const [file, title] of [['galaxy', /potential/i], ['spring', /spring/i], ['bodies', /turns with the bodies/i],
  ['chain', /rods and bobs/i], ['eight', /three masses/i], ['space', /turns with the bodies/i], ['shaken', /rods and bobs/i]])
  await checkPage(`the picture of ${file}`, file, { theme: 'dark' }, async (page) => {
    assert.match(await text(page, '.orbit details summary'), title);
    await pause(200);
    const inks = await page.$eval('.picture canvas', (c) => {
      const data = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
      const colours = new Set();
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200) colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      return colours.size;
    });
    assert.ok(inks > 20, `${inks} colours`);
  });

/** The mean place, in pixels, of a colour of the page's picture; null where it is not. */
const placeOf = (page, selector, colour) => page.$eval(selector, (c, name) => {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const ink = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
  const copied = Object.assign(document.createElement('canvas'), { width: c.width, height: c.height }).getContext('2d', { willReadFrequently: true });
  copied.drawImage(c, 0, 0);
  const { data, width } = copied.getImageData(0, 0, c.width, c.height);
  let [n, x, y] = [0, 0, 0];
  for (let at = 0; at < data.length; at += 4)
    if (ink.every((v, i) => Math.abs(data[at + i] - v) < 4)) [n, x, y] = [n + 1, x + ((at / 4) % width), y + Math.floor(at / 4 / width)];
  return n ? [x / n, y / n] : null;
}, colour);
const scrubTo = (page, time) => page.$eval('.player input', (e, t) => {
  e.value = t;
  e.dispatchEvent(new Event('input'));
}, String(time)).then(() => pause(150));

await checkPage('the pivot is shaken, by the amplitude of the orbit that is drawn', 'shaken', {}, async (page) => {
  await page.$eval('.along input', (e) => {
    e.value = e.max;
    e.dispatchEvent(new Event('input'));
  });
  await pause(300);
  const places = [];
  for (const time of [0, 0.5]) {
    await scrubTo(page, time);
    places.push(await placeOf(page, '.picture canvas', '--soft'));
  }
  assert.ok(Math.hypot(places[0][0] - places[1][0], places[0][1] - places[1][1]) > 2, `the pivot stands still: ${places}`);
});

await checkPage('dragging turns the picture of a system in space, and arrows do', 'space', {}, async (page) => {
  const canvas = await page.$('.picture canvas');
  await canvas.scrollIntoView();
  await scrubTo(page, 0.2);
  const seen = [await pixels(page, '.picture canvas')];
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2 + 20, { steps: 4 });
  await page.mouse.up();
  await pause(150);
  seen.push(await pixels(page, '.picture canvas'));
  await canvas.focus();
  await page.keyboard.press('ArrowUp');
  await pause(150);
  seen.push(await pixels(page, '.picture canvas'));
  assert.equal(new Set(seen).size, 3);
});

await checkPage('a dissipative system that nobody knows has phase planes, its parameter and its multipliers', 'unknown', {}, async (page) => {
  const axis = (name) => page.$eval(`[aria-label="${name}"]`, (e) => e.value);
  assert.equal(await axis('Horizontal axis of the diagram'), 'parameter');
  assert.equal(await axis('Vertical axis of the second diagram'), 'rho');
  assert.match(await text(page, 'h1'), /unknown_attractor.*with noise/);
  assert.match(await text(page, '.orbit details summary'), /^Moving$/);
  assert.match(await text(page, '.values'), /Over the period.* [−+] .* i, \|μ\| = /);
  assert.match(await text(page, '.legend'), /torus/);
  const options = await page.$$eval('[aria-label="Vertical axis of the diagram"] option', (e) => e.map((o) => o.textContent));
  assert.ok(options.includes('multiplier 1, imaginary part') && !options.includes('energy E'), options.join());
  // |mu| = 1 at s = 1.387: the band says stable, then unstable.
  assert.equal(await page.$eval('.band', (e) => new Set(e.style.backgroundImage.match(/rgb\([^)]*\)/g)).size), 2);
});

const luminance = ([r, g, b]) => {
  const linear = [r, g, b].map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
};
const contrast = (a, b) => {
  const [x, y] = [luminance(a), luminance(b)].sort((m, n) => n - m);
  return (x + 0.05) / (y + 0.05);
};
/** Machado, Oliveira and Fernandes 2009, severity 1, on linear values. */
const visions = {
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritanopia: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};
const lab = (rgb, matrix) => {
  const linear = rgb.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
  const seen = matrix ? matrix.map((row) => Math.min(1, Math.max(0, row.reduce((sum, m, i) => sum + m * linear[i], 0)))) : linear;
  const xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]].map((row) => row.reduce((s, m, i) => s + m * seen[i], 0));
  const f = xyz.map((v, i) => v / [0.9505, 1, 1.089][i]).map((v) => (v > 0.008856 ? Math.cbrt(v) : 7.787 * v + 16 / 116));
  return [116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])];
};

for (const theme of ['light', 'dark'])
  await checkPage(`colours are told apart with any colour vision, and text stands out (${theme})`, 'pendulum', { theme }, async (page) => {
    const colours = await page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      return Object.fromEntries(['paper', 'panel', 'ink', 'soft', 'stable', 'unstable', 'unknown', 'pick', 'link', 'hot', 'brush'].map((name) => {
        const hex = style.getPropertyValue(`--${name}`).trim();
        return [name, [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16))];
      }));
    });
    for (const name of ['ink', 'soft', 'link', 'brush'])
      for (const ground of ['panel', 'paper', 'hot']) assert.ok(contrast(colours[name], colours[ground]) >= 4.5, `${name} on ${ground}: ${contrast(colours[name], colours[ground])}`);
    for (const name of ['stable', 'unstable', 'unknown', 'pick']) assert.ok(contrast(colours[name], colours.panel) >= 3, `${name}: ${contrast(colours[name], colours.panel)}`);
    for (const [vision, matrix] of [['usual', null], ...Object.entries(visions)]) {
      const [a, b] = [lab(colours.stable, matrix), lab(colours.unstable, matrix)];
      const far = Math.hypot(...a.map((v, i) => v - b[i]));
      assert.ok(far > 30, `stable and unstable are ${far.toFixed(0)} apart with ${vision}`);
    }
  });

for (const width of [360, 760, 1024, 1280, 1920])
  await checkPage(`nothing overflows or lacks a name at ${width} pixels`, 'pendulum', { width, height: width < 700 ? 740 : 800 }, async (page) => {
    for (const tab of [0, 1, 2]) {
      await page.evaluate((n) => {
        const button = document.querySelectorAll('[role=tab]')[n];
        if (button?.offsetParent) button.click();
      }, tab);
      await pause(150);
      const faults = await page.evaluate(() => {
        const found = [];
        const seen = (e) => e.offsetParent !== null;
        if (document.documentElement.scrollWidth > innerWidth) found.push(`the page is ${document.documentElement.scrollWidth} wide`);
        const panels = [...document.querySelectorAll('main > *, header')].filter(seen);
        for (const panel of panels) {
          const box = panel.getBoundingClientRect();
          if (panel.scrollWidth > panel.clientWidth + 1) found.push(`${panel.className || panel.tagName} is ${panel.scrollWidth} in ${panel.clientWidth}`);
          if (box.right > innerWidth + 1 || box.left < -1) found.push(`${panel.className} sticks out`);
          for (const e of panel.querySelectorAll('canvas, button, select, input'))
            if (seen(e) && getComputedStyle(e).position !== 'fixed' && e.getBoundingClientRect().right > box.right + 1) found.push(`${e.id || e.textContent || e.tagName} leaves its panel`);
        }
        for (const e of document.querySelectorAll('button, select, input, canvas, [role=treeitem]')) {
          const name = e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.[0]?.textContent.trim();
          if (!name) found.push(`no name: ${e.outerHTML.slice(0, 80)}`);
        }
        return found;
      });
      assert.deepEqual(faults, []);
    }
  });

/** Parts of the pixels that may differ from the reference. With a serif font 1.4 % of a page and 0.2 % of the diagram do; with no curves in
 *  it 1.0 to 1.6 % of the diagram. */
const mostDifferent = { page: 0.025, diagram: 0.006 };
for (const [width, height, theme] of [[360, 740, 'light'], [360, 740, 'dark'], [1280, 800, 'light'], [1280, 800, 'dark'], [1920, 1080, 'light'], [1920, 1080, 'dark']])
  await checkPage(`looks as its reference at ${width} pixels, ${theme}`, 'pendulum', { width, height, theme, hash: 'family=In-Phase&step=10' }, async (page) => {
    await pause(300);
    const name = `${width}_${theme}.png`;
    const path = `${folder}/${name}`;
    await page.screenshot({ path });
    // Kept small: means over squares of pixels.
    const side = width > 700 ? 4 : 2;
    const whole = PNG.sync.read(readFileSync(path));
    const shot = new PNG({ width: Math.floor(width / side), height: Math.floor(height / side) });
    for (let j = 0; j < shot.height; ++j)
      for (let i = 0; i < shot.width; ++i)
        for (let c = 0; c < 4; ++c) {
          let sum = 0;
          for (let n = 0; n < side * side; ++n)
            sum += whole.data[4 * ((side * j + Math.floor(n / side)) * whole.width + side * i + (n % side)) + c];
          shot.data[4 * (j * shot.width + i) + c] = sum / (side * side);
        }
    const reference = `${references}/${name}`;
    if (process.env.ORBWEAVER_PAGE_RENEW || !existsSync(reference)) {
      writeFileSync(`${folder}/new_${name}`, PNG.sync.write(shot));
      if (process.env.ORBWEAVER_PAGE_RENEW) return;
      throw new Error(`there is no ${reference}; ${folder}/new_${name} would be one`);
    }
    const expected = PNG.sync.read(readFileSync(reference));
    assert.deepEqual([shot.width, shot.height], [expected.width, expected.height]);
    const difference = new PNG({ width: shot.width, height: shot.height });
    const count = pixelmatch(expected.data, shot.data, difference.data, shot.width, shot.height, { threshold: 0.2 });
    writeFileSync(`${folder}/new_${name}`, PNG.sync.write(shot));
    writeFileSync(`${folder}/difference_${name}`, PNG.sync.write(difference));
    const box = await (await page.$('#diagram1')).boundingBox();
    let inDiagram = 0;
    const [left, top, wide, high] = [box.x, box.y, box.width, box.height].map((v) => Math.floor(v / side));
    for (let j = top; j < top + high; ++j)
      for (let i = left; i < left + wide; ++i) {
        const [r, g] = difference.data.subarray(4 * (j * shot.width + i));
        inDiagram += r === 255 && g === 0 ? 1 : 0;  // pixelmatch's red
      }
    const parts = { page: count / (shot.width * shot.height), diagram: inDiagram / (wide * high) };
    console.log(`        ${(100 * parts.page).toFixed(2)} % of the page differ, ${(100 * parts.diagram).toFixed(2)} % of the diagram`);
    for (const [name, part] of Object.entries(parts))
      assert.ok(part <= mostDifferent[name], `${(100 * part).toFixed(1)} % of the ${name} differ: see the pictures in ${folder}`);
  });

await browser.close();
if (failures.length) {
  console.error(`${failures.length} checks failed:\n  ${failures.join('\n  ')}`);
  process.exit(1);
}
