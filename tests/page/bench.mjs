// bench.mjs CHROMIUM PAGE: time to the first drawing and frames a second while panning, zooming, and dragging a selection.
import { launch, open, pause } from './browser.mjs';

const [chromium, file] = process.argv.slice(2);
const browser = await launch(chromium);
const { page } = await open(browser, file, { width: 1280, height: 800 });
const drawn = await page.evaluate(() => performance.getEntriesByName('drawn')[0].startTime);
console.log(`first drawn after ${drawn.toFixed(0)} ms`);
const box = await (await page.$('#diagram1')).boundingBox();
const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];

async function frames(name, act) {
  await page.evaluate(() => {
    window.times = [];
    const tick = (now) => (window.times.push(now), (window.handle = requestAnimationFrame(tick)));
    window.handle = requestAnimationFrame(tick);
  });
  const begin = Date.now();
  for (let i = 0; Date.now() - begin < 3000; ++i) await act(i);
  const gaps = await page.evaluate(() => {
    cancelAnimationFrame(window.handle);
    return window.times.slice(1).map((t, i) => t - window.times[i]);
  });
  gaps.sort((a, b) => a - b);
  const mean = gaps.reduce((a, b) => a + b, 0) / gaps.length;
  console.log(`${name}: ${(1000 / mean).toFixed(1)} frames a second; slowest twentieth ${gaps[Math.floor(gaps.length * 0.95)].toFixed(0)} ms`);
}

await page.mouse.move(x, y);
await page.mouse.down();
await frames('panning', (i) => page.mouse.move(x + 80 * Math.sin(i / 8), y + 50 * Math.cos(i / 8)));
await page.mouse.up();
await page.mouse.move(x, y);
await frames('zooming', (i) => page.mouse.wheel({ deltaY: i % 60 < 30 ? -40 : 40 }));
await frames('hovering', (i) => page.mouse.move(x + 80 * Math.sin(i / 8), y + 50 * Math.cos(i / 8)));
await page.keyboard.press('0');
await pause(300);
const pick = Date.now();
await page.mouse.click(x, y);
await pause(50);
console.log(`a pick with its orbit drawn: ${Date.now() - pick - 50} ms`);
await browser.close();
