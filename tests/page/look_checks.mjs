// How the page looks: themes, colours, room on screens of all widths, and its references.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import pixelmatch from 'pixelmatch';
import { PNG } from 'pngjs';
import { pause } from './browser.mjs';
import { checkPage, folder, text } from './checking.mjs';

const references = process.env.ORBWEAVER_PAGE_REFERENCES;
/** Each theme and the narrowest and a usual width; the long test has all. */
const [widths, pictures] = process.argv[4] === 'all'
  ? [[360, 760, 800, 1024, 1280, 1920], [[360, 740, 'light'], [360, 740, 'dark'], [1280, 800, 'light'], [1280, 800, 'dark'], [1920, 1080, 'light'], [1920, 1080, 'dark']]]
  : [[360, 800, 1280], [[360, 740, 'dark'], [1280, 800, 'light']]];

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

for (const width of widths)
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
        const pen = document.createElement('canvas').getContext('2d');
        for (const e of [...document.querySelectorAll('.diagram .select select')].filter(seen)) {
          const style = getComputedStyle(e);
          pen.font = style.font;
          const room = e.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
          const wanted = pen.measureText(e.selectedOptions[0].textContent).width;
          if (wanted > room) found.push(`"${e.selectedOptions[0].textContent}" takes ${wanted.toFixed(0)} of ${room.toFixed(0)} pixels`);
        }
        return found;
      });
      assert.deepEqual(faults, []);
    }
  });

/** Parts of the pixels that may differ from the reference. With a serif font 1.4 % of a page and 0.2 % of the diagram do; with no curves in
 *  it 1.0 to 1.6 % of the diagram. */
const mostDifferent = { page: 0.025, diagram: 0.006 };
for (const [width, height, theme] of pictures)
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
