// How each system is shown: its own picture, or phase planes.
import assert from 'node:assert/strict';
import { pause } from './browser.mjs';
import { checkPage, pixels, scrubTo, text, watchClipboard } from './checking.mjs';

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

await checkPage('the parameter that moves has its name, and an orbit that is copied its value', 'shaken', {}, async (page) => {
  assert.match(await text(page, 'h1'), /pivot_amplitude moves/);
  assert.match(await text(page, '[role=treeitem] .range'), /^pivot_amplitude 0 – 0\.5$/);
  const label = await page.$eval('#diagram1', (c) => c.getAttribute('aria-label'));
  assert.match(label, /rms amplitude against pivot_amplitude \(m\)/);
  await page.$eval('.along input', (e) => {
    e.value = e.max;
    e.dispatchEvent(new Event('input'));
  });
  await watchClipboard(page);
  await page.click('#copy-json');
  await page.waitForFunction(() => window.copied);
  const { parameters } = JSON.parse(await page.evaluate(() => window.copied));
  assert.equal(parameters.pivot_amplitude, 0.5);
  assert.equal(parameters.c1, 0.2);
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

await checkPage('a system that a conserved quantity reduces has phase planes of what is left, and says what that is', 'reduced', {}, async (page) => {
  assert.match(await text(page, 'h1'), /A lattice of three particles/);
  assert.equal(await text(page, '.orbit details summary'), 'Moving in the plane of x1 and x3');
  assert.match(await text(page, '.why'), /^This page has no picture of lattice \(three particles .*; held: momentum = 0, from which p2 follows; x2 left out: x1 for x1 - x2, x3 for -x2 \+ x3\)\.$/);
  assert.deepEqual(await page.$$eval('[aria-label="Vertical axis of path 1"] option', (e) => e.map((o) => o.textContent)), ['x1', 'x3', 'p1', 'p3']);
  const places = [];
  for (const time of [0.1, 0.4]) {
    await scrubTo(page, time);
    places.push(await placeOf(page, '.picture canvas', '--pick'));
  }
  assert.ok(places[0] && places[1] && Math.hypot(places[0][0] - places[1][0], places[0][1] - places[1][1]) > 5, `nothing moves: ${places}`);
});

await checkPage('states in other coordinates than the picture reads move in a phase plane, which says so', 'told', {}, async (page) => {
  assert.equal(await text(page, '.orbit details summary'), 'Moving in the plane of q1 and q2');
  assert.equal(await text(page, '.why'), 'The picture of double_pendulum (two point masses on massless rods under gravity) reads other coordinates than those of this archive: q1, q2, p1, p2.');
});

await checkPage('a dissipative system that nobody knows has phase planes, its parameter and its multipliers', 'unknown', {}, async (page) => {
  const axis = (name) => page.$eval(`[aria-label="${name}"]`, (e) => e.value);
  assert.equal(await axis('Horizontal axis of the diagram'), 'parameter');
  assert.equal(await axis('Vertical axis of the second diagram'), 'rho');
  assert.match(await text(page, 'h1'), /unknown_attractor.*with noise/);
  assert.match(await text(page, '.orbit details summary'), /^Moving in the plane of x and y$/);
  assert.equal(await text(page, '.why'), 'This page has no picture of unknown_attractor.');
  assert.match(await text(page, '.values'), /Over the period.*\s[−+]\s.*\si, \|μ\| = /);
  assert.match(await text(page, '.legend'), /torus/);
  const options = await page.$$eval('[aria-label="Vertical axis of the diagram"] option', (e) => e.map((o) => o.textContent));
  assert.ok(options.includes('multiplier 1, imaginary part') && !options.includes('energy E'), options.join());
  // |mu| = 1 at s = 1.387: the band says stable, then unstable.
  assert.equal(await page.$eval('.band', (e) => new Set(e.style.backgroundImage.match(/rgb\([^)]*\)/g)).size), 2);
});
