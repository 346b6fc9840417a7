import { rounded } from '../data/quantities';
import { h } from '../dom';
import { hasPicture, pictureOf } from '../pictures';
import type { Pen, Picture, Point } from '../pictures/picture';
import { Frame } from '../plot/frame';
import { boxOf, drawDot, drawPath } from '../plot/path';
import type { Store } from '../state';
import type { Clock } from './clock';
import { section, type OrbitPart, type Shown } from './orbit_part';

/** The orbit as it moves: in the system's own picture, or in the plane of the first two coordinates where there is none. */
export class Motion implements OrbitPart {
  readonly element: HTMLElement;
  readonly frame: Frame;
  readonly frames: Frame[];
  private picture: Picture | null;
  private shown: Shown | null = null;
  private traces: Point[][] = [];
  private readonly stand = h('p', { class: 'soft', hidden: true });
  private readonly play = h('button', { type: 'button', class: 'icon' });
  private readonly scrub = h('input', { type: 'range', min: '0', max: '1', step: '0.001', value: '0', 'aria-label': 'Time in the period' });

  constructor(private readonly store: Store, private readonly clock: Clock) {
    this.picture = this.makePicture(-1);
    const bare = this.picture !== null && !this.picture.axes;
    const frame = new Frame({ label: 'The orbit, animated', square: this.picture !== null, bare, inPanel: true });
    this.frame = frame;
    this.frames = [frame];
    frame.onDraw = () => this.draw();
    frame.onOverlay = () => this.drawFigure();
    if (this.picture?.turn)
      frame.onTurn = (turn, tilt) => {
        this.picture!.turn!.rotate(turn, tilt);
        if (this.shown) this.trace(this.shown);
        frame.draw();
      };
    clock.on(() => {
      frame.tick();
      if (document.activeElement !== this.scrub || clock.isRunning) this.scrub.value = String(clock.time);
    });
    this.scrub.addEventListener('input', () => {
      this.run(false);
      clock.set(Number(this.scrub.value));
    });
    this.play.addEventListener('click', () => this.run(!clock.isRunning));
    this.run(clock.isRunning);
    const speed = h('select', { 'aria-label': 'Seconds a period takes' });
    for (const [seconds, label] of [[24, '¼×'], [12, '½×'], [6, '1×'], [3, '2×'], [1.5, '4×']] as const)
      speed.append(h('option', { value: String(seconds) }, label));
    speed.value = '6';
    speed.addEventListener('change', () => (clock.seconds = Number(speed.value)));
    const why = this.picture ? '' : h('p', { class: 'soft why' }, this.whyNone());
    this.element = section(this.title, true, this.frames, why, this.stand,
      h('div', { class: 'plot picture' }, frame.canvas),
      h('div', { class: 'player' }, this.play, this.scrub, speed));
  }

  run(on: boolean): void {
    this.clock.isRunning = on;
    this.play.textContent = on ? '❚❚' : '▶';
    this.play.setAttribute('aria-label', on ? 'Stop' : 'Play');
    this.play.title = `${on ? 'Stop' : 'Play'} (space)`;
  }

  show(shown: Shown): void {
    this.shown = shown;
    const turn = this.picture?.turn;
    this.picture = this.makePicture(shown.drawn);
    if (this.picture && turn) this.picture.turn?.from(turn);
    this.fit(shown);
  }

  /** Which orbit is drawn in place of the picked one, where that has no loop on the page (`drawn` -1: none has). */
  tellStandIn(orbit: number, drawn: number): void {
    const { atlas } = this.store;
    this.stand.hidden = drawn === orbit;
    this.stand.textContent = drawn < 0 ? 'This page has no loop of this family.' : `Drawn is step ${atlas.value('step', drawn)} of the family: of ${atlas.orbits} orbits the page has ${atlas.index.loops} loops.`;
  }

  private get names(): string[] {
    return this.store.atlas.index.stateNames;
  }
  private get title(): string {
    const [x, y] = this.names;
    return this.picture?.title ?? (y === undefined ? `Moving: ${x}` : `Moving in the plane of ${x} and ${y}`);
  }

  private whyNone(): string {
    const { system, meaning } = this.store.atlas.index;
    const what = meaning ? `${system} (${meaning})` : system;
    return hasPicture(system)
      ? `The picture of ${what} reads other coordinates than those of this archive: ${this.names.join(', ')}.`
      : `This page has no picture of ${what}.`;
  }

  private makePicture(orbit: number): Picture | null {
    const { atlas } = this.store;
    const parameters = orbit < 0 ? atlas.parameters() : atlas.parametersOf(orbit);
    return pictureOf(atlas.index.system, parameters, atlas.index.stateNames);
  }

  private pen(): Pen {
    const { frame } = this;
    return {
      context: frame.context, theme: frame.theme, px: (x) => frame.px(x), py: (y) => frame.py(y),
      unit: Math.abs(frame.px(1) - frame.px(0)), x0: frame.x.low, x1: frame.x.high, y0: frame.y.low, y1: frame.y.high,
    };
  }

  private trace({ loop }: Shown): void {
    const points = this.picture?.points ?? ((state: number[]): Point[] => [[state[0]!, state[1] ?? 0]]);
    this.traces = [];
    for (let j = 0; j < loop.times.length; ++j)
      points(loop.states.map((x) => x[j]!)).forEach((point, i) => (this.traces[i] ??= []).push(point));
  }

  private fit(shown: Shown): void {
    const { loop, orbit, period } = shown;
    const { frame } = this;
    const turn = this.picture?.turn;
    if (turn)
      turn.centre = [0, 1, 2].map((i) => (Math.min(...loop.states[i]!) + Math.max(...loop.states[i]!)) / 2) as typeof turn.centre;
    this.trace(shown);
    const paths = boxOf(this.traces.flat());
    const box = boxOf([...this.traces.flat(), ...(this.picture?.extent ?? [])]);
    if (this.picture && !this.picture.extent.length) {
      // A small orbit is shown with some of what is around it.
      const by = 0.35 * Math.max(paths.x1 - paths.x0, paths.y1 - paths.y0);
      box.x0 -= by;
      box.x1 += by;
      box.y0 -= by;
      box.y1 += by;
    }
    const [labelX, labelY] = this.picture?.axes ?? [this.names[0] ?? '', this.names[1] ?? ''];
    frame.x.label = labelX;
    frame.y.label = labelY;
    frame.setWhole(box);
    frame.describe(`${this.title}: ${this.store.atlas.family(orbit).name}, animated over its period ${rounded(period)}.${turn ? ' Arrows turn it.' : ''}`);
  }

  private draw(): void {
    if (!this.shown) return;
    const { frame } = this;
    this.picture?.background?.(this.pen(), this.store.atlas.value('energy', this.shown.orbit));
    this.traces.forEach((trace, i) => drawPath(frame, trace.length, (j) => trace[j]!, frame.theme.families[i % 8]!));
  }

  private drawFigure(): void {
    if (!this.shown) return;
    const state = this.shown.loop.at(this.clock.time);
    if (this.picture) this.picture.figure(this.pen(), state);
    else drawDot(this.frame, state[0]!, state[1] ?? 0);
  }
}
