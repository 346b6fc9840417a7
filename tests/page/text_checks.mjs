// Texts of an archive are shown as texts, whatever they are.
import assert from 'node:assert/strict';
import { open, pause } from './browser.mjs';
import { browser, checkPage, findOrbit, folder, text } from './checking.mjs';

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
