// The diagram: picking, searching, zooming, selecting, its axes, and links back to a view.
import assert from 'node:assert/strict';
import { open, pause } from './browser.mjs';
import { browser, change, checkPage, findOrbit, folder, fragment, item, pixels, rows, text, watchClipboard } from './checking.mjs';

await checkPage('opens from disk, without a message or a request, and says what it shows', 'pendulum', {}, async (page) => {
  const drawn = await page.evaluate(() => performance.getEntriesByName('drawn')[0].startTime);
  console.log(`        first drawn after ${drawn.toFixed(0)} ms`);
  assert.equal(await page.title(), 'Double pendulum – Orbweaver');
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
  assert.doesNotMatch(await text(page, '.crossing'), /Ends here/);
  await page.evaluate(() => [...document.querySelectorAll('.crossing .link')][0].click());
  assert.match(await text(page, '.orbit h2'), /^ID/);
  assert.ok(await page.$eval('.crossing', (e) => e.hidden));
  // Where that family comes back to In-Phase.
  await page.evaluate(() => [...document.querySelectorAll('.head .link')].find((e) => e.textContent === 'In-Phase').click());
  await page.evaluate(() => [...document.querySelectorAll('.strip .tick')][1].click());
  assert.match(await text(page, '.crossing'), /No family of this atlas is born here\.Ends here: IDa, IDb/);
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

await checkPage('an axis that goes on logarithmically has numbers where they are', 'pendulum', { hash: 'x=T&y=k&view=8,12,-1.5,6.2' }, async (page) => {
  await page.evaluate(() => {
    window.written = [];
    const write = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
      if (this.canvas.id === 'diagram1' && this.textAlign === 'right') window.written.push([text, y]);
      write.call(this, text, x, y);
    };
    document.getElementById('theme').click();
  });
  await pause(300);
  const height = Object.fromEntries(await page.evaluate(() => window.written));
  // Linear up to 2, then 2 + 2 ln(k / 2).
  for (const value of [5, 10]) {
    const far = (height[2] - height[value]) / (height[1] - height[2]);
    assert.ok(Math.abs(far - 2 * Math.log(value / 2)) < 0.05, `${value} is ${far} above 2, in parts of what 2 is above 1: ${JSON.stringify(height)}`);
  }
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
