import { contours } from 'd3-contour';
import type { Pen } from './picture';

const cells = 96;

/** Where f lies on a grid over the view. */
function grid(pen: Pen, f: (x: number, y: number) => number): number[] {
  const values = new Array<number>(cells * cells);
  for (let j = 0; j < cells; ++j)
    for (let i = 0; i < cells; ++i)
      values[j * cells + i] = f(pen.x0 + ((i + 0.5) / cells) * (pen.x1 - pen.x0), pen.y0 + ((j + 0.5) / cells) * (pen.y1 - pen.y0));
  return values;
}

function trace(pen: Pen, values: number[], level: number): Path2D {
  const path = new Path2D();
  const shape = contours().size([cells, cells]).smooth(true).contour(values, level);
  const x = (i: number): number => pen.px(pen.x0 + (i / cells) * (pen.x1 - pen.x0));
  const y = (j: number): number => pen.py(pen.y0 + (j / cells) * (pen.y1 - pen.y0));
  for (const polygon of shape.coordinates)
    for (const ring of polygon) {
      ring.forEach(([i, j], n) => (n ? path.lineTo(x(i!), y(j!)) : path.moveTo(x(i!), y(j!))));
      path.closePath();
    }
  return path;
}

/** Lines of equal f, and the region where f exceeds `energy`, which an orbit of that energy cannot enter. */
export function drawPotential(pen: Pen, f: (x: number, y: number) => number, levels: number[], energy: number): void {
  const ctx = pen.context;
  const values = grid(pen, f);
  ctx.save();
  if (Number.isFinite(energy)) {
    ctx.fillStyle = pen.theme.soft;
    ctx.globalAlpha = 0.16;
    ctx.fill(trace(pen, values, energy), 'evenodd');
    ctx.globalAlpha = 1;
  }
  ctx.strokeStyle = pen.theme.soft;
  ctx.globalAlpha = 0.45;
  ctx.lineWidth = 1;
  for (const level of levels) ctx.stroke(trace(pen, values, level));
  ctx.restore();
}
