import { dataText, fromBase64, inflated } from './decode';
import { Loop } from './loop';

type Flat = Float64Array | Float32Array | Int32Array;
type Column<T> = T[];

interface Index {
  page: number;
  orbits: number;
  loops: number;
  deviation: number;
  harmonicsKept: number;
  harmonicsStored: number;
  blocks: number[];
  columns: { name: string; type: 'float64' | 'float32' | 'int32'; width: number; at: number }[];
  orbweaver: string;
  file: string;
  system: string;
  title: string;
  effects: string[];
  parameterNames: string[];
  parameterValues: number[];
  parameterUnits: string[];
  /** The parameter that moves along the families; empty where none does. */
  moving: string;
  /** Of the system and its coordinates, in words; empty where the program did not know the system. */
  meaning: string;
  stateNames: string[];
  angles: number[];
  pairs: number;
  multipliers: boolean;
  complex: boolean;
  verdicts: string[];
  scene: string;
  families: Record<string, Column<number> & Column<string>>;
  crossings: Record<string, Column<number> & Column<string>>;
  findings: Record<string, Column<number> & Column<string>>;
}

export interface Family {
  row: number;
  name: string;
  parent: number;
  crossing: number;
  multiplicity: number;
  isotropy: string;
  first: number;
  count: number;
  endReason: string;
  endFamily: number;
  endCrossing: number;
  children: number[];
  crossings: number[];
  depth: number;
}

export interface Crossing {
  row: number;
  family: number;
  arclength: number;
  period: number;
  energy: number;
  parameter: number;
  kind: string;
  multiplicity: number;
  kernelDimension: number;
  residual: number;
  state: number[];
  sectorJ: number;
  sectorQ: number;
  born: number[];
  /** Families that end there, without its own. */
  ended: number[];
}

export interface Finding {
  severity: string;
  kind: string;
  family: number;
  text: string;
}

export type Stable = 1 | 0 | -1;

export interface Complex {
  re: number;
  im: number;
}

const blocksKept = 24;

/** What the page's data say. Rows are those of the archive. */
export class Atlas {
  readonly families: Family[];
  readonly crossings: Crossing[];
  readonly findings: Finding[];
  readonly orbits: number;
  readonly familyOf: Int32Array;
  readonly stable: Int32Array;
  private readonly columns = new Map<string, { values: Flat; width: number }>();
  private readonly blocks = new Map<number, Promise<Uint8Array>>();
  private readonly loopText: string;

  static async read(): Promise<Atlas> {
    const [index, columns] = await Promise.all(
      ['atlas-index', 'atlas-columns'].map((id) => inflated(fromBase64(dataText(id)))),
    );
    return new Atlas(JSON.parse(new TextDecoder().decode(index)) as Index, columns!);
  }

  private constructor(readonly index: Index, bytes: Uint8Array<ArrayBuffer>) {
    this.orbits = index.orbits;
    for (const { name, type, width, at } of index.columns) {
      const length = index.orbits * width;
      const Type = { float64: Float64Array, float32: Float32Array, int32: Int32Array }[type];
      this.columns.set(name, { values: new Type(bytes.buffer, at, length), width });
    }
    this.loopText = dataText('atlas-loops');
    this.stable = this.columns.get('stable')!.values as Int32Array;
    const number = (table: Index['families'], name: string, row: number): number => table[name]?.[row] ?? NaN;
    const text = (table: Index['families'], name: string, row: number): string => String(table[name]?.[row] ?? '');
    const f = index.families;
    this.families = f['name']!.map((_, row) => ({
      row,
      name: text(f, 'name', row),
      parent: number(f, 'parent', row),
      crossing: number(f, 'crossing', row),
      multiplicity: number(f, 'multiplicity', row),
      isotropy: text(f, 'isotropy', row),
      first: number(f, 'first_orbit', row),
      count: number(f, 'orbit_count', row),
      endReason: text(f, 'end_reason', row),
      endFamily: number(f, 'end_family', row),
      endCrossing: number(f, 'end_crossing', row),
      children: [],
      crossings: [],
      depth: 0,
    }));
    const c = index.crossings;
    const dimension = index.stateNames.length;
    this.crossings = c['kind']!.map((_, row) => ({
      row,
      family: number(c, 'family', row),
      arclength: number(c, 'arclength', row),
      period: number(c, 'period', row),
      energy: number(c, 'energy', row),
      parameter: number(c, 'parameter', row),
      kind: text(c, 'kind', row),
      multiplicity: number(c, 'multiplicity', row),
      kernelDimension: number(c, 'kernel_dimension', row),
      residual: number(c, 'residual', row),
      state: (c['state'] as number[]).slice(row * dimension, (row + 1) * dimension).map((x) => x ?? NaN),
      sectorJ: number(c, 'sector_j', row),
      sectorQ: number(c, 'sector_q', row),
      born: [],
      ended: [],
    }));
    const g = index.findings;
    this.findings = (g['text'] ?? []).map((_, row) => ({
      severity: text(g, 'severity', row),
      kind: text(g, 'kind', row),
      family: number(g, 'family', row),
      text: text(g, 'text', row),
    }));
    this.familyOf = new Int32Array(index.orbits).fill(-1);
    for (const family of this.families) {
      if (family.count > 0) this.familyOf.fill(family.row, family.first, family.first + family.count);
      this.families[family.parent]?.children.push(family.row);
      this.crossings[family.crossing]?.born.push(family.row);
      const end = this.crossings[family.endCrossing];
      if (end && end.family !== family.row) end.ended.push(family.row);
      let depth = 0;
      for (let up = family.parent; up >= 0 && depth < this.families.length; up = this.families[up]!.parent) ++depth;
      family.depth = depth;
    }
    for (const crossing of this.crossings) this.families[crossing.family]?.crossings.push(crossing.row);
  }

