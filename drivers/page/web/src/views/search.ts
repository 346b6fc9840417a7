import { rounded } from '../data/quantities';
import { h, replaceChildren } from '../dom';
import type { Store } from '../state';

interface Hit {
  text: string;
  detail: string;
  orbit: number;
}

const mostHits = 40;

/** Names that contain the words; or, for "T=9" and "E=-0.76", the nearest orbit of each family that has such, nearest first. */
export function hitsOf(store: Store, query: string): Hit[] {
  const { atlas } = store;
  const word = query.trim();
  if (!word) return [];
  const held = /^\s*([te])\s*[=:≈~ ]\s*([-+−]?[\d.]+(?:e[-+]?\d+)?)\s*$/i.exec(word);
  const state = (orbit: number): string =>
    `T ${rounded(atlas.value('period', orbit))}, E ${rounded(atlas.value('energy', orbit))}${atlas.stable[orbit] === 1 ? ', stable' : ''}`;
  if (held) {
    const column = held[1]!.toLowerCase() === 't' ? 'period' : 'energy';
    const wanted = Number(held[2]!.replace('−', '-'));
    const found: { orbit: number; far: number; passes: boolean }[] = [];
    for (const family of atlas.families) {
      let best = { orbit: -1, far: Infinity, passes: false };
      let [low, high] = [Infinity, -Infinity];
      for (let i = family.first; i < family.first + family.count; ++i) {
        const value = atlas.value(column, i);
        low = Math.min(low, value);
        high = Math.max(high, value);
        const far = Math.abs(value - wanted);
        if (far < best.far) best = { orbit: i, far, passes: false };
      }
      best.passes = low <= wanted && wanted <= high;
      if (best.orbit >= 0) found.push(best);
    }
    found.sort((a, b) => Number(b.passes) - Number(a.passes) || a.far - b.far);
    const passing = found.filter((f) => f.passes);
    return (passing.length ? passing : found.slice(0, 5)).slice(0, mostHits).map(({ orbit, passes }) => ({
      text: `${atlas.family(orbit).name}, step ${atlas.value('step', orbit)}`,
      detail: `${state(orbit)}${passes ? '' : ' (the family does not reach it)'}`,
      orbit,
    }));
  }
  const lower = word.toLowerCase();
  const rank = (name: string): number => (name.toLowerCase() === lower ? 0 : name.toLowerCase().startsWith(lower) ? 1 : 2);
  return atlas.families
    .filter((f) => f.count > 0 && f.name.toLowerCase().includes(lower))
    .sort((a, b) => rank(a.name) - rank(b.name) || a.row - b.row)
    .slice(0, mostHits)
    .map((f) => {
      const orbit = store.typicalOf(f.row);
      return { text: f.name, detail: `${f.count} orbits; ${state(orbit)}`, orbit };
    });
}

export class Search {
  readonly element: HTMLElement;
  readonly input = h('input', {
    type: 'search', placeholder: 'Family, T=9 or E=-0.76', 'aria-label': 'Search a family by name, or orbits by period or energy, as T=9 or E=-0.76',
    role: 'combobox', 'aria-expanded': 'false', 'aria-controls': 'hits', 'aria-autocomplete': 'list', autocomplete: 'off', spellcheck: 'false',
  });
  private readonly list = h('ul', { id: 'hits', role: 'listbox', 'aria-label': 'Found', hidden: true });
  private hits: Hit[] = [];
  private at = -1;

  constructor(private readonly store: Store) {
    this.element = h('div', { class: 'search' }, this.input, this.list);
    this.input.addEventListener('input', () => this.find());
    this.input.addEventListener('focus', () => this.find());
    this.input.addEventListener('blur', () => window.setTimeout(() => this.close(), 150));
    this.input.addEventListener('keydown', (event) => {
      if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
        this.at = Math.max(0, Math.min(this.hits.length - 1, this.at + (event.key === 'ArrowDown' ? 1 : -1)));
        this.mark();
        event.preventDefault();
      } else if (event.key === 'Enter' && this.hits.length) this.choose(this.hits[Math.max(0, this.at)]!);
      else if (event.key === 'Escape') {
        this.close();
        this.input.blur();
      }
    });
  }

  private find(): void {
    this.hits = hitsOf(this.store, this.input.value);
    this.at = -1;
    const items = this.hits.map((hit, i) =>
      h('li', { role: 'option', id: `hit${i}`, 'aria-selected': 'false', pointerdown: (event: Event) => (event.preventDefault(), this.choose(hit)) },
        h('strong', {}, hit.text), h('span', {}, hit.detail)));
    const word = this.input.value.trim();
    replaceChildren(this.list, items.length ? items : h('li', { class: 'none' }, 'Nothing found. Try part of a name, T=9, or E=-0.76.'));
    this.list.hidden = !word;
    this.input.setAttribute('aria-expanded', String(Boolean(word)));
  }

  private mark(): void {
    [...this.list.children].forEach((item, i) => item.setAttribute('aria-selected', String(i === this.at)));
    this.input.setAttribute('aria-activedescendant', `hit${this.at}`);
    this.list.children[this.at]?.scrollIntoView({ block: 'nearest' });
  }

  private choose(hit: Hit): void {
    this.store.pick(hit.orbit);
    this.close();
    this.input.blur();
  }

  private close(): void {
    this.list.hidden = true;
    this.input.setAttribute('aria-expanded', 'false');
  }
}
