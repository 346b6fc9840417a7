import type { Point } from '../pictures/picture';
import type { Box, Frame } from './frame';

/** Lines through points of the frame's own coordinates. */
export function drawPath(frame: Frame, count: number, at: (j: number) => Point, colour: string): void {
  const ctx = frame.context;
  ctx.beginPath();
  for (let j = 0; j < count; ++j) {
    const [x, y] = at(j);
    if (j) ctx.lineTo(frame.px(x), frame.py(y));
    else ctx.moveTo(frame.px(x), frame.py(y));
  }
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.8;
  ctx.lineJoin = 'round';
  ctx.stroke();
}

/** Where the orbit is now. */
export function drawDot(frame: Frame, x: number, y: number): void {
  const ctx = frame.context;
  ctx.beginPath();
  ctx.arc(frame.px(x), frame.py(y), 5, 0, 2 * Math.PI);
  ctx.fillStyle = frame.theme.pick;
  ctx.fill();
  ctx.strokeStyle = frame.theme.panel;
  ctx.lineWidth = 1.5;
  ctx.stroke();
}

/** Bounds of some points. */
export function boxOf(points: Iterable<Point>): Box {
  const box = { x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity };
  for (const [x, y] of points) {
    box.x0 = Math.min(box.x0, x);
    box.x1 = Math.max(box.x1, x);
    box.y0 = Math.min(box.y0, y);
    box.y1 = Math.max(box.y1, y);
  }
  return box;
}

/** Ranges that are rounding beside those of `states` are widened, so that they do not fill the plot. */
export function withoutRounding(box: Box, states: Float64Array[]): Box {
  const widest = Math.max(...states.map((x) => Math.max(...x) - Math.min(...x)));
  const widen = (low: number, high: number): [number, number] => {
    const least = 2e-4 * widest;
    return high - low >= least ? [low, high] : [(low + high) / 2 - least / 2, (low + high) / 2 + least / 2];
  };
  const [x0, x1] = widen(box.x0, box.x1);
  const [y0, y1] = widen(box.y0, box.y1);
  return { x0, x1, y0, y1 };
}
