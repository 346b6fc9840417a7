import { disc, line, type Pen, type Point } from './picture';

/** Ends of rods that hang one from the other, the first from the pivot; angles from the downward vertical. */
export function rodEnds(angles: number[], lengths: number[], pivot: Point = [0, 0]): Point[] {
  let [x, y] = pivot;
  return lengths.map((length, i): Point => {
    x += length * Math.sin(angles[i]!);
    y -= length * Math.cos(angles[i]!);
    return [x, y];
  });
}

/** Rods and bobs of the same density. */
export function drawRods(pen: Pen, pivot: Point, ends: Point[], masses: number[], reach: number): void {
  line(pen, [pivot, ...ends], pen.theme.ink, 3);
  disc(pen, pivot, 4, pen.theme.soft);
  // Bobs of a long chain do not touch.
  const radius = Math.max(4, Math.min(13, 0.14 * (reach / ends.length) * pen.unit));
  const largest = Math.max(...masses);
  ends.forEach((end, i) => disc(pen, end, radius * Math.cbrt(masses[i]! / largest), pen.theme.families[i % 8]!));
}
