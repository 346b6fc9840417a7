import type { Turn } from '../plot/turn';
import type { Theme } from '../plot/theme';

export type Point = [number, number];

/** What a picture draws with: from its own units to the canvas. */
export interface Pen {
  context: CanvasRenderingContext2D;
  theme: Theme;
  px(x: number): number;
  py(y: number): number;
  /** Pixels of a unit of length. */
  unit: number;
  /** The part of the plane that is in view. */
  x0: number;
  x1: number;
  y0: number;
  y1: number;
}

/** A system as one would see it: things that move in a plane. */
export interface Picture {
  title: string;
  /** The coordinates that it reads, which the states of an archive must begin with. */
  coordinates: string[];
  /** Set where it shows space: dragging turns it. */
  turn?: Turn;
  /** Whether axes are drawn, with these labels. */
  axes?: [string, string];
  /** Places of what moves, whose paths are drawn; in the order of the colours. */
  points(state: number[]): Point[];
  /** What must be in view besides the paths. */
  extent: Point[];
  /** Behind the paths. `energy` is the orbit's. */
  background?(pen: Pen, energy: number): void;
  /** The things at one instant. */
  figure(pen: Pen, state: number[]): void;
}

export type MakePicture = (parameters: Record<string, number>) => Picture;

export function line(pen: Pen, points: Point[], colour: string, width: number): void {
  const ctx = pen.context;
  ctx.beginPath();
  points.forEach(([x, y], i) => (i ? ctx.lineTo(pen.px(x), pen.py(y)) : ctx.moveTo(pen.px(x), pen.py(y))));
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.stroke();
}

export function disc(pen: Pen, [x, y]: Point, radius: number, colour: string): void {
  const ctx = pen.context;
  ctx.beginPath();
  ctx.arc(pen.px(x), pen.py(y), radius, 0, 2 * Math.PI);
  ctx.fillStyle = colour;
  ctx.fill();
  ctx.lineWidth = 1.5;
  ctx.strokeStyle = pen.theme.panel;
  ctx.stroke();
}

export function label(pen: Pen, [x, y]: Point, text: string, dx = 0, dy = 0): void {
  const ctx = pen.context;
  ctx.font = `${Math.max(11, pen.theme.text * 0.72)}px system-ui, sans-serif`;
  ctx.fillStyle = pen.theme.soft;
  ctx.textAlign = 'center';
  ctx.textBaseline = 'middle';
  ctx.fillText(text, pen.px(x) + dx, pen.py(y) + dy);
}
