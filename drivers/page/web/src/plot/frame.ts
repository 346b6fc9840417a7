import type { Warp } from '../data/quantities';
import { axisTicks, powerOfTen } from './ticks';
import { currentTheme, type Theme } from './theme';

export interface Axis {
  low: number;
  high: number;
  label: string;
  warp?: Warp;
}

export interface FrameOptions {
  /** What a screen reader says of it. */
  label: string;
  /** One unit is as long on both axes. */
  square?: boolean;
  /** No axes: a picture. */
  bare?: boolean;
  /** It cannot be zoomed. */
  fixed?: boolean;
  /** It lies in a panel that scrolls: the wheel zooms once it was clicked, or with Ctrl. */
  inPanel?: boolean;
}

export interface Box {
  x0: number;
  x1: number;
  y0: number;
  y1: number;
}

/** What one gets by dragging. */
export type Tool = 'pan' | 'zoom' | 'brush';

/** A canvas with two axes that are zoomed and panned by mouse, touch and keyboard. Coordinates are float64 throughout. */
export class Frame {
  readonly canvas = document.createElement('canvas');
  readonly context: CanvasRenderingContext2D;
  x: Axis = { low: 0, high: 1, label: '' };
  y: Axis = { low: 0, high: 1, label: '' };
  tool: Tool = 'pan';
  theme: Theme = currentTheme();
  width = 0;
  height = 0;
  isMoving = false;
  onDraw: (frame: Frame) => void = () => {};
  /** What moves, drawn over a copy of the rest by tick(). */
  onOverlay: ((frame: Frame) => void) | null = null;
  /** Where it is set, dragging and arrows turn what is shown, by such angles, and do not pan. */
  onTurn: ((turn: number, tilt: number) => void) | null = null;
  onPick: (px: number, py: number) => void = () => {};
  onHover: (px: number, py: number) => void = () => {};
  onLeave: () => void = () => {};
  onBrush: (box: Box | null) => void = () => {};
  onView: () => void = () => {};
  onKey: (event: KeyboardEvent) => boolean = () => false;
  whole: Box = { x0: 0, x1: 1, y0: 0, y1: 1 };
  private waiting = false;
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private drag: { x: number; y: number; tool: Tool; moved: boolean } | null = null;
  private rubber: [number, number, number, number] | null = null;
  private settle = 0;
  private still: HTMLCanvasElement | null = null;

  constructor(private readonly options: FrameOptions) {
    this.context = this.canvas.getContext('2d')!;
    this.canvas.className = 'frame';
    this.canvas.tabIndex = options.fixed ? -1 : 0;
    this.canvas.setAttribute('role', 'img');
    this.describe(options.label);
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    if (!options.fixed) this.listen();
  }

  describe(text: string): void {
    this.canvas.setAttribute('aria-label', text);
  }

  /** What is shown by default, with a margin around it. */
  setWhole(box: Box, keepView = false): void {
    const pad = (a: number, b: number): [number, number] => {
      const range = b - a;
      const least = Math.max(Math.abs(a), Math.abs(b), 1e-300) * 1e-9;
      const by = range > least ? 0.04 * range : Math.max(least, Math.abs(a) * 0.05, 1e-12);
      return [a - by, b + by];
    };
    [this.whole.x0, this.whole.x1] = pad(box.x0, box.x1);
    [this.whole.y0, this.whole.y1] = pad(box.y0, box.y1);
    if (!keepView) this.reset();
  }

  reset(): void {
    this.setView(this.whole);
  }

  get view(): Box {
    return { x0: this.x.low, x1: this.x.high, y0: this.y.low, y1: this.y.high };
  }

  isWhole(): boolean {
    const w = this.whole;
    return this.x.low === w.x0 && this.x.high === w.x1 && this.y.low === w.y0 && this.y.high === w.y1;
  }

  /** A view narrower than what doubles can tell is widened to that. */
  setView(box: Box): void {
    const clamp = (axis: Axis, a: number, b: number): void => {
      const middle = a / 2 + b / 2;
      const least = 64 * Number.EPSILON * Math.max(Math.abs(middle), Number.MIN_VALUE);
      const half = Math.max((b - a) / 2, least);
      if (!Number.isFinite(half) || half <= 0) return;
      [axis.low, axis.high] = b - a >= 2 * least ? [a, b] : [middle - half, middle + half];
    };
    clamp(this.x, box.x0, box.x1);
    clamp(this.y, box.y0, box.y1);
    this.onView();
    this.draw();
  }

