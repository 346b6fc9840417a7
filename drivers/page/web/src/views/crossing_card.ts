import { kindOf } from '../data/kinds';
import { exact, rounded } from '../data/quantities';
import { h, replaceChildren } from '../dom';
import type { Store } from '../state';
import { familyLinks } from './family_links';

/** What is known of the picked crossing, and what is born there. */
export class CrossingCard {
  readonly element = h('div', { class: 'card crossing' });

  /** `copyText` copies a text and says so, by its name. */
  constructor(private readonly store: Store, private readonly copyText: (text: string, what: string) => void) {}

  show(): void {
    const { store, copyText } = this;
    const { atlas, state } = store;
    const crossing = atlas.crossings[state.crossing];
    this.element.hidden = !crossing;
    if (!crossing) return;
    const kind = kindOf(crossing.kind);
    const rows: [string, string][] = [['T', exact(crossing.period)]];
    if (Number.isFinite(crossing.energy)) rows.push(['E', exact(crossing.energy)]);
    if (Number.isFinite(crossing.parameter)) rows.push([atlas.index.moving || 'parameter', exact(crossing.parameter)]);
    rows.push(['m', `orbits born there close after ${crossing.multiplicity} period${crossing.multiplicity === 1 ? '' : 's'}`]);
    if (!kind.name.startsWith('fold') && kind.name !== 'krein')
      rows.push(['multiplier', `exp(2πi · ${crossing.sectorJ}/${crossing.sectorQ}) of the fundamental map`]);
    rows.push(
      ['kernel', crossing.kernelDimension < 0 ? 'not computed' : `${crossing.kernelDimension} flat direction${crossing.kernelDimension === 1 ? '' : 's'}`],
      ['residual', rounded(crossing.residual, 3)],
      ...crossing.state.map((value, i): [string, string] => [atlas.index.stateNames[i]!, exact(value)]));
    const named = (title: string, rows: number[]): Node | null => (rows.length ? h('p', {}, title, familyLinks(store, rows)) : null);
    replaceChildren(this.element,
      h('div', { class: 'bar' }, h('h3', {}, `${kind.text[0]!.toUpperCase()}${kind.text.slice(1)} (crossing ${crossing.row})`),
        h('button', { type: 'button', class: 'icon', 'aria-label': 'Close', click: () => store.set({ crossing: -1 }, 'crossing') }, '×')),
      h('table', { class: 'numbers' }, rows.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value)))),
      named('Born here: ', crossing.born) ?? h('p', {}, 'No family of this atlas is born here.'),
      named('Ends here: ', crossing.ended),
      h('button', { type: 'button', click: () => copyText(`[${crossing.state.join(', ')}]`, "The crossing's state") }, 'Copy its state'));
  }
}
