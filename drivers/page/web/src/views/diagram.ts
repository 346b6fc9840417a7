import type { Atlas } from '../data/atlas';
import { addLevels, curvesOf, type Curve } from '../data/curve';
import { drawMark, kindOf } from '../data/kinds';
import { rounded, type Quantity } from '../data/quantities';
import { h, select } from '../dom';
import { Frame, type Box, type Tool } from '../plot/frame';
import { familyColour } from '../plot/theme';
import type { Store } from '../state';

/** Vertices nearer than this to the one before may be left out, in pixels. */
const nearest = 0.75;
/** Pieces longer than this are drawn as curves. */
const bendFrom = 4;
/** Curves are cut until their control points are within this of the canvas, which counts in float32. */
const canvasReach = 3000;
/** While it moves, dashes are left out where more vertices than this are in view. */
const dashedWhileMoving = 6000;
/** Orbits are ticks across the curve, unlike any crossing's mark, where the picked family's are at least this far apart on average. */
const ticksFrom = 9;
/** Half their length. */
const tick = 4;
const pickReach = 28;
const markReach = 11;

/** Period, and what there is of energy and parameter. */
function placeText(atlas: Atlas, period: number, energy: number, parameter: number): string {
  const parts = [`T ${rounded(period)}`];
  if (Number.isFinite(energy)) parts.push(`E ${rounded(energy)}`);
  if (Number.isFinite(parameter)) parts.push(`${atlas.index.moving || 'parameter'} ${rounded(parameter)}`);
  return parts.join(', ');
}

export class Diagram {
  readonly element: HTMLElement;
  readonly frame: Frame;
  private curves: Curve[] = [];
  private axes = '';
  private readonly tip = h('div', { class: 'tip', role: 'presentation', hidden: true });
  private readonly xSelect: HTMLLabelElement;
  private readonly ySelect: HTMLLabelElement;
  private readonly count = h('span', { class: 'brushed' });
  /** Where crossings were drawn. */
  private marks: { row: number; px: number; py: number }[] = [];

  constructor(private readonly store: Store, private readonly number: 0 | 1, tools: { tool: Tool }) {
    const { state } = store;
    const options = store.quantities.map((q) => ({ id: q.id, label: q.label }));
    const which = number ? 'second diagram' : 'diagram';
    const axis = (name: 'x' | 'y'): HTMLLabelElement =>
      select(`${name === 'x' ? 'Horizontal' : 'Vertical'} axis of the ${which}`, options, state.diagrams[number][name], (id) => {
        state.diagrams[number][name] = id;
        state.diagrams[number].view = null;
        store.set({}, 'diagrams');
      }, name === 'x' ? '→' : '↑');
    this.ySelect = axis('y');
    this.xSelect = axis('x');
    this.frame = new Frame({ label: which });
    this.frame.canvas.id = `diagram${number + 1}`;
    const clear = h('button', { type: 'button', class: 'clear', click: () => this.brush(null) }, 'Clear');
    this.count.hidden = true;
    clear.hidden = true;
    this.clear = clear;
    this.element = h('section', { class: 'diagram', 'aria-label': which },
      h('div', { class: 'bar' }, this.ySelect, this.xSelect,
        h('div', { class: 'zooms' },
          h('button', { type: 'button', title: 'Show all (0)', 'aria-label': `Show all of the ${which}`, class: 'icon', click: () => this.frame.reset() }, '⤢'),
          h('button', { type: 'button', title: 'Closer (+)', 'aria-label': `Zoom into the ${which}`, class: 'icon', click: () => this.frame.zoom(0.6) }, '+'),
          h('button', { type: 'button', title: 'Further (−)', 'aria-label': `Zoom out of the ${which}`, class: 'icon', click: () => this.frame.zoom(1 / 0.6) }, '−'),
          h('button', { type: 'button', title: 'Zoom to the picked family', 'aria-label': `Show the picked family in the ${which}`, class: 'icon', click: () => this.showFamily() }, '◎')),
        this.count, clear),
      h('div', { class: 'plot' }, this.frame.canvas, this.tip));
    const frame = this.frame;
    frame.onDraw = () => this.draw();
    frame.onPick = (px, py) => this.pick(px, py);
    frame.onHover = (px, py) => this.hover(px, py);
    frame.onLeave = () => (this.tip.hidden = true);
    frame.onBrush = (box) => this.brush(box);
    frame.onView = () => {
      if (this.axes === '') return;
      this.tip.hidden = true;
      state.diagrams[number].view = frame.isWhole() ? null : frame.view;
      store.set({});
    };
    frame.onKey = (event) => {
      if (event.key === 'Escape') this.brush(null);
      else return false;
      return true;
    };
    Object.defineProperty(frame, 'tool', { get: () => tools.tool });
    this.update();
    store.on((parts) => {
      if (parts.has('diagrams')) this.update();
      else if (parts.size) this.frame.draw();
      if (parts.has('orbit')) this.describe();
      if (parts.has('brush')) this.showBrush();
    });
  }
  private readonly clear: HTMLButtonElement;

