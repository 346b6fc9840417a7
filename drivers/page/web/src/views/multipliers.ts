import type { Atlas, Complex } from '../data/atlas';
import { rounded } from '../data/quantities';
import { h, replaceChildren } from '../dom';
import type { Point } from '../pictures/picture';
import { Frame } from '../plot/frame';
import { section } from './orbit_part';

/** A number that does not break over lines. */
export function complexText({ re, im }: Complex): string {
  return Math.abs(im) > 0 ? `${rounded(re)}\u00a0${im < 0 ? '−' : '+'}\u00a0${rounded(Math.abs(im))}\u00a0i` : rounded(re);
}

/** Beyond the unit circle 2 − 1/r stands for r: a pair mu, 1/mu lies at equal distances from the circle. */
function inCompressedPlane({ re, im }: Complex): Point {
  const r = Math.hypot(re, im);
  const scale = r > 1 ? (2 - 1 / r) / r : 1;
  return [re * scale, im * scale];
}

/** Beyond the circle by more than rounding. */
const isOut = ({ re, im }: Complex): boolean => Math.hypot(re, im) > 1 + 1e-3;

/** The multipliers of an orbit around the unit circle, and as numbers. */
export class Multipliers {
  readonly element: HTMLElement;
  readonly frame = new Frame({ label: 'Multipliers', square: true, bare: true, fixed: true });
  private orbit = -1;
  private readonly list = h('div', { class: 'values' });

  constructor(private readonly atlas: Atlas) {
    this.frame.onDraw = () => this.draw();
    this.frame.setWhole({ x0: -2, x1: 2, y0: -2, y1: 2 });
    this.element = section('Multipliers', true, [this.frame],
      h('div', { class: 'multipliers' }, h('div', { class: 'plot round' }, this.frame.canvas), this.list));
  }

  show(orbit: number): void {
    this.orbit = orbit;
    const list = (title: string, column: 'stability' | 'fundamental_stability'): Node | null => {
      const values = this.atlas.multipliers(column, orbit);
      const whole = (text: string): HTMLElement => h('span', { class: 'whole' }, text);
      const items = values.map((v) => h('li', {}, whole(`${complexText(v)},`), ' ', whole(`|μ| = ${rounded(Math.hypot(v.re, v.im), 5)}`)));
      return values.length ? h('div', {}, h('h4', {}, title), h('ul', {}, items)) : null;
    };
    replaceChildren(this.list, list('Over the period', 'stability'), list('Of the fundamental map', 'fundamental_stability'),
      h('p', { class: 'soft' }, 'Outside the circle 2 − 1/r stands for r. Those of the flow and of conserved quantities are left out.'));
    const all = this.atlas.multipliers('stability', orbit);
    this.frame.describe(all.length ? `Multipliers: ${all.map(complexText).join('; ')}` : 'Multipliers were not computed.');
    this.frame.draw();
  }

  private draw(): void {
    if (this.orbit < 0) return;
    const { frame } = this;
    const { theme, context: ctx } = frame;
    const unit = frame.px(1) - frame.px(0);
    const circle = (radius: number): void => {
      ctx.beginPath();
      ctx.arc(frame.px(0), frame.py(0), radius * unit, 0, 2 * Math.PI);
      ctx.stroke();
    };
    ctx.strokeStyle = theme.grid;
    ctx.lineWidth = 1;
    for (const [a, b] of [[[-2, 0], [2, 0]], [[0, -2], [0, 2]]] as [Point, Point][]) {
      ctx.beginPath();
      ctx.moveTo(frame.px(a[0]), frame.py(a[1]));
      ctx.lineTo(frame.px(b[0]), frame.py(b[1]));
      ctx.stroke();
    }
    ctx.setLineDash([3, 3]);
    circle(2);
    ctx.setLineDash([]);
    ctx.strokeStyle = theme.ink;
    ctx.lineWidth = 1.5;
    circle(1);
    ctx.font = `${Math.max(11, theme.text * 0.72)}px system-ui, sans-serif`;
    ctx.fillStyle = theme.soft;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    // Off the axis and the circle, on which multipliers lie.
    ctx.fillText('∞', frame.px(1.86), frame.py(0) - 10);
    ctx.fillText('1', frame.px(1) - 11, frame.py(0) + 10);
    ctx.fillText('−1', frame.px(-1) + 14, frame.py(0) + 10);
    const draw = (column: 'stability' | 'fundamental_stability', filled: boolean): void => {
      for (const value of this.atlas.multipliers(column, this.orbit)) {
        const [x, y] = inCompressedPlane(value);
        ctx.beginPath();
        ctx.arc(frame.px(x), frame.py(y), filled ? 5 : 7, 0, 2 * Math.PI);
        ctx.fillStyle = ctx.strokeStyle = isOut(value) ? theme.unstable : theme.stable;
        ctx.lineWidth = 2;
        if (filled) ctx.fill();
        else ctx.stroke();
      }
    };
    draw('fundamental_stability', false);
    draw('stability', true);
  }
}
