import type { Atlas } from './atlas';
import type { Quantity } from './quantities';

/** A family in the plane of two quantities: its orbits and crossings in order, and cubic pieces between them. */
export interface Curve {
  family: number;
  /** The orbit of a vertex, or -1 - row for a crossing. */
  vertices: Int32Array;
  x: Float64Array;
  y: Float64Array;
  /** Of the piece that begins at a vertex: 1 stable, 0 unstable, -1 not known, -2 no piece. */
  stable: Int8Array;
  /** Slopes at the vertices times a third of the piece before and behind: Bezier's control points. */
  before: Float64Array;
  behind: Float64Array;
  /** Vertices in order, the coarsest first: each is at least `apart` from the one before, in parts of the whole diagram. */
  levels: { apart: number; vertices: Int32Array }[];
  /** Places in `vertices` of crossings. */
  crossings: Int32Array;
  /** Of the vertices, and so of the pieces, which are limited to them. */
  box: { x0: number; x1: number; y0: number; y1: number };
}

const noPiece = -2;

/**
 * Slopes at vertices by the parabola through each and its neighbours (Bessel's), against arclength, limited so that no piece
 * leaves the range of its ends (Fritsch and Carlson 1980): folds that were located are vertices themselves.
 */
function slopes(s: Float64Array, v: Float64Array): Float64Array {
  const n = v.length;
  const out = new Float64Array(n);
  const rate = (i: number): number => (s[i + 1]! > s[i]! ? (v[i + 1]! - v[i]!) / (s[i + 1]! - s[i]!) : 0);
  const limited = (slope: number, ...rates: number[]): number => {
    const sign = Math.sign(rates[0]!);
    if (rates.some((r) => Math.sign(r) !== sign)) return 0;
    return sign * Math.min(Math.max(0, sign * slope), ...rates.map((r) => 3 * Math.abs(r)));
  };
  for (let i = 0; i < n && n > 1; ++i) {
    if (i === 0 || i === n - 1) {
      const at = i === 0 ? 0 : n - 2;
      const beside = i === 0 ? 1 : n - 3;
      const bend = n > 2 ? (rate(at) - rate(beside)) * (s[at + 1]! - s[at]!) / (Math.abs(s[Math.max(at, beside) + 1]! - s[Math.min(at, beside)]!) || 1) : 0;
      out[i] = limited(rate(at) + bend, rate(at));
    } else {
      const a = s[i]! - s[i - 1]!;
      const b = s[i + 1]! - s[i]!;
      out[i] = a + b > 0 ? limited((rate(i - 1) * b + rate(i) * a) / (a + b), rate(i - 1), rate(i)) : 0;
    }
    if (!Number.isFinite(out[i]!)) out[i] = 0;
  }
  return out;
}

/** The coarsest level, in parts of the whole diagram, and how many there are, each twice as fine. */
const coarsest = 1 / 500;
const mostLevels = 8;

/** Makes a curve's levels; a vertex at which stability changes is in all of them. */
export function addLevels(curve: Curve, width: number, height: number): void {
  const { x, y, stable } = curve;
  const n = x.length;
  for (let level = 0, apart = coarsest; level < mostLevels; ++level, apart /= 2) {
    const kept: number[] = n ? [0] : [];
    for (let i = 1, last = 0; i < n; ++i) {
      const far = Math.hypot((x[i]! - x[last]!) / width, (y[i]! - y[last]!) / height);
      if (i < n - 1 && stable[i] === stable[i - 1] && far < apart) continue;
      kept.push(i);
      last = i;
    }
    // As fine as the curve itself.
    if (kept.length > 0.8 * n) break;
    curve.levels.push({ apart, vertices: Int32Array.from(kept) });
  }
}

export function curvesOf(atlas: Atlas, qx: Quantity, qy: Quantity): Curve[] {
  return atlas.families.map((family) => {
    const places: [number, number][] = [];
    for (let orbit = family.first; orbit < family.first + family.count; ++orbit)
      places.push([atlas.value('arclength', orbit), orbit]);
    const reach = places.length ? [places[0]![0], places[places.length - 1]![0]] : [0, 0];
    for (const row of family.crossings) {
      const s = atlas.crossings[row]!.arclength;
      // Between the birth and the first orbit only where the family's side is clear.
      if (places.length && s > reach[0]! && s < reach[1]!) places.push([s, -1 - row]);
    }
    places.sort((a, b) => a[0] - b[0]);
    const n = places.length;
    const wx = qx.warp?.to ?? ((v: number) => v);
    const wy = qy.warp?.to ?? ((v: number) => v);
    const s = Float64Array.from(places, (p) => p[0]);
    const vertices = Int32Array.from(places, (p) => p[1]);
    const value = (q: Quantity, id: number): number =>
      id >= 0 ? q.values[id]! : q.ofCrossing(atlas.crossings[-1 - id]!);
    const x = Float64Array.from(vertices, (id) => wx(value(qx, id)));
    const y = Float64Array.from(vertices, (id) => wy(value(qy, id)));
    const stable = new Int8Array(n).fill(noPiece);
    const side = (i: number, step: number): number => {
      let j = i;
      while (j >= 0 && j < n && vertices[j]! < 0) j += step;
      return j >= 0 && j < n ? atlas.stable[vertices[j]!]! : -1;
    };
    for (let i = 0; i + 1 < n; ++i) {
      const [a, b] = [vertices[i]!, vertices[i + 1]!];
      // Between an orbit and a crossing the orbit says; between two crossings, or two orbits, both must.
      if (a >= 0 && b < 0) stable[i] = atlas.stable[a]!;
      else if (a < 0 && b >= 0) stable[i] = atlas.stable[b]!;
      else stable[i] = Math.min(side(i, -1), side(i + 1, 1));
      if (![x[i]!, y[i]!, x[i + 1]!, y[i + 1]!].every(Number.isFinite)) stable[i] = noPiece;
    }
    const [mx, my] = [slopes(s, x), slopes(s, y)];
    const before = new Float64Array(2 * n);
    const behind = new Float64Array(2 * n);
    for (let i = 0; i < n; ++i) {
      const back = i > 0 ? (s[i]! - s[i - 1]!) / 3 : 0;
      const on = i + 1 < n ? (s[i + 1]! - s[i]!) / 3 : 0;
      before[2 * i] = x[i]! - mx[i]! * back;
      before[2 * i + 1] = y[i]! - my[i]! * back;
      behind[2 * i] = x[i]! + mx[i]! * on;
      behind[2 * i + 1] = y[i]! + my[i]! * on;
    }
    const box = { x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity };
    for (let i = 0; i < n; ++i) {
      if (!Number.isFinite(x[i]!) || !Number.isFinite(y[i]!)) continue;
      box.x0 = Math.min(box.x0, x[i]!);
      box.x1 = Math.max(box.x1, x[i]!);
      box.y0 = Math.min(box.y0, y[i]!);
      box.y1 = Math.max(box.y1, y[i]!);
    }
    const crossings = Int32Array.from(vertices.keys()).filter((i) => vertices[i]! < 0);
    return { family: family.row, vertices, x, y, stable, before, behind, levels: [], crossings, box };
  });
}