  private get quantities(): [Quantity, Quantity] {
    const { x, y } = this.store.state.diagrams[this.number];
    return [this.store.quantity(x), this.store.quantity(y)];
  }

  update(): void {
    const own = this.store.state.diagrams[this.number];
    const [qx, qy] = this.quantities;
    this.xSelect.querySelector('select')!.value = qx.id;
    this.ySelect.querySelector('select')!.value = qy.id;
    const axes = `${qx.id} ${qy.id}`;
    if (axes !== this.axes) {
      this.curves = curvesOf(this.store.atlas, qx, qy);
      this.axes = '';
      this.frame.x = { low: 0, high: 1, label: qx.label, warp: qx.warp };
      this.frame.y = { low: 0, high: 1, label: qy.label, warp: qy.warp };
      const view = own.view;
      this.frame.setWhole(this.boundsOf(this.curves));
      own.view = view;
      const { whole } = this.frame;
      for (const curve of this.curves) addLevels(curve, whole.x1 - whole.x0, whole.y1 - whole.y0);
      this.axes = axes;
    }
    const view = own.view;
    if (view) this.frame.setView(view);
    else if (!this.frame.isWhole()) this.frame.reset();
    this.frame.draw();
    this.describe();
  }

  private boundsOf(curves: Curve[]): Box {
    const box = { x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity };
    for (const { box: own } of curves) {
      box.x0 = Math.min(box.x0, own.x0);
      box.x1 = Math.max(box.x1, own.x1);
      box.y0 = Math.min(box.y0, own.y0);
      box.y1 = Math.max(box.y1, own.y1);
    }
    return Number.isFinite(box.x0) ? box : { x0: 0, x1: 1, y0: 0, y1: 1 };
  }

  /** Whether a curve may come within so many pixels of a rectangle on the canvas. */
  private isNear({ box }: Curve, x0: number, x1: number, y0: number, y1: number, reach: number): boolean {
    const { frame } = this;
    return frame.px(box.x1) >= x0 - reach && frame.px(box.x0) <= x1 + reach && frame.py(box.y0) >= y0 - reach && frame.py(box.y1) <= y1 + reach;
  }

  private showFamily(): void {
    const orbit = this.store.state.orbit;
    if (orbit < 0) return;
    const box = this.boundsOf([this.curves[this.store.atlas.familyOf[orbit]!]!]);
    const [mx, my] = [(box.x1 - box.x0 || Math.abs(box.x0) * 0.01 || 1) * 0.08, (box.y1 - box.y0 || Math.abs(box.y0) * 0.01 || 1) * 0.08];
    this.frame.setView({ x0: box.x0 - mx, x1: box.x1 + mx, y0: box.y0 - my, y1: box.y1 + my });
  }

  private describe(): void {
    const { atlas, state } = this.store;
    const [qx, qy] = this.quantities;
    const stable = atlas.stable.reduce((sum, s) => sum + (s === 1 ? 1 : 0), 0);
    const picked = state.orbit < 0 ? '' : ` Picked: ${atlas.family(state.orbit).name}, step ${atlas.value('step', state.orbit)}, ${qx.short} ${rounded(qx.values[state.orbit]!)}, ${qy.short} ${rounded(qy.values[state.orbit]!)}.`;
    this.frame.describe(
      `Bifurcation diagram, ${qy.label} against ${qx.label}: ${atlas.families.length} families, ${atlas.orbits} orbits of which ${stable} are stable, ${atlas.crossings.length} crossings.${picked} Arrows pan, plus and minus zoom, 0 shows all.`,
    );
  }

