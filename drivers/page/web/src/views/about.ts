import { kinds } from '../data/kinds';
import { rounded } from '../data/quantities';
import { h } from '../dom';
import type { Store } from '../state';

declare const LICENCES: { name: string; text: string }[];

function dialog(title: string, ...content: (Node | string)[]): HTMLDialogElement {
  const box = h('dialog', { 'aria-label': title });
  box.append(h('div', { class: 'bar' }, h('h2', {}, title), h('button', { type: 'button', class: 'icon', 'aria-label': 'Close', click: () => box.close() }, '×')), ...content);
  box.addEventListener('click', (event) => event.target === box && box.close());
  return box;
}

const keys: [string, string][] = [
  ['/', 'search'],
  [', .', 'orbit before, next orbit'],
  ['[ ]', 'family before, next family'],
  ['space', 'play or stop'],
  ['arrows', 'in a diagram: pan; in the tree: walk'],
  ['+ − 0', 'in a diagram: closer, further, all of it'],
  ['Escape', 'drop the selection'],
  ['t', 'dark or light'],
  ['?', 'this'],
];

export function helpDialog(): HTMLDialogElement {
  return dialog('Help',
    h('p', {}, 'Curves are families of periodic orbits: solid where an orbit is stable, dashed where it is not, dotted where that is not known. A click picks an orbit or a crossing. The wheel or two fingers zoom, dragging pans, a double click shows all; with Shift held dragging selects orbits, in all diagrams and the tree, with Ctrl it zooms to a rectangle.'),
    h('p', {}, 'Between stored orbits curves are drawn as cubics through them; every digit of the stored ones is kept, so that zooming ends only where doubles do. Axes that show “− 8.4429341 (× 10⁻⁹)” tell differences from that number.'),
    h('table', { class: 'numbers' }, keys.map(([key, text]) => h('tr', {}, h('th', { scope: 'row' }, h('kbd', {}, key)), h('td', {}, text)))));
}

export function aboutDialog(store: Store): HTMLDialogElement {
  const { index } = store.atlas;
  const rows: [string, string][] = [
    ['archive', index.file],
    ['written by', `Orbweaver ${index.orbweaver}`],
    ['system', `${index.title}${index.effects.length ? ` with ${index.effects.join(', ')}` : ''}`],
    ...(index.meaning ? [['what it is', index.meaning] as [string, string]] : []),
    ...index.parameterNames.map((name, i): [string, string] => [name, name === index.moving ? 'moves along the families' : `${index.parameterValues[i]} ${index.parameterUnits[i] === '1' ? '' : (index.parameterUnits[i] ?? '')}`]),
    ['families', String(store.atlas.families.length)],
    ['orbits', String(store.atlas.orbits)],
    ['crossings', String(store.atlas.crossings.length)],
    ['harmonics', `${index.harmonicsKept} of ${index.harmonicsStored}`],
  ];
  const kindsHere = new Set(store.atlas.findings.map((f) => f.severity));
  return dialog('About this atlas',
    h('table', { class: 'numbers' }, rows.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value)))),
    h('p', {}, `What is cut: orbits are drawn with as many harmonics as the eye needs; no coordinate is off by more than ${rounded(index.deviation, 2)} of its range on the orbit. ${index.loops < store.atlas.orbits ? `${index.loops} of ${store.atlas.orbits} orbits have their own drawing, the others that of a neighbour. ` : ''}States, periods, energies, actions and stability have all of their digits; what certificates measured has seven. The archive has all of it.`),
    h('details', {}, h('summary', {}, `What the survey says of itself (${store.atlas.findings.length}${kindsHere.size ? `: ${[...kindsHere].join(', ')}` : ''})`),
      h('ul', { class: 'findings' }, store.atlas.findings.slice(0, 500).map((f) => h('li', {}, h('strong', {}, `${f.severity}, ${f.kind}: `), f.text)))),
    h('details', {}, h('summary', {}, 'Scene'), h('pre', {}, index.scene)),
    h('details', {}, h('summary', {}, 'Licences'), ...LICENCES.map(({ name, text }) => h('div', {}, h('h3', {}, name), h('pre', {}, text)))));
}

/** What lines and marks mean. */
export function legend(store: Store): HTMLElement {
  const present = new Set(store.atlas.crossings.map((c) => c.kind));
  const symbols: Record<string, string> = { square: '■', triangle: '▲', turned: '▼', diamond: '◆', circle: '●', ring: '○', star: '★', cross: '✚', dot: '•' };
  return h('div', { class: 'legend' },
    h('span', {}, h('i', { class: 'key stable' }), 'stable'),
    h('span', {}, h('i', { class: 'key unstable' }), 'unstable'),
    h('span', {}, h('i', { class: 'key unknown' }), 'not known'),
    kinds.filter((k) => present.has(k.name)).map((k) => h('span', {}, h('b', { 'aria-hidden': 'true' }, symbols[k.mark]!), k.text)),
    [...present].some((name) => !kinds.some((k) => k.name === name)) ? h('span', {}, h('b', {}, '•'), 'other') : null);
}
