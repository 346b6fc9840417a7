import { kindOf } from '../data/kinds';
import { rounded } from '../data/quantities';
import { h, replaceChildren } from '../dom';
import { currentTheme, familyColour, type Theme } from '../plot/theme';
import type { Family } from '../data/atlas';
import type { Store } from '../state';

/** Where along the family orbits are stable: a band of colours. */
export function stabilityBand(store: Store, family: Family, theme: Theme): string {
  const { atlas } = store;
  if (family.count === 0) return 'none';
  const colour = (orbit: number): string => {
    const s = atlas.stable[orbit];
    return s === 1 ? theme.stable : s === 0 ? theme.unstable : theme.unknown;
  };
  const stops: string[] = [];
  let begin = 0;
  for (let i = 1; i <= family.count; ++i) {
    if (i < family.count && atlas.stable[family.first + i] === atlas.stable[family.first + begin]) continue;
    const part = (n: number): string => `${((100 * n) / family.count).toFixed(3)}%`;
    stops.push(`${colour(family.first + begin)} ${part(begin)} ${part(i)}`);
    begin = i;
  }
  return `linear-gradient(90deg, ${stops.join(', ')})`;
}

export class Tree {
  readonly element: HTMLElement;
  private readonly list = h('ul', { role: 'tree', 'aria-label': 'Families of periodic orbits' });
  private readonly filter = h('input', { type: 'search', placeholder: 'Name', 'aria-label': 'Show families whose name contains', autocomplete: 'off', spellcheck: 'false' });
  private readonly only = h('input', { type: 'checkbox', id: 'only-stable' });
  private readonly born = h('select', { 'aria-label': 'Show families born at' });
  private readonly total = h('span', { class: 'count', 'aria-live': 'polite' });
  private readonly closed = new Set<number>();
  private rows = new Map<number, HTMLElement>();

  constructor(private readonly store: Store) {
    const { atlas } = store;
    const kinds = [...new Set(atlas.families.map((f) => atlas.crossings[f.crossing]?.kind).filter((k): k is string => Boolean(k)))];
    this.born.append(h('option', { value: '' }, 'born anywhere'), h('option', { value: '-' }, 'begun by the scene'));
    for (const kind of kinds) this.born.append(h('option', { value: kind }, `born at a ${kindOf(kind).text}`));
    for (const control of [this.filter, this.only, this.born]) control.addEventListener('input', () => this.fill());
    this.element = h('nav', { class: 'tree', 'aria-label': 'Families' },
      h('div', { class: 'bar' }, h('h2', {}, 'Families'), this.total),
      h('div', { class: 'bar filters' }, this.filter, this.born, h('label', { for: 'only-stable' }, this.only, ' with stable orbits')),
      this.list);
    this.list.addEventListener('keydown', (event) => this.key(event));
    this.fill();
    store.on((parts) => {
      if (parts.has('orbit')) this.mark();
      if (parts.has('look') || parts.has('brush')) this.fill();
    });
  }

  private shows(family: Family): boolean {
    const { atlas, state } = this.store;
    const word = this.filter.value.trim().toLowerCase();
    if (word && !family.name.toLowerCase().includes(word)) return false;
    const kind = atlas.crossings[family.crossing]?.kind ?? '-';
    if (this.born.value && this.born.value !== kind) return false;
    const orbits = (test: (orbit: number) => boolean): boolean => {
      for (let i = family.first; i < family.first + family.count; ++i) if (test(i)) return true;
      return false;
    };
    if (this.only.checked && !orbits((i) => atlas.stable[i] === 1)) return false;
    return !(state.brushed && !orbits((i) => state.brushed!.has(i)));
  }

  private get isFiltered(): boolean {
    return Boolean(this.filter.value.trim() || this.born.value || this.only.checked || this.store.state.brushed);
  }

  fill(): void {
    const { atlas } = this.store;
    const theme = currentTheme();
    this.rows = new Map();
    const shown: HTMLElement[] = [];
    const listed = new Set<number>();
    const add = (row: number, depth: number): void => {
      if (listed.has(row)) return;
      listed.add(row);
      const family = atlas.families[row]!;
      if (!this.isFiltered || this.shows(family)) shown.push(this.item(family, this.isFiltered ? 0 : depth, theme));
      if (this.isFiltered || !this.closed.has(row)) for (const child of family.children) add(child, depth + 1);
      else family.children.forEach((child) => this.hide(child, listed));
    };
    for (const family of atlas.families) if (family.parent < 0) add(family.row, 0);
    for (const family of atlas.families) add(family.row, 0);
    replaceChildren(this.list, shown);
    this.total.textContent = this.isFiltered ? `${shown.length} of ${atlas.families.length}` : String(atlas.families.length);
    if (!shown.length) this.list.append(h('li', { class: 'none' }, 'No family is like that.'));
    this.mark();
  }