  private draw(): void {
    const { frame, store } = this;
    const { atlas, state } = store;
    const { theme, context: ctx } = frame;
    const picked = state.orbit >= 0 ? atlas.familyOf[state.orbit]! : -1;
    type Style = { colour: string; stable: number; path: Path2D; strong: boolean };
    const styles = new Map<string, Style>();
    const style = (family: number, stable: number): Style => {
      const faint = state.isolate && family !== picked;
      const colour = faint ? theme.grid
        : state.colour === 'family' ? familyColour(theme, family)
        : stable === 1 ? theme.stable : stable === 0 ? theme.unstable : theme.unknown;
      const strong = family === picked;
      const key = `${colour}${stable}${strong}`;
      let found = styles.get(key);
      if (!found) styles.set(key, (found = { colour, stable, path: new Path2D(), strong }));
      return found;
    };
    const inner = frame.inner;
    const [w, e, north, south] = [inner.x0 - 4, inner.x1 + 4, inner.y0 - 4, inner.y1 + 4];
    const { whole } = frame;
    // Pixels that the whole diagram would have.
    const magnified = Math.max(((inner.x1 - inner.x0) * (whole.x1 - whole.x0)) / (frame.x.high - frame.x.low), ((inner.y1 - inner.y0) * (whole.y1 - whole.y0)) / (frame.y.high - frame.y.low));
    let drawn = 0;
    for (const curve of this.curves) {
      if (!this.isNear(curve, w, e, north, south, 0)) continue;
      const { x, y, stable } = curve;
      // The coarsest level of which nobody sees that it is one.
      const vertices = curve.levels.find((level) => level.apart * magnified < nearest)?.vertices;
      const count = vertices?.length ?? x.length;
      let joined: Style | null = null;
      const byStable: Style[] = [];
      for (let n = 0; n + 1 < count; ++n) {
        const i = vertices ? vertices[n]! : n;
        const j = vertices ? vertices[n + 1]! : n + 1;
        if (stable[i] === -2) {
          joined = null;
          continue;
        }
        const ax = frame.px(x[i]!);
        const ay = frame.py(y[i]!);
        const bx = frame.px(x[j]!);
        const by = frame.py(y[j]!);
        const own = (byStable[stable[i]! + 1] ??= style(curve.family, stable[i]!));
        if (j > i + 1 || Math.abs(bx - ax) + Math.abs(by - ay) < bendFrom) {
          if (Math.max(ax, bx) < w || Math.min(ax, bx) > e || Math.max(ay, by) < north || Math.min(ay, by) > south) {
            joined = null;
            continue;
          }
          if (joined !== own) own.path.moveTo(ax, ay);
          own.path.lineTo(bx, by);
          joined = own;
        } else {
          const control = [x[i]!, y[i]!, curve.behind[2 * i]!, curve.behind[2 * i + 1]!, curve.before[2 * j]!, curve.before[2 * j + 1]!, x[j]!, y[j]!];
          for (let c = 0; c < 8; c += 2) {
            control[c] = frame.px(control[c]!);
            control[c + 1] = frame.py(control[c + 1]!);
          }
          joined = this.bend(own.path, control, joined === own, 0) ? own : null;
        }
        ++drawn;
      }
    }
    const dashed = !(frame.isMoving && drawn > dashedWhileMoving);
    const ordered = [...styles.values()].sort((a, b) => Number(a.strong) - Number(b.strong) || a.stable - b.stable);
    ctx.lineJoin = 'round';
    for (const { colour, stable, path, strong } of ordered) {
      ctx.setLineDash(stable === 1 || !dashed ? [] : stable === 0 ? [5, 3] : [1.5, 3]);
      ctx.lineCap = stable === 1 ? 'round' : 'butt';
      const scale = Math.max(1, theme.text / 16);
      ctx.lineWidth = (stable === 1 ? 2.2 : 1.3) * (strong ? 1.7 : 1) * scale;
      ctx.strokeStyle = colour;
      ctx.stroke(path);
    }
    ctx.setLineDash([]);
    this.drawTicks(picked);
    this.drawBrushed();
    this.drawMarks();
    this.drawPicked();
  }

