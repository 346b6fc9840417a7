import { h } from '../dom';
import type { Store } from '../state';

/** The names of families, each of which picks its own, with commas that do not begin a line. */
export function familyLinks(store: Store, rows: number[]): (Node | string)[] {
  return rows.flatMap((row, i) => (i + 1 < rows.length ? [h('span', { class: 'whole' }, familyLink(store, row), ','), ' '] : [familyLink(store, row)]));
}

export function familyLink(store: Store, row: number): HTMLElement {
  return h('button', { type: 'button', class: 'link', click: () => store.pickFamily(row) }, store.atlas.families[row]!.name);
}
