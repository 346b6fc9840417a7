import { ticks as niceTicks } from 'd3-array';
import type { Warp } from '../data/quantities';

export interface Ticks {
  /** Where, as drawn. */
  at: number[];
  labels: string[];
  /** What is to be added to the labels: "8.4429341", and their power of ten; or nothing. */
  base: string;
  power: number;
}

const minus = (text: string): string => text.replace('-', '−');

function decimalsOf(step: number): number {
  return Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
}

const superscripts: Record<string, string> = { '-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴', '5': '⁵', '6': '⁶', '7': '⁷', '8': '⁸', '9': '⁹' };
export function powerOfTen(power: number): string {
  return `10${[...String(power)].map((c) => superscripts[c]).join('')}`;
}

/** Beyond this many digits labels are told from a base. */
const mostDigits = 6;

/** Of a warped axis; a narrower range has evenly spaced numbers. */
const nearlyLinear = 1;

export function axisTicks(low: number, high: number, count: number, warp?: Warp): Ticks {
  if (warp && (low < -2 || high > 2)) {
    if (high - low > nearlyLinear) return warpedTicks(low, high, count, warp);
    const ticks = axisTicks(warp.from(low), warp.from(high), count);
    return { ...ticks, at: ticks.at.map((value) => warp.to(value)) };
  }
  let at = niceTicks(low, high, count).filter((v) => v >= low && v <= high);
  if (at.length < 2) at = [low + (high - low) * 0.1, low + (high - low) * 0.9];
  const step = at[1]! - at[0]!;
  const size = Math.max(Math.abs(low), Math.abs(high));
  const decimals = decimalsOf(step);
  const digits = Math.ceil(Math.log10(size / step + 1));
  if (digits > mostDigits) {
    const power = Math.floor(Math.log10(step) + 1e-9);
    const base = at[Math.floor(at.length / 2)]!;
    const scale = 10 ** -power;
    return {
      at,
      labels: at.map((v) => minus(v === base ? '0' : `${v > base ? '+' : ''}${Math.round((v - base) * scale)}`)),
      base: minus(base.toFixed(Math.min(20, decimals))),
      power,
    };
  }
  if (size > 0 && (size >= 1e6 || decimals > mostDigits)) {
    const power = Math.floor(Math.log10(size));
    const scale = 10 ** power;
    const left = Math.max(0, decimalsOf(step / scale));
    return { at, labels: at.map((v) => minus((v / scale).toFixed(left))), base: '', power };
  }
  return { at, labels: at.map((v) => minus(v.toFixed(decimals))), base: '', power: 0 };
}

/** Numbers of both signs: `inner` in the linear part, up to 2, and `outer` times the powers of ten beyond. */
function warpedValues(inner: number[], outer: number[]): number[] {
  const beyond = Array.from({ length: 301 }, (_, decade) => outer.map((value) => value * 10 ** decade)).flat().filter((value) => value > 2);
  return [...new Set([...inner, ...beyond].flatMap((value) => [value, -value]))];
}

/** From many to few. */
const warpedLevels = [warpedValues([0, 0.5, 1, 1.5, 2], [1, 2, 3, 4, 5, 6, 8]), warpedValues([0, 1, 2], [1, 2, 5]), warpedValues([0, 2], [1])];

function warpedTicks(low: number, high: number, count: number, warp: Warp): Ticks {
  const most = Math.max(3, count);
  // Beyond some ten decades there is no room for both 0 and 2.
  const levels = high - low > 40 ? [warpedValues([0], [1])] : warpedLevels;
  let at: { value: number; drawn: number }[] = [];
  for (const values of levels) {
    at = values.map((value) => ({ value, drawn: warp.to(value) })).filter((t) => t.drawn >= low && t.drawn <= high);
    if (at.length <= most) break;
  }
  at.sort((a, b) => a.drawn - b.drawn);
  const every = Math.ceil(at.length / most);
  if (every > 1)
    at = at.filter(({ value }) => Math.abs(value) <= 2 || Math.round(Math.log10(Math.abs(value))) % every === 0);
  const label = (v: number): string => {
    const decade = Math.floor(Math.log10(Math.abs(v)) + 1e-9);
    if (Math.abs(v) < 1000) return minus(String(v));
    const factor = Math.round(Math.abs(v) / 10 ** decade);
    return `${v < 0 ? '−' : ''}${factor === 1 ? '' : `${factor}·`}${powerOfTen(decade)}`;
  };
  return { at: at.map((t) => t.drawn), labels: at.map((t) => label(t.value)), base: '', power: 0 };
}
