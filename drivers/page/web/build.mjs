// Bundles src/ into page.html: one file without a request. Its policy allows this script and this style, and nothing else.
import { createHash } from 'node:crypto';
import { existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { build } from 'esbuild';

const lock = JSON.parse(readFileSync('package-lock.json', 'utf8'));
const licences = Object.entries(lock.packages)
  .filter(([path, info]) => path.startsWith('node_modules/') && !info.dev)
  .map(([path, info]) => {
    const file = readdirSync(path).find((name) => /^licen[sc]e/i.test(name));
    if (!file) throw new Error(`${path} has no licence text`);
    const name = path.slice(path.lastIndexOf('node_modules/') + 'node_modules/'.length);
    return { name: `${name} ${info.version}`, text: readFileSync(`${path}/${file}`, 'utf8').trim() };
  });

const bundle = async (entry, options) => {
  const result = await build({
    entryPoints: [entry], bundle: true, minify: true, write: false, target: ['chrome103', 'firefox113', 'safari16.4'],
    charset: 'utf8', logLevel: 'warning', ...options,
  });
  return result.outputFiles[0].text.trim();
};
const script = (await bundle('src/main.ts', { format: 'iife', define: { LICENCES: JSON.stringify(licences) } }))
  .replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
const style = await bundle('src/page.css', {});
const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src data: blob:; base-uri 'none'; form-action 'none'`;
let page = readFileSync('src/page.html', 'utf8');
for (const [mark, text] of [['POLICY', policy], ['STYLE', style], ['SCRIPT', script]]) {
  if (!page.includes(`{{${mark}}}`)) throw new Error(`page.html has no {{${mark}}}`);
  page = page.replace(`{{${mark}}}`, () => text);
}
if (existsSync('page.html') && readFileSync('page.html', 'utf8') === page) process.exit(0);
writeFileSync('page.html', page);