  /** A Bezier piece, in pixels. False where it is outside. */
  private bend(path: Path2D, c: number[], joined: boolean, depth: number): boolean {
    const { x0, x1, y0, y1 } = this.frame.inner;
    const left = Math.min(c[0]!, c[2]!, c[4]!, c[6]!);
    const right = Math.max(c[0]!, c[2]!, c[4]!, c[6]!);
    const top = Math.min(c[1]!, c[3]!, c[5]!, c[7]!);
    const bottom = Math.max(c[1]!, c[3]!, c[5]!, c[7]!);
    if (right < x0 - 4 || left > x1 + 4 || bottom < y0 - 4 || top > y1 + 4) return false;
    if ((left > -canvasReach && right < x1 + canvasReach && top > -canvasReach && bottom < y1 + canvasReach) || depth > 60) {
      if (!joined) path.moveTo(c[0]!, c[1]!);
      path.bezierCurveTo(c[2]!, c[3]!, c[4]!, c[5]!, c[6]!, c[7]!);
      return true;
    }
    const a: number[] = [...c];
    const b: number[] = [...c];
    for (const o of [0, 1]) {
      const [p0, p1, p2, p3] = [c[o]!, c[2 + o]!, c[4 + o]!, c[6 + o]!];
      const [q0, q1, q2] = [(p0 + p1) / 2, (p1 + p2) / 2, (p2 + p3) / 2];
      const [r0, r1] = [(q0 + q1) / 2, (q1 + q2) / 2];
      const middle = (r0 + r1) / 2;
      [a[2 + o], a[4 + o], a[6 + o]] = [q0, r0, middle];
      [b[o], b[2 + o], b[4 + o]] = [middle, r1, q2];
    }
    const first = this.bend(path, a, joined, depth + 1);
    const second = this.bend(path, b, first, depth + 1);
    return second;
  }

  private drawTicks(picked: number): void {
    const { frame, curves } = this;
    const curve = curves[picked];
    if (!curve) return;
    const { theme, context: ctx } = frame;
    const inside: [number, number][] = [];
    const { x0, x1, y0, y1 } = frame.inner;
    for (let i = 0; i < curve.x.length; ++i) {
      if (curve.vertices[i]! < 0) continue;
      const [px, py] = [frame.px(curve.x[i]!), frame.py(curve.y[i]!)];
      if (px >= x0 && px <= x1 && py >= y0 && py <= y1) inside.push([px, py]);
    }
    let long = 0;
    inside.forEach(([px, py], i) => i && (long += Math.hypot(px - inside[i - 1]![0], py - inside[i - 1]![1])));
    if (inside.length > 1 && long / inside.length < ticksFrom) return;
    ctx.strokeStyle = theme.ink;
    ctx.lineWidth = 1;
    ctx.beginPath();
    inside.forEach(([px, py], i) => {
      const [from, to] = [inside[Math.max(i - 1, 0)]!, inside[Math.min(i + 1, inside.length - 1)]!];
      const length = Math.hypot(to[0] - from[0], to[1] - from[1]) || 1;
      const [across, up] = [(tick * (from[1] - to[1])) / length, (tick * (to[0] - from[0])) / length];
      ctx.moveTo(px - across, py - up);
      ctx.lineTo(px + across, py + up);
    });
    ctx.stroke();
  }

  private drawBrushed(): void {
    const { frame } = this;
    const brushed = this.store.state.brushed;
    if (!brushed) return;
    const { theme, context: ctx } = frame;
    const [qx, qy] = this.quantities;
    ctx.fillStyle = theme.brush;
    ctx.globalAlpha = 0.8;
    for (const orbit of brushed) {
      const px = frame.px(qx.warp ? qx.warp.to(qx.values[orbit]!) : qx.values[orbit]!);
      const py = frame.py(qy.warp ? qy.warp.to(qy.values[orbit]!) : qy.values[orbit]!);
      if (px > -9 && px < frame.width + 9) ctx.fillRect(px - 2.5, py - 2.5, 5, 5);
    }
    ctx.globalAlpha = 1;
  }

