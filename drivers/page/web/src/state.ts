import type { Atlas } from './data/atlas';
import type { Quantity } from './data/quantities';
import type { Box } from './plot/frame';

export interface DiagramState {
  x: string;
  y: string;
  /** null: all of it. */
  view: Box | null;
}

export interface ViewState {
  /** Rows of the archive, or -1. */
  orbit: number;
  crossing: number;
  diagrams: [DiagramState, DiagramState];
  hasSecond: boolean;
  colour: 'stability' | 'family';
  showCrossings: boolean;
  /** Only the picked family in full colour. */
  isolate: boolean;
  brushed: Set<number> | null;
}

export type Part = 'orbit' | 'crossing' | 'diagrams' | 'look' | 'brush';
type Listener = (parts: Set<Part>) => void;

/** What is looked at. All views read it and hear of its changes; the URL's fragment holds it but for the brush. */
export class Store {
  readonly state: ViewState;
  private readonly listeners: Listener[] = [];
  private writing = 0;

  constructor(readonly atlas: Atlas, readonly quantities: Quantity[]) {
    const has = (id: string): boolean => quantities.some((q) => q.id === id);
    const first = quantities[0]?.id ?? 'T';
    const stability = has('k') ? 'k' : has('rho') ? 'rho' : first;
    this.state = {
      orbit: -1,
      crossing: -1,
      diagrams: [
        { x: has('parameter') ? 'parameter' : 'T', y: has('E') && !has('parameter') ? 'E' : 'amplitude', view: null },
        { x: has('parameter') ? 'parameter' : 'T', y: stability, view: null },
      ],
      hasSecond: window.innerWidth >= 1200 && window.innerHeight >= 700,
      colour: 'stability',
      showCrossings: true,
      isolate: false,
      brushed: null,
    };
    this.read();
    if (this.state.orbit < 0 && atlas.orbits > 0) this.state.orbit = this.typicalOf(atlas.familyOf[0]!);
    window.addEventListener('hashchange', () => {
      this.read();
      this.tell('orbit', 'crossing', 'diagrams', 'look');
    });
  }

  on(listener: Listener): void {
    this.listeners.push(listener);
  }

  set(change: Partial<ViewState>, ...parts: Part[]): void {
    Object.assign(this.state, change);
    this.tell(...parts);
  }

  private tell(...parts: Part[]): void {
    const changed = new Set(parts);
    for (const listener of this.listeners) listener(changed);
    window.clearTimeout(this.writing);
    this.writing = window.setTimeout(() => this.write(), 120);
  }

  quantity(id: string): Quantity {
    return this.quantities.find((q) => q.id === id) ?? this.quantities[0]!;
  }

  /** The middle of its longest run of stable orbits, else of all. */
  typicalOf(row: number): number {
    const family = this.atlas.families[row];
    if (!family || family.count === 0) return -1;
    let [begin, longest, middle] = [-1, 0, family.first + (family.count >> 1)];
    for (let orbit = family.first; orbit <= family.first + family.count; ++orbit) {
      if (orbit < family.first + family.count && this.atlas.stable[orbit] === 1) {
        if (begin < 0) begin = orbit;
      } else if (begin >= 0) {
        if (orbit - begin > longest) [longest, middle] = [orbit - begin, (begin + orbit - 1) >> 1];
        begin = -1;
      }
    }
    return middle;
  }

  pick(orbit: number): void {
    if (orbit < 0 || orbit >= this.atlas.orbits) return;
    this.set({ orbit, crossing: -1 }, 'orbit', 'crossing');
  }
  pickFamily(row: number): void {
    this.pick(this.typicalOf(row));
  }
  /** The crossing, and the orbit of its family that is nearest to it. */
  pickCrossing(row: number): void {
    const crossing = this.atlas.crossings[row];
    const family = crossing && this.atlas.families[crossing.family];
    if (!crossing || !family) return;
    let orbit = this.state.orbit;
    let least = Infinity;
    for (let i = family.first; i < family.first + family.count; ++i) {
      const far = Math.abs(this.atlas.value('arclength', i) - crossing.arclength);
      if (far < least) [least, orbit] = [far, i];
    }
    this.set({ orbit, crossing: row }, 'orbit', 'crossing');
  }

  /** The state as a fragment: family by name, with its row where the name is not the only one. */
  fragment(): string {
    const s = this.state;
    const words: [string, string][] = [];
    if (s.orbit >= 0) {
      const family = this.atlas.family(s.orbit);
      words.push(['family', family.name]);
      if (this.atlas.families.filter((f) => f.name === family.name).length > 1) words.push(['row', String(family.row)]);
      words.push(['step', String(this.atlas.value('step', s.orbit))]);
    }
    if (s.crossing >= 0) words.push(['crossing', String(s.crossing)]);
    s.diagrams.forEach((diagram, i) => {
      const n = i ? '2' : '';
      words.push([`x${n}`, diagram.x], [`y${n}`, diagram.y]);
      const v = diagram.view;
      if (v) words.push([`view${n}`, [v.x0, v.x1, v.y0, v.y1].join(',')]);
    });
    if (s.hasSecond) words.push(['second', '1']);
    words.push(['colour', s.colour]);
    if (!s.showCrossings) words.push(['crossings', '0']);
    if (s.isolate) words.push(['isolate', '1']);
    return words.map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join('&');
  }

  link(): string {
    return `${location.href.split('#')[0]}#${this.fragment()}`;
  }

  private write(): void {
    const fragment = this.fragment();
    if (location.hash.slice(1) === fragment) return;
    try {
      history.replaceState(null, '', `#${fragment}`);
    } catch {
      // Safari allows a hundred changes in half a minute; the next one comes.
    }
  }

  private read(): void {
    const words = new Map<string, string>();
    for (const word of location.hash.slice(1).split('&')) {
      const [name, value] = word.split('=', 2);
      try {
        if (name && value !== undefined) words.set(name, decodeURIComponent(value));
      } catch {
        // not ours
      }
    }
    if (words.size === 0) return;
    const s = this.state;
    const known = (id: string | undefined, fallback: string): string =>
      id !== undefined && this.quantities.some((q) => q.id === id) ? id : fallback;
    s.diagrams.forEach((diagram, i) => {
      const n = i ? '2' : '';
      diagram.x = known(words.get(`x${n}`), diagram.x);
      diagram.y = known(words.get(`y${n}`), diagram.y);
      const v = (words.get(`view${n}`) ?? '').split(',').map(Number);
      const valid = v.length === 4 && v.every(Number.isFinite) && v[0]! < v[1]! && v[2]! < v[3]!;
      diagram.view = valid ? { x0: v[0]!, x1: v[1]!, y0: v[2]!, y1: v[3]! } : null;
    });
    if (words.has('x')) s.hasSecond = words.get('second') === '1';
    if (words.get('colour') === 'family' || words.get('colour') === 'stability') s.colour = words.get('colour') as ViewState['colour'];
    s.showCrossings = words.get('crossings') !== '0';
    s.isolate = words.get('isolate') === '1';
    const named = this.atlas.families.filter((f) => f.name === words.get('family'));
    const family = named.find((f) => String(f.row) === words.get('row')) ?? named[0];
    if (family) {
      const step = Number(words.get('step'));
      s.orbit = this.typicalOf(family.row);
      for (let i = family.first; i < family.first + family.count; ++i)
        if (this.atlas.value('step', i) === step) s.orbit = i;
    }
    const crossing = Number(words.get('crossing') ?? -1);
    s.crossing = this.atlas.crossings[crossing] ? crossing : -1;
  }
}
