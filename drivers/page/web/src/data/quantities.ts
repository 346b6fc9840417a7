import type { Atlas, Crossing } from './atlas';

/** Something an orbit has one of: an axis of a diagram. */
export interface Quantity {
  id: string;
  label: string;
  /** As a heading in CSV and on axes where room is short. */
  short: string;
  values: Float64Array;
  ofCrossing(crossing: Crossing): number;
  /** Drawn as to(value): for quantities over many decades on both sides of 0. */
  warp?: Warp;
}

export interface Warp {
  to(value: number): number;
  from(drawn: number): number;
}

/** Linear up to 2, where a pair leaves the unit circle, then logarithmic. */
export const indexWarp: Warp = {
  to: (k) => (Math.abs(k) <= 2 ? k : Math.sign(k) * (2 + 2 * Math.log(Math.abs(k) / 2))),
  from: (u) => (Math.abs(u) <= 2 ? u : Math.sign(u) * 2 * Math.exp((Math.abs(u) - 2) / 2)),
};

/** The orbits beside a crossing, and how far it is from the first to the second; beyond the family its end, twice. */
function neighbours(atlas: Atlas, crossing: Crossing): [number, number, number] {
  const family = atlas.families[crossing.family]!;
  if (family.count === 0) return [-1, -1, NaN];
  const s = (orbit: number): number => atlas.value('arclength', orbit);
  let low = family.first;
  let high = family.first + family.count - 1;
  if (crossing.arclength <= s(low)) return [low, low, 0];
  if (crossing.arclength >= s(high)) return [high, high, 0];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (s(middle) <= crossing.arclength) low = middle;
    else high = middle;
  }
  return [low, high, (crossing.arclength - s(low)) / (s(high) - s(low))];
}

/** The orbits' values at the arclength of a crossing, linearly between its neighbours. */
function interpolated(atlas: Atlas, crossing: Crossing, values: Float64Array): number {
  const [low, high, part] = neighbours(atlas, crossing);
  return low < 0 ? NaN : values[low]! + part * (values[high]! - values[low]!);
}

/** Of the largest modulus of a multiplier: where it passes 1 beside a crossing, at which a multiplier has modulus 1, it is 1 there. */
function largestAt(atlas: Atlas, crossing: Crossing, values: Float64Array): number {
  const [low, high] = neighbours(atlas, crossing);
  return (values[low]! - 1) * (values[high]! - 1) <= 0 ? 1 : interpolated(atlas, crossing, values);
}

/** All axes that an atlas has: those of which every value is missing are left out. */
export function quantitiesOf(atlas: Atlas): Quantity[] {
  const column = (name: string, part = 0): Float64Array =>
    Float64Array.from({ length: atlas.orbits }, (_, orbit) => atlas.value(name, orbit, part));
  const list: Quantity[] = [];
  const add = (id: string, label: string, short: string, values: Float64Array, more: Partial<Quantity> = {}): void => {
    if (id !== 'T' && !values.some(Number.isFinite)) return;
    list.push({ id, label, short, values, ofCrossing: (c) => interpolated(atlas, c, values), ...more });
  };
  const names = atlas.index.stateNames;
  add('T', 'period T', 'T', column('period'), { ofCrossing: (c) => c.period });
  const turns = atlas.families.map((family) => {
    let product = family.multiplicity;
    for (let up = family.parent, n = 0; up >= 0 && n < atlas.families.length; up = atlas.families[up]!.parent, ++n)
      product *= atlas.families[up]!.multiplicity;
    return product;
  });
  if (turns.some((n) => n > 1))
    add('T/m', "period T / m, m turns of the first family's", 'T/m',
      Float64Array.from({ length: atlas.orbits }, (_, orbit) => atlas.value('period', orbit) / turns[atlas.familyOf[orbit]!]!),
      { ofCrossing: (c) => c.period / (turns[c.family] ?? 1) });
  add('E', 'energy E', 'E', column('energy'), { ofCrossing: (c) => c.energy });
  const moving = atlas.index.moving || 'parameter';
  const unit = atlas.index.parameterUnits[atlas.index.parameterNames.indexOf(moving)];
  add('parameter', unit && unit !== '1' ? `${moving} (${unit})` : moving, moving, column('parameter'), { ofCrossing: (c) => c.parameter });
  add('action', 'action', 'action', column('action'));
  const noun = atlas.index.multipliers ? 'multiplier' : 'stability index';
  for (const [name, of] of [
    ['stability', ''],
    ['fundamental_stability', ' of the fundamental map'],
  ] as const) {
    const width = atlas.width(name);
    for (let part = 0; part < width; ++part) {
      const number = atlas.index.pairs > 1 ? ` ${atlas.index.complex ? Math.floor(part / 2) + 1 : part + 1}` : '';
      const side = atlas.index.complex ? (part % 2 ? ', imaginary part' : ', real part') : '';
      const id = `${name === 'stability' ? 'k' : 'kf'}${width > 1 ? part : ''}`;
      add(id, `${noun}${number}${side}${of}`, id, column(name, part), { warp: indexWarp });
    }
  }
  if (atlas.index.complex) {
    const largest = Float64Array.from({ length: atlas.orbits }, (_, orbit) => {
      const sizes = atlas.multipliers('stability', orbit).map((m) => Math.hypot(m.re, m.im));
      return sizes.length ? Math.max(...sizes) : NaN;
    });
    add('rho', 'largest |μ|', '|μ|', largest, { warp: indexWarp, ofCrossing: (c) => largestAt(atlas, c, largest) });
  }
  add('amplitude', 'rms amplitude', 'amplitude', column('amplitude'));
  names.forEach((name, i) => add(`max-${name}`, `largest ${name}`, `max ${name}`, column('largest', i)));
  names.forEach((name, i) =>
    add(`at0-${name}`, `${name} at s = 0`, `${name}(0)`, column('state', i), { ofCrossing: (c) => c.state[i] ?? NaN }),
  );
  add('s', 'arclength along the family', 's', column('arclength'), { ofCrossing: (c) => c.arclength });
  return list;
}

/** Digits enough to recover the number, and no more. */
export function exact(value: number): string {
  return Number.isFinite(value) ? String(value) : 'not computed';
}
export function rounded(value: number, digits = 7): string {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  return (size >= 1e-4 && size < 1e7 ? String(Number(value.toPrecision(digits))) : value.toExponential(Math.max(0, digits - 3))).replace('-', '−');
}