  private hide(row: number, listed: Set<number>): void {
    if (listed.has(row)) return;
    listed.add(row);
    this.store.atlas.families[row]!.children.forEach((child) => this.hide(child, listed));
  }

  private item(family: Family, depth: number, theme: Theme): HTMLElement {
    const { atlas, state } = this.store;
    const crossing = atlas.crossings[family.crossing];
    const band = h('span', { class: 'band', title: 'Stability along the family' });
    band.style.backgroundImage = stabilityBand(this.store, family, theme);
    const swatch = h('span', { class: 'swatch', 'aria-hidden': 'true' });
    swatch.style.background = state.colour === 'family' ? familyColour(theme, family.row) : 'transparent';
    const isOpen = !this.closed.has(family.row);
    const hasChildren = family.children.length > 0 && !this.isFiltered;
    const twist = h('span', { class: 'twist', 'aria-hidden': 'true' }, hasChildren ? (isOpen ? '▾' : '▸') : '');
    if (hasChildren)
      twist.addEventListener('click', (event) => {
        event.stopPropagation();
        this.toggle(family.row);
      });
    const range = family.count ? this.range(family) : `no orbits: ${family.endReason}`;
    const stable = family.count && atlas.stable.subarray(family.first, family.first + family.count).some((s) => s === 1);
    const bornAt = crossing ? `${kindOf(crossing.kind).text}${family.multiplicity > 1 ? `, m ${family.multiplicity}` : ''}` : '';
    const item = h('li', {
      title: family.count ? undefined : range,
      role: 'treeitem', tabindex: '-1', 'aria-level': String(depth + 1),
      'aria-label': `${family.name}, ${family.count} orbits${stable ? ', some stable' : ''}, ${range}${bornAt ? `, born at ${bornAt}` : ''}`,
      'aria-expanded': hasChildren ? String(isOpen) : undefined,
    }, twist, swatch, h('span', { class: 'name' }, family.name), band, h('span', { class: 'range' }, range, bornAt ? h('span', { class: 'born' }, bornAt) : null));
    item.style.setProperty('--depth', String(Math.min(depth, 8)));
    item.addEventListener('click', () => {
      this.store.pickFamily(family.row);
      item.focus({ preventScroll: true });
    });
    this.rows.set(family.row, item);
    return item;
  }

  /** What moves along the family: its period, or the parameter. */
  private range(family: Family): string {
    const { atlas } = this.store;
    const { moving } = atlas.index;
    let [low, high] = [Infinity, -Infinity];
    for (let i = family.first; i < family.first + family.count; ++i) {
      const value = atlas.value(moving ? 'parameter' : 'period', i);
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return `${moving || 'T'} ${[...new Set([rounded(low, 4), rounded(high, 4)])].join(' – ')}`;
  }

  private toggle(row: number): void {
    if (this.closed.has(row)) this.closed.delete(row);
    else this.closed.add(row);
    this.fill();
    this.rows.get(row)?.focus();
  }

  private mark(): void {
    const { atlas, state } = this.store;
    const picked = state.orbit >= 0 ? atlas.familyOf[state.orbit]! : -1;
    let hasStop = false;
    for (const [row, item] of this.rows) {
      const is = row === picked;
      if (is && item.getAttribute('aria-selected') !== 'true' && item.offsetParent) {
        const [box, frame] = [item.getBoundingClientRect(), this.list.getBoundingClientRect()];
        if (box.top < frame.top || box.bottom > frame.bottom) this.list.scrollTop += box.top - frame.top - frame.height / 3;
      }
      item.setAttribute('aria-selected', String(is));
      item.tabIndex = is ? 0 : -1;
      hasStop ||= is;
    }
    const first = this.rows.values().next().value;
    if (!hasStop && first) first.tabIndex = 0;
  }

  private key(event: KeyboardEvent): void {
    const order = [...this.rows];
    const at = order.findIndex(([, item]) => item === document.activeElement);
    if (at < 0) return;
    const row = order[at]![0];
    const family = this.store.atlas.families[row]!;
    const go = (to: number): void => {
      const next = order[Math.max(0, Math.min(order.length - 1, to))]!;
      next[1].focus();
      this.store.pickFamily(next[0]);
    };
    const keys: Record<string, () => void> = {
      ArrowDown: () => go(at + 1),
      ArrowUp: () => go(at - 1),
      Home: () => go(0),
      End: () => go(order.length - 1),
      Enter: () => this.store.pickFamily(row),
      ' ': () => this.store.pickFamily(row),
      ArrowRight: () => (this.closed.has(row) ? this.toggle(row) : family.children.length && go(at + 1)),
      ArrowLeft: () =>
        family.children.length && !this.closed.has(row) ? this.toggle(row) : family.parent >= 0 && go(order.findIndex(([r]) => r === family.parent)),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }
}
