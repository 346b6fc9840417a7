import { rounded } from '../data/quantities';
import { h } from '../dom';
import { Frame } from '../plot/frame';
import { drawPath, withoutRounding } from '../plot/path';
import { currentTheme, familyColour } from '../plot/theme';
import type { Clock } from './clock';
import { section, type OrbitPart, type Shown } from './orbit_part';

/** Below this a modulus is rounding: a harmonic that a symmetry forbids. log10. */
const rounding = -15;
/** Nothing is drawn further down. log10. */
const lowest = -19;

/** Each coordinate over the period, and the spectrum of the loop. */
export class Courses implements OrbitPart {
  readonly element: HTMLElement;
  readonly frames: Frame[];
  private readonly time = new Frame({ label: 'Time courses', inPanel: true });
  private readonly spectrum = new Frame({ label: 'Fourier spectrum', inPanel: true });
  private readonly hidden = new Set<number>();
  private readonly swatches: HTMLElement[] = [];
  private shown: Shown | null = null;

  constructor(private readonly names: string[], private readonly clock: Clock) {
    this.frames = [this.time, this.spectrum];
    this.time.onDraw = () => this.drawTime();
    this.time.onOverlay = () => this.drawCursor();
    this.time.onPick = (px) => this.shown && clock.set(this.time.fromX(px) / this.shown.period);
    this.spectrum.onDraw = () => this.drawSpectrum();
    clock.on(() => this.time.tick());
    const chips = h('div', { class: 'chips' });
    names.forEach((name, i) => {
      const box = h('input', { type: 'checkbox', checked: true });
      const swatch = h('span', { class: 'line', 'aria-hidden': 'true' });
      this.swatches.push(swatch);
      box.addEventListener('change', () => {
        if (box.checked) this.hidden.delete(i);
        else this.hidden.add(i);
        this.fitTime();
        this.spectrum.draw();
      });
      chips.append(h('label', {}, box, swatch, name));
    });
    this.element = section('Time courses and spectrum', true, this.frames, chips,
      h('div', { class: 'plot small' }, this.time.canvas), h('div', { class: 'plot small' }, this.spectrum.canvas));
  }

  show(shown: Shown): void {
    this.shown = shown;
    this.fitTime();
    this.fitSpectrum(shown);
  }

  colour(): void {
    const theme = currentTheme();
    this.swatches.forEach((swatch, i) => (swatch.style.background = familyColour(theme, i)));
  }

  private fitTime(): void {
    if (!this.shown) return;
    const { loop, period } = this.shown;
    const frame = this.time;
    let [low, high] = [Infinity, -Infinity];
    loop.states.forEach((x, i) => {
      if (this.hidden.has(i)) return;
      for (const v of x) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
    });
    if (low > high) [low, high] = [-1, 1];
    frame.x.label = 't';
    frame.y.label = this.names.filter((_, i) => !this.hidden.has(i)).join(', ');
    frame.setWhole(withoutRounding({ x0: 0, x1: period, y0: low, y1: high }, loop.states));
    frame.describe(`Time courses of ${frame.y.label} over the period ${rounded(period)}.`);
  }

  private drawTime(): void {
    if (!this.shown) return;
    const { loop, period } = this.shown;
    const frame = this.time;
    loop.states.forEach((x, i) => {
      if (!this.hidden.has(i)) drawPath(frame, x.length, (j) => [loop.times[j]! * period, x[j]!], frame.theme.families[i % 8]!);
    });
  }

  private drawCursor(): void {
    if (!this.shown) return;
    const frame = this.time;
    const ctx = frame.context;
    const px = frame.px(this.clock.time * this.shown.period);
    ctx.beginPath();
    ctx.moveTo(px, frame.inner.y0);
    ctx.lineTo(px, frame.inner.y1);
    ctx.strokeStyle = frame.theme.pick;
    ctx.lineWidth = 1.5;
    ctx.stroke();
  }

  private fitSpectrum({ loop }: Shown): void {
    const frame = this.spectrum;
    let [low, high] = [Infinity, -Infinity];
    for (const bins of loop.spectrum)
      for (const v of bins)
        if (Number.isFinite(v)) {
          low = Math.min(low, v);
          high = Math.max(high, v);
        }
    if (low > high) [low, high] = [-1, 0];
    frame.x.label = loop.harmonicsABin > 1 ? `harmonic k (largest of ${loop.harmonicsABin})` : 'harmonic k';
    frame.y.label = 'log₁₀ modulus';
    frame.setWhole({ x0: 0, x1: loop.spectrum[0]!.length * loop.harmonicsABin, y0: Math.max(low, lowest + 1), y1: high });
    frame.describe(`Fourier spectrum of the loop: moduli from 10 to the ${rounded(high, 3)} down to 10 to the ${rounded(low, 3)}.`);
  }

  private drawSpectrum(): void {
    if (!this.shown) return;
    const { loop } = this.shown;
    const frame = this.spectrum;
    const ctx = frame.context;
    loop.spectrum.forEach((bins, i) => {
      if (this.hidden.has(i)) return;
      ctx.fillStyle = ctx.strokeStyle = frame.theme.families[i % 8]!;
      ctx.beginPath();
      let isOpen = false;
      bins.forEach((v, k) => {
        const px = frame.px((k + 1) * loop.harmonicsABin);
        const py = frame.py(Math.max(v, lowest));
        if (Number.isFinite(v)) ctx.fillRect(px - 2, py - 2, 4, 4);
        if (v < rounding) return;
        if (isOpen) ctx.lineTo(px, py);
        else ctx.moveTo(px, py);
        isOpen = true;
      });
      ctx.lineWidth = 1;
      ctx.globalAlpha = 0.45;
      ctx.stroke();
      ctx.globalAlpha = 1;
    });
  }
}