  private drawMarks(): void {
    this.marks = [];
    const { frame, store } = this;
    const { atlas, state } = store;
    if (!state.showCrossings) return;
    const { theme, context: ctx } = frame;
    const picked = state.orbit >= 0 ? atlas.familyOf[state.orbit]! : -1;
    const taken = new Set<number>();
    const { x0, x1, y0, y1 } = frame.inner;
    const scale = Math.max(1, theme.text / 16);
    const draw = (curve: Curve, i: number): void => {
      const row = -1 - curve.vertices[i]!;
      const [px, py] = [frame.px(curve.x[i]!), frame.py(curve.y[i]!)];
      if (!(px >= x0 && px <= x1 && py >= y0 && py <= y1)) return;
      // One mark a place: the others show when one comes closer.
      const cell = Math.round(px / 6) * 65536 + Math.round(py / 6);
      if (taken.has(cell) && row !== state.crossing) return;
      taken.add(cell);
      this.marks.push({ row, px, py });
      const kind = kindOf(atlas.crossings[row]!.kind);
      const faint = state.isolate && curve.family !== picked;
      drawMark(ctx, kind, px, py, (curve.family === picked ? 5 : 3.6) * scale, faint ? theme.grid : theme.ink, theme.panel);
      if (row === state.crossing) {
        ctx.strokeStyle = theme.pick;
        ctx.lineWidth = 2.5;
        ctx.strokeRect(px - 9 * scale, py - 9 * scale, 18 * scale, 18 * scale);
      }
    };
    const order = [...this.curves].sort((a, b) => Number(b.family === picked) - Number(a.family === picked));
    for (const curve of order) for (const i of curve.crossings) draw(curve, i);
  }

  private drawPicked(): void {
    const { frame } = this;
    const { orbit, crossing } = this.store.state;
    if (orbit < 0 || crossing >= 0) return;
    const [qx, qy] = this.quantities;
    const px = frame.px(qx.warp ? qx.warp.to(qx.values[orbit]!) : qx.values[orbit]!);
    const py = frame.py(qy.warp ? qy.warp.to(qy.values[orbit]!) : qy.values[orbit]!);
    const { theme, context: ctx } = frame;
    const scale = Math.max(1, theme.text / 16);
    ctx.beginPath();
    ctx.arc(px, py, 7 * scale, 0, 2 * Math.PI);
    ctx.lineWidth = 5 * scale;
    ctx.strokeStyle = theme.panel;
    ctx.stroke();
    ctx.lineWidth = 3 * scale;
    ctx.strokeStyle = theme.pick;
    ctx.stroke();
    ctx.beginPath();
    ctx.arc(px, py, 2 * scale, 0, 2 * Math.PI);
    ctx.fillStyle = theme.pick;
    ctx.fill();
  }

