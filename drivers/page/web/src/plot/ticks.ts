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

export function axisTicks(low: number, high: number, count: number, warp?: Warp): Ticks {
  if (warp && (warp.from(low) < -4 || warp.from(high) > 4)) return warpedTicks(low, high, count, warp);
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

function warpedTicks(low: number, high: number, count: number, warp: Warp): Ticks {
  // Beyond some ten decades there is no room for both.
  const values = high - low > 40 ? [0] : [-2, 0, 2];
  for (let decade = 1; decade <= 300; ++decade) for (const sign of [-1, 1]) values.push(sign * 10 ** decade);
  let at = values.map((value) => ({ value, drawn: warp.to(value) })).filter((t) => t.drawn >= low && t.drawn <= high);
  at.sort((a, b) => a.drawn - b.drawn);
  const every = Math.ceil(at.length / Math.max(3, count));
  if (every > 1)
    at = at.filter(({ value }) => Math.abs(value) <= 2 || Math.round(Math.log10(Math.abs(value))) % every === 0);
  const label = (v: number): string =>
    Math.abs(v) < 1000 ? minus(String(v)) : `${v < 0 ? '−' : ''}${powerOfTen(Math.round(Math.log10(Math.abs(v))))}`;
  return { at: at.map((t) => t.drawn), labels: at.map((t) => label(t.value)), base: '', power: 0 };
}