  /** Where the data are drawn, in pixels; y0 is the upper edge. */
  inner: Box = { x0: 0, x1: 1, y0: 0, y1: 1 };
  px(x: number): number {
    return this.inner.x0 + ((x - this.x.low) / (this.x.high - this.x.low)) * (this.inner.x1 - this.inner.x0);
  }
  py(y: number): number {
    return this.inner.y1 - ((y - this.y.low) / (this.y.high - this.y.low)) * (this.inner.y1 - this.inner.y0);
  }
  fromX(px: number): number {
    const { x0, x1 } = this.inner;
    return this.x.low + ((px - x0) / (x1 - x0)) * (this.x.high - this.x.low);
  }
  fromY(py: number): number {
    const { y0, y1 } = this.inner;
    return this.y.low + ((y1 - py) / (y1 - y0)) * (this.y.high - this.y.low);
  }

  draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow();
    });
  }

  private resize(): void {
    const box = this.canvas.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    const [w, h] = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
    if (w === 0 || h === 0 || (w === this.canvas.width && h === this.canvas.height)) return;
    this.canvas.width = w;
    this.canvas.height = h;
    this.width = box.width;
    this.height = box.height;
    this.drawNow();
  }

  drawNow(): void {
    if (this.width === 0) return;
    const ratio = this.canvas.width / this.width;
    const ctx = this.context;
    this.theme = currentTheme();
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.clearRect(0, 0, this.width, this.height);
    if (this.options.bare) this.setInner(6, 6, 6, 6);
    if (this.options.square) this.squareView();
    if (!this.options.bare) this.drawAxes();
    const { x0, x1, y0, y1 } = this.inner;
    ctx.save();
    ctx.beginPath();
    ctx.rect(x0, y0, x1 - x0, y1 - y0);
    ctx.clip();
    this.onDraw(this);
    ctx.restore();
    if (this.onOverlay) {
      this.still ??= document.createElement('canvas');
      this.still.width = this.canvas.width;
      this.still.height = this.canvas.height;
      this.still.getContext('2d')!.drawImage(this.canvas, 0, 0);
      this.overlay();
    }
    if (this.rubber) {
      const [ax, ay, bx, by] = this.rubber;
      ctx.fillStyle = this.theme.brush;
      ctx.globalAlpha = 0.15;
      ctx.fillRect(ax, ay, bx - ax, by - ay);
      ctx.globalAlpha = 1;
      ctx.strokeStyle = this.theme.brush;
      ctx.strokeRect(ax, ay, bx - ax, by - ay);
    }
  }

  tick(): void {
    if (!this.still || this.width === 0 || !this.canvas.offsetParent) return;
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.context.drawImage(this.still, 0, 0);
    const ratio = this.canvas.width / this.width;
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.overlay();
  }

  private overlay(): void {
    const { x0, x1, y0, y1 } = this.inner;
    const ctx = this.context;
    ctx.save();
    ctx.beginPath();
    ctx.rect(x0, y0, x1 - x0, y1 - y0);
    ctx.clip();
    this.onOverlay?.(this);
    ctx.restore();
  }

  /** The narrower axis is widened about its middle. */
  private squareView(): void {
    if (!this.options.bare) this.measureMargins();
    const { x0, x1, y0, y1 } = this.inner;
    const unitX = (this.x.high - this.x.low) / Math.max(1, x1 - x0);
    const unitY = (this.y.high - this.y.low) / Math.max(1, y1 - y0);
    const widen = (axis: Axis, by: number): void => {
      const middle = (axis.low + axis.high) / 2;
      const half = ((axis.high - axis.low) / 2) * by;
      axis.low = middle - half;
      axis.high = middle + half;
    };
    if (unitX < unitY) widen(this.x, unitY / unitX);
    else if (unitY < unitX) widen(this.y, unitX / unitY);
  }

  private font(scale = 0.78): string {
    return `${Math.max(11, Math.round(this.theme.text * scale))}px system-ui, sans-serif`;
  }

  private setInner(left: number, right: number, top: number, bottom: number): void {
    this.inner = { x0: Math.ceil(left), x1: this.width - Math.ceil(right), y0: Math.ceil(top), y1: this.height - Math.ceil(bottom) };
  }

  private measureMargins(): ReturnType<typeof axisTicks> {
    const text = Math.max(11, this.theme.text * 0.78);
    this.context.font = this.font();
    const ticks = axisTicks(this.y.low, this.y.high, Math.max(2, this.height / (text * 4)), this.y.warp);
    const widest = Math.max(...ticks.labels.map((label) => this.context.measureText(label).width), 0);
    this.setInner(widest + text * 2.1, text, text * 0.9, text * 3);
    return ticks;
  }

  private drawAxes(): void {
    const ctx = this.context;
    const theme = this.theme;
    const text = Math.max(11, theme.text * 0.78);
    const yTicks = this.measureMargins();
    const { x0, x1, y0, y1 } = this.inner;
    const xTicks = axisTicks(this.x.low, this.x.high, Math.max(2, (x1 - x0) / (text * 6)), this.x.warp);
    ctx.font = this.font();
    ctx.strokeStyle = theme.grid;
    ctx.lineWidth = 1;
    ctx.fillStyle = theme.soft;
    ctx.textBaseline = 'middle';
    ctx.textAlign = 'right';
    ctx.beginPath();
    let above = Infinity;
    yTicks.at.forEach((v, i) => {
      const py = Math.round(this.py(v)) + 0.5;
      ctx.moveTo(x0, py);
      ctx.lineTo(x1, py);
      if (py > above - text * 1.1) return;
      above = py;
      ctx.fillText(yTicks.labels[i]!, x0 - text * 0.4, py);
    });
    ctx.textBaseline = 'top';
    ctx.textAlign = 'center';
    let end = -Infinity;
    xTicks.at.forEach((v, i) => {
      const px = Math.round(this.px(v)) + 0.5;
      ctx.moveTo(px, y0);
      ctx.lineTo(px, y1);
      const half = ctx.measureText(xTicks.labels[i]!).width / 2;
      const at = Math.min(px, this.width - half - 1);
      if (at - half < end + text * 0.5) return;
      end = at + half;
      ctx.fillText(xTicks.labels[i]!, at, y1 + text * 0.35);
    });
    ctx.stroke();
    ctx.strokeStyle = theme.soft;
    ctx.strokeRect(Math.round(x0) + 0.5, Math.round(y0) + 0.5, Math.round(x1 - x0), Math.round(y1 - y0));
    const title = (axis: Axis, ticks: typeof xTicks): string =>
      `${axis.label}${ticks.base.startsWith('−') ? ` + ${ticks.base.slice(1)}` : ticks.base ? ` − ${ticks.base}` : ''}${ticks.power ? ` (× ${powerOfTen(ticks.power)})` : ''}`;
    const write = (label: string, room: number): void => {
      // Shrunk where there is little room: the digits of a base are not cut.
      ctx.font = this.font(0.82);
      const width = ctx.measureText(label).width;
      if (width > room) ctx.font = this.font(Math.max(0.6, (0.82 * room) / width));
    };
    ctx.fillStyle = theme.ink;
    const xTitle = title(this.x, xTicks);
    write(xTitle, this.width - 8);
    const half = ctx.measureText(xTitle).width / 2;
    ctx.fillText(xTitle, Math.max(half + 2, Math.min((x0 + x1) / 2, this.width - half - 2)), y1 + text * 1.7);
    ctx.save();
    ctx.translate(text * 0.25, (y0 + y1) / 2);
    ctx.rotate(-Math.PI / 2);
    const yTitle = title(this.y, yTicks);
    write(yTitle, this.height);
    const up = ctx.measureText(yTitle).width / 2;
    const middle = (y0 + y1) / 2;
    ctx.fillText(yTitle, Math.max(-(this.height - middle - up), Math.min(0, middle - up)), 0);
    ctx.restore();
  }

  zoom(factor: number, px = (this.inner.x0 + this.inner.x1) / 2, py = (this.inner.y0 + this.inner.y1) / 2): void {
    const about = (low: number, high: number, part: number): [number, number] => {
      const range = (high - low) * factor;
      const fixed = low + part * (high - low);
      return [fixed - part * range, fixed + (1 - part) * range];
    };
    const { x0, x1, y0, y1 } = this.inner;
    const [a, b] = about(this.x.low, this.x.high, (px - x0) / (x1 - x0));
    const [c, d] = about(this.y.low, this.y.high, (y1 - py) / (y1 - y0));
    this.setView({ x0: a, x1: b, y0: c, y1: d });
  }

  pan(dx: number, dy: number): void {
    const { x0, x1, y0, y1 } = this.inner;
    const by = (-dx / (x1 - x0)) * (this.x.high - this.x.low);
    const up = (dy / (y1 - y0)) * (this.y.high - this.y.low);
    this.setView({ x0: this.x.low + by, x1: this.x.high + by, y0: this.y.low + up, y1: this.y.high + up });
  }

  private moving(): void {
    this.isMoving = true;
    window.clearTimeout(this.settle);
    this.settle = window.setTimeout(() => {
      this.isMoving = false;
      this.draw();
    }, 150);
  }

  private place(event: MouseEvent): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private listen(): void {
    const canvas = this.canvas;
    canvas.addEventListener('wheel', (event) => {
      if (this.options.inPanel && !event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      const at = this.place(event);
      const lines = event.deltaMode === 1 ? 30 : 1;
      this.moving();
      this.zoom(Math.exp(Math.max(-200, Math.min(200, event.deltaY * lines)) * 0.0016), at.x, at.y);
    }, { passive: false });
    canvas.addEventListener('pointerdown', (event) => {
      if (event.button > 0) return;
      canvas.setPointerCapture(event.pointerId);
      const at = this.place(event);
      this.pointers.set(event.pointerId, at);
      this.drag = { ...at, tool: event.shiftKey ? 'brush' : event.ctrlKey || event.metaKey ? 'zoom' : this.tool, moved: false };
    });
    canvas.addEventListener('pointermove', (event) => {
      const at = this.place(event);
      const before = this.pointers.get(event.pointerId);
      if (!before) {
        this.onHover(at.x, at.y);
        return;
      }
      if (this.pointers.size === 2) {
        const [a, b] = [...this.pointers.values()];
        const apart = Math.hypot(a!.x - b!.x, a!.y - b!.y);
        this.pointers.set(event.pointerId, at);
        const [c, d] = [...this.pointers.values()];
        const now = Math.hypot(c!.x - d!.x, c!.y - d!.y);
        this.moving();
        this.pan((c!.x + d!.x - a!.x - b!.x) / 2, (c!.y + d!.y - a!.y - b!.y) / 2);
        if (now > 0 && apart > 0) this.zoom(apart / now, (c!.x + d!.x) / 2, (c!.y + d!.y) / 2);
        if (this.drag) this.drag.moved = true;
        return;
      }
      this.pointers.set(event.pointerId, at);
      if (!this.drag) return;
      const far = Math.hypot(at.x - this.drag.x, at.y - this.drag.y) > (event.pointerType === 'touch' ? 8 : 4);
      if (!this.drag.moved && !far) return;
      const from = this.drag.moved ? before : this.drag;
      this.drag.moved = true;
      if (this.drag.tool === 'pan') {
        this.moving();
        if (this.onTurn) this.onTurn((at.x - from.x) * 0.01, (at.y - from.y) * 0.01);
        else this.pan(at.x - from.x, at.y - from.y);
      } else {
        this.rubber = [this.drag.x, this.drag.y, at.x, at.y];
        this.draw();
      }
    });
    const up = (event: PointerEvent): void => {
      const at = this.place(event);
      this.pointers.delete(event.pointerId);
      if (this.pointers.size > 0) return;
      const drag = this.drag;
      this.drag = null;
      this.rubber = null;
      if (!drag || event.type === 'pointercancel') return;
      if (!drag.moved) {
        this.onPick(at.x, at.y);
        return;
      }
      if (drag.tool === 'pan') return;
      const box = {
        x0: this.fromX(Math.min(drag.x, at.x)), x1: this.fromX(Math.max(drag.x, at.x)),
        y0: this.fromY(Math.max(drag.y, at.y)), y1: this.fromY(Math.min(drag.y, at.y)),
      };
      if (drag.tool === 'brush') this.onBrush(box);
      else this.setView(box);
      this.draw();
    };
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('pointerleave', () => this.onLeave());
    canvas.addEventListener('dblclick', () => this.reset());
    canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const step = event.shiftKey ? 0.5 : 0.1;
      const { x0, x1, y0, y1 } = this.inner;
      const keys: Record<string, () => void> = {
        ArrowLeft: () => (this.onTurn ? this.onTurn(-step, 0) : this.pan((x1 - x0) * step, 0)),
        ArrowRight: () => (this.onTurn ? this.onTurn(step, 0) : this.pan(-(x1 - x0) * step, 0)),
        ArrowUp: () => (this.onTurn ? this.onTurn(0, -step) : this.pan(0, (y1 - y0) * step)),
        ArrowDown: () => (this.onTurn ? this.onTurn(0, step) : this.pan(0, -(y1 - y0) * step)),
        '+': () => this.zoom(0.7),
        '=': () => this.zoom(0.7),
        '-': () => this.zoom(1 / 0.7),
        '0': () => this.reset(),
        Home: () => this.reset(),
      };
      const act = keys[event.key];
      if (!act && !this.onKey(event)) return;
      event.preventDefault();
      event.stopPropagation();
      act?.();
    });
  }
}