  /** The crossing or orbit at a place; crossings first, then orbits, then the nearer end of a piece that passes there. */
  private at(px: number, py: number): { crossing: number } | { orbit: number } | null {
    let best: { crossing: number } | { orbit: number } | null = null;
    let least = markReach;
    for (const mark of this.marks) {
      const far = Math.hypot(mark.px - px, mark.py - py);
      if (far < least) [least, best] = [far, { crossing: mark.row }];
    }
    if (best) return best;
    least = pickReach;
    const { frame } = this;
    const state = this.store.state;
    const picked = state.isolate && state.orbit >= 0 ? this.store.atlas.familyOf[state.orbit]! : -1;
    for (const curve of this.curves) {
      if ((picked >= 0 && curve.family !== picked) || !this.isNear(curve, px, px, py, py, pickReach)) continue;
      for (let i = 0; i < curve.x.length; ++i) {
        if (curve.vertices[i]! < 0) continue;
        const far = Math.hypot(frame.px(curve.x[i]!) - px, frame.py(curve.y[i]!) - py);
        if (far < least) [least, best] = [far, { orbit: curve.vertices[i]! }];
      }
    }
    if (best) return best;
    least = 10;
    const { x0, x1, y0, y1 } = frame.inner;
    for (const curve of this.curves) {
      if (!this.isNear(curve, px, px, py, py, least)) continue;
      for (let i = 0; i + 1 < curve.x.length; ++i) {
        if (curve.stable[i] === -2) continue;
        const c = [curve.x[i]!, curve.behind[2 * i]!, curve.before[2 * i + 2]!, curve.x[i + 1]!].map((v) => frame.px(v));
        const d = [curve.y[i]!, curve.behind[2 * i + 1]!, curve.before[2 * i + 3]!, curve.y[i + 1]!].map((v) => frame.py(v));
        if (Math.max(...c) < x0 || Math.min(...c) > x1 || Math.max(...d) < y0 || Math.min(...d) > y1) continue;
        for (let j = 0; j <= 200; ++j) {
          const t = j / 200;
          const u = 1 - t;
          const at = (v: number[]): number => u * u * u * v[0]! + 3 * u * u * t * v[1]! + 3 * u * t * t * v[2]! + t * t * t * v[3]!;
          const far = Math.hypot(at(c) - px, at(d) - py);
          if (far >= least) continue;
          const ends = [curve.vertices[i]!, curve.vertices[i + 1]!];
          const orbit = (t < 0.5 ? ends[0]! : ends[1]!) >= 0 ? (t < 0.5 ? ends[0]! : ends[1]!) : Math.max(...ends);
          if (orbit >= 0) [least, best] = [far, { orbit }];
        }
      }
    }
    return best;
  }

  private pick(px: number, py: number): void {
    const found = this.at(px, py);
    if (!found) return;
    if ('crossing' in found) this.store.pickCrossing(found.crossing);
    else this.store.pick(found.orbit);
  }

  private hover(px: number, py: number): void {
    const found = this.at(px, py);
    if (!found) {
      this.tip.hidden = true;
      this.frame.canvas.style.cursor = '';
      return;
    }
    const { atlas } = this.store;
    this.frame.canvas.style.cursor = 'pointer';
    let text: string;
    if ('crossing' in found) {
      const c = atlas.crossings[found.crossing]!;
      text = `${kindOf(c.kind).text} on ${atlas.families[c.family]?.name ?? '?'}, m ${c.multiplicity}\n${placeText(atlas, c.period, c.energy, c.parameter)}`;
    } else {
      const o = found.orbit;
      const word = { 1: 'stable', 0: 'unstable', '-1': 'stability not known' }[String(atlas.stable[o]) as '1'];
      text = `${atlas.family(o).name}, step ${atlas.value('step', o)}, ${word}\n${placeText(atlas, atlas.value('period', o), atlas.value('energy', o), atlas.value('parameter', o))}`;
    }
    this.tip.textContent = text;
    this.tip.hidden = false;
    const left = Math.min(px + 14, this.frame.width - this.tip.offsetWidth - 4);
    this.tip.style.left = `${Math.max(0, left)}px`;
    this.tip.style.top = `${py > 70 ? py - this.tip.offsetHeight - 10 : py + 14}px`;
  }

  private brush(box: Box | null): void {
    if (!box) {
      this.store.set({ brushed: null }, 'brush');
      return;
    }
    const inside = new Set<number>();
    for (const { x, y, vertices } of this.curves)
      for (let i = 0; i < x.length; ++i)
        if (vertices[i]! >= 0 && x[i]! >= box.x0 && x[i]! <= box.x1 && y[i]! >= box.y0 && y[i]! <= box.y1) inside.add(vertices[i]!);
    this.store.set({ brushed: inside }, 'brush');
  }

  private showBrush(): void {
    const brushed = this.store.state.brushed;
    this.count.hidden = this.clear.hidden = !brushed;
    if (brushed) this.count.textContent = `${brushed.size} orbit${brushed.size === 1 ? '' : 's'} selected`;
    this.frame.draw();
  }
}
