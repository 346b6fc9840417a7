import type { MakePicture, Point } from './picture';
import { line } from './picture';
import { drawRods, rodEnds } from './rods';

/** Rods and bobs, on a pivot that may be shaken (the effect pivot_drive: along a direction in degrees from upwards). */
export const doublePendulum: MakePicture = ({ m1 = 1, m2 = 1, l1 = 1, l2 = 1, pivot_amplitude: shaken = 0, pivot_direction: direction = 0 }) => {
  const along: Point = [shaken * Math.sin((direction * Math.PI) / 180), shaken * Math.cos((direction * Math.PI) / 180)];
  const pivot = (state: number[]): Point => {
    const wave = shaken ? Math.cos(state[4] ?? 0) : 0;
    return [wave * along[0], wave * along[1]];
  };
  const points = (state: number[]): Point[] => rodEnds(state, [l1, l2], pivot(state));
  const reach = l1 + l2;
  const side = reach + Math.abs(along[0]);
  const up = reach + Math.abs(along[1]);
  return {
    title: 'Rods and bobs',
    coordinates: shaken ? ['th1', 'th2', 'w1', 'w2', 'phase'] : ['th1', 'th2'],
    points,
    extent: [[-side, -up], [side, up]],
    background(pen) {
      if (shaken) line(pen, [[-along[0], -along[1]], along], pen.theme.soft, 2);
    },
    figure(pen, state) {
      drawRods(pen, pivot(state), points(state), [m1, m2], reach);
    },
  };
};
