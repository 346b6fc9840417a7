import type { Loop } from '../data/loop';
import { h } from '../dom';
import { Frame } from '../plot/frame';
import { Turn, type Triple } from '../plot/turn';
import type { OrbitPart, Shown } from './orbit_part';

const corners: Triple[] = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => [n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1]);

/** The path in three coordinates, turned by dragging or arrows: an orthographic view of the box that holds it. */
export class Space implements OrbitPart {
  readonly element: HTMLElement;
  readonly frame = new Frame({ label: 'Path in three coordinates', bare: true, square: true, fixed: true });
  readonly frames = [this.frame];
  private readonly turn = new Turn();
  private loop: Loop | null = null;

  /** `places` are the three coordinates; `alike`: they have one scale, as those of a place in space. */
  constructor(private readonly names: string[], private readonly places: Triple, private readonly alike: boolean) {
    const canvas = this.frame.canvas;
    canvas.tabIndex = 0;
    this.frame.setWhole({ x0: -1.75, x1: 1.75, y0: -1.75, y1: 1.75 });
    this.frame.onDraw = () => this.draw();
    const selects = places.map((place, n) => {
      const list = h('select', { 'aria-label': `Coordinate ${n + 1} of the path in space` });
      names.forEach((name, i) => list.append(h('option', { value: String(i) }, name)));
      list.value = String(place);
      list.addEventListener('change', () => {
        places[n] = Number(list.value);
        this.fit();
      });
      return list;
    });
    let last: { x: number; y: number } | null = null;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      last = { x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener('pointermove', (event) => {
      if (!last) return;
      this.rotate((event.clientX - last.x) * 0.01, (event.clientY - last.y) * 0.01);
      last = { x: event.clientX, y: event.clientY };
    });
    for (const end of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(end, () => (last = null));
    canvas.addEventListener('keydown', (event) => {
      const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (!by) return;
      this.rotate(by[0]!, by[1]!);
      event.preventDefault();
      event.stopPropagation();
    });
    this.element = h('div', { class: 'plane' }, h('div', { class: 'bar' }, selects), h('div', { class: 'plot small space' }, canvas));
  }

  show({ loop }: Shown): void {
    this.loop = loop;
    this.fit();
  }

  private fit(): void {
    this.frame.describe(`Path in ${this.places.map((i) => this.names[i]).join(', ')}; arrows turn it.`);
    this.frame.draw();
  }

  private rotate(turn: number, tilt: number): void {
    this.turn.rotate(turn, tilt);
    this.frame.draw();
  }

  private project(place: Triple): [number, number] {
    const [x, y] = this.turn.project(place);
    return [this.frame.px(x), this.frame.py(y)];
  }

  private draw(): void {
    const loop = this.loop;
    if (!loop) return;
    const { context: ctx, theme } = this.frame;
    const paths = this.places.map((i) => loop.states[i]!);
    const ranges = paths.map((x): [number, number] => [Math.min(...x), Math.max(...x)]);
    const widest = Math.max(...ranges.map(([a, b]) => b - a)) / 2;
    const middles = ranges.map(([a, b]) => (a + b) / 2);
    const halves = ranges.map(([a, b]) => (this.alike ? widest : Math.max((b - a) / 2, 1e-4 * widest)) || 1);
    const unit = (j: number): Triple => [0, 1, 2].map((n) => (paths[n]![j]! - middles[n]!) / halves[n]!) as Triple;
    ctx.strokeStyle = theme.grid;
    ctx.lineWidth = 1;
    for (let a = 0; a < 8; ++a)
      for (const bit of [1, 2, 4]) {
        if (a & bit) continue;
        ctx.beginPath();
        ctx.moveTo(...this.project(corners[a]!));
        ctx.lineTo(...this.project(corners[a | bit]!));
        ctx.stroke();
      }
    ctx.font = `${Math.max(11, theme.text * 0.72)}px system-ui, sans-serif`;
    ctx.fillStyle = theme.soft;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    const labels: Triple[] = [[0, -1.2, -1.2], [-1.2, 0, -1.2], [-1.2, 1.2, 0]];
    labels.forEach((at, n) => ctx.fillText(this.names[this.places[n]!]!, ...this.project(at)));
    ctx.beginPath();
    for (let j = 0; j < loop.times.length; ++j) {
      const at = this.project(unit(j));
      if (j) ctx.lineTo(...at);
      else ctx.moveTo(...at);
    }
    ctx.strokeStyle = theme.families[0]!;
    ctx.lineWidth = 1.8;
    ctx.lineJoin = 'round';
    ctx.stroke();
    ctx.fillStyle = theme.ink;
    const [x, y] = this.project(unit(0));
    ctx.fillRect(x - 3, y - 3, 6, 6);
  }
}