  /** A value of an orbit; NaN for a column that the page has not. */
  value(name: string, orbit: number, part = 0): number {
    const column = this.columns.get(name);
    return column && part < column.width ? column.values[orbit * column.width + part]! : NaN;
  }
  width(name: string): number {
    return this.columns.get(name)?.width ?? 0;
  }
  columnNames(): string[] {
    return [...this.columns.keys()];
  }
  parts(name: string, orbit: number): number[] {
    return Array.from({ length: this.width(name) }, (_, part) => this.value(name, orbit, part));
  }
  family(orbit: number): Family {
    return this.families[this.familyOf[orbit]!]!;
  }
  parameters(): Record<string, number> {
    return Object.fromEntries(this.index.parameterNames.map((name, i) => [name, this.index.parameterValues[i]!]));
  }
  /** Those of an orbit: the one that moves along the families has the orbit's value. */
  parametersOf(orbit: number): Record<string, number> {
    const { moving } = this.index;
    const value = this.value('parameter', orbit);
    const all = this.parameters();
    return moving && Number.isFinite(value) ? { ...all, [moving]: value } : all;
  }
  winding(orbit: number): number[] {
    const turns = this.index.stateNames.map(() => 0);
    this.index.angles.forEach((coordinate, n) => {
      const winds = this.value('winding', orbit, n);
      turns[coordinate] = Number.isFinite(winds) ? winds : 0;
    });
    return turns;
  }

  /** The indices mu + 1/mu of an orbit's pairs, or its multipliers; `column` as in the archive. */
  stabilityValues(column: 'stability' | 'fundamental_stability', orbit: number): Complex[] {
    const values = this.parts(column, orbit);
    if (!this.index.complex) return values.map((re) => ({ re, im: 0 }));
    return Array.from({ length: values.length / 2 }, (_, i) => ({ re: values[2 * i]!, im: values[2 * i + 1]! }));
  }

  /** All nontrivial multipliers. */
  multipliers(column: 'stability' | 'fundamental_stability', orbit: number): Complex[] {
    const values = this.stabilityValues(column, orbit).filter((v) => Number.isFinite(v.re));
    return this.index.multipliers ? values : values.flatMap(ofIndex);
  }

  /** The orbit itself, or the nearest of its family that has a loop on the page. */
  nearestWithLoop(orbit: number): number {
    const { first, count } = this.family(orbit);
    for (let by = 0; by < count; ++by)
      for (const other of [orbit - by, orbit + by])
        if (other >= first && other < first + count && this.value('loop_block', other) >= 0) return other;
    return -1;
  }

  /** The loop of an orbit that has one. */
  async loop(orbit: number): Promise<Loop> {
    const number = this.value('loop_block', orbit);
    let block = this.blocks.get(number);
    this.blocks.delete(number);
    if (!block) {
      const [begin, end] = [this.index.blocks[2 * number]!, this.index.blocks[2 * number + 1]!];
      const text = this.loopText.slice((begin / 3) * 4, Math.ceil(end / 3) * 4);
      block = inflated(fromBase64(text).slice(0, end - begin));
    }
    this.blocks.set(number, block);
    if (this.blocks.size > blocksKept) this.blocks.delete(this.blocks.keys().next().value!);
    return new Loop(await block, this.value('loop_begin', orbit), this.index.stateNames.length, this.winding(orbit));
  }
}

/** mu and 1/mu with mu + 1/mu = k; mu is the larger one. */
function ofIndex(k: Complex): Complex[] {
  // The root of k^2 - 4.
  const re = k.re * k.re - k.im * k.im - 4;
  const im = 2 * k.re * k.im;
  const size = Math.hypot(re, im);
  const root = {
    re: Math.sqrt(Math.max(0, (size + re) / 2)),
    im: (im < 0 ? -1 : 1) * Math.sqrt(Math.max(0, (size - re) / 2)),
  };
  const sign = k.re * root.re + k.im * root.im < 0 ? -1 : 1;
  const mu = { re: (k.re + sign * root.re) / 2, im: (k.im + sign * root.im) / 2 };
  const square = mu.re * mu.re + mu.im * mu.im;
  return [mu, { re: mu.re / square, im: -mu.im / square }];
}
