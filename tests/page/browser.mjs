// Chromium without a network, and pages in it that notice what goes wrong.
import puppeteer from 'puppeteer-core';

export async function launch(chromium) {
  return puppeteer.launch({
    executablePath: chromium,
    headless: true,
    args: ['--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--force-device-scale-factor=1', '--font-render-hinting=none',
      '--host-resolver-rules=MAP * ~NOTFOUND'],
  });
}

/** A page with `troubles` (errors, messages of the console) and `requests` (all but the file itself). */
export async function open(browser, file, { width = 1280, height = 800, theme = 'light', hash = '', touch = false } = {}) {
  const page = await browser.newPage();
  const troubles = [];
  const requests = [];
  page.on('console', (message) => ['error', 'warn', 'warning'].includes(message.type()) && troubles.push(message.text()));
  page.on('pageerror', (error) => troubles.push(String(error)));
  const address = `file://${file}`;
  page.on('request', (request) => {
    const url = request.url().split('#')[0];
    if (url !== address && !url.startsWith('data:') && !url.startsWith('blob:')) requests.push(url);
  });
  await page.setViewport({ width, height, hasTouch: touch, isMobile: touch });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }, { name: 'prefers-reduced-motion', value: 'reduce' }]);
  await page.goto(hash ? `${address}#${hash}` : address);
  await page.waitForFunction(() => performance.getEntriesByName('drawn').length > 0, { timeout: 30_000 });
  return { page, troubles, requests };
}

export const pause = (ms) => new Promise((done) => setTimeout(done, ms));
