import { h } from '../dom';
import { Frame } from '../plot/frame';
import { boxOf, drawDot, drawPath, withoutRounding } from '../plot/path';
import type { Point } from '../pictures/picture';
import type { Clock } from './clock';
import { section, type OrbitPart, type Shown } from './orbit_part';

/** Two paths, each in a plane of any two coordinates. */
export class Planes implements OrbitPart {
  readonly element: HTMLElement;
  readonly frames: Frame[];
  private shown: Shown | null = null;
  private readonly axes: [number, number][];

  constructor(private readonly names: string[], private readonly clock: Clock) {
    const d = names.length;
    const half = d % 2 === 0 && d >= 2 ? d / 2 : Math.min(1, d - 1);
    this.axes = d >= 4 ? [[0, 1], [0, half]] : [[0, Math.min(1, d - 1)], [0, d - 1]];
    this.frames = this.axes.map((_, i) => new Frame({ label: `Path ${i + 1}`, inPanel: true }));
    const planes = this.frames.map((frame, i) => {
      frame.onDraw = () => this.draw(i);
      frame.onOverlay = () => this.drawNow(i);
      clock.on(() => frame.tick());
      return h('div', { class: 'plane' },
        h('div', { class: 'bar' }, this.choice(i, 1), ' against ', this.choice(i, 0)), h('div', { class: 'plot small' }, frame.canvas));
    });
    this.element = section('Paths', true, this.frames, h('div', { class: 'planes' }, ...planes));
  }

  show(shown: Shown): void {
    this.shown = shown;
    this.axes.forEach((_, i) => this.fit(i));
  }

  private choice(i: number, part: 0 | 1): HTMLSelectElement {
    const list = h('select', { 'aria-label': `${part ? 'Vertical' : 'Horizontal'} axis of path ${i + 1}` });
    this.names.forEach((name, n) => list.append(h('option', { value: String(n) }, name)));
    list.value = String(this.axes[i]![part]);
    list.addEventListener('change', () => {
      this.axes[i]![part] = Number(list.value);
      this.fit(i);
    });
    return list;
  }

  /** Horizontal and vertical of a plane. */
  private states(i: number, { loop }: Shown): [Float64Array, Float64Array] {
    const [a, b] = this.axes[i]!;
    return [loop.states[a]!, loop.states[b]!];
  }

  private fit(i: number): void {
    if (!this.shown) return;
    const [a, b] = this.axes[i]!;
    const [x, y] = this.states(i, this.shown);
    const frame = this.frames[i]!;
    frame.x.label = this.names[a]!;
    frame.y.label = this.names[b]!;
    frame.setWhole(withoutRounding(boxOf(Array.from(x, (v, j): Point => [v, y[j]!])), this.shown.loop.states));
    frame.describe(`Path of the orbit, ${this.names[b]} against ${this.names[a]}.`);
  }

  private draw(i: number): void {
    if (!this.shown) return;
    const [x, y] = this.states(i, this.shown);
    const frame = this.frames[i]!;
    drawPath(frame, x.length, (j) => [x[j]!, y[j]!], frame.theme.families[0]!);
    frame.context.fillStyle = frame.theme.ink;
    frame.context.fillRect(frame.px(x[0]!) - 3, frame.py(y[0]!) - 3, 6, 6);
  }

  private drawNow(i: number): void {
    if (!this.shown) return;
    const state = this.shown.loop.at(this.clock.time);
    const [a, b] = this.axes[i]!;
    drawDot(this.frames[i]!, state[a]!, state[b]!);
  }
}
