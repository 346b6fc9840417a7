import type { Complex } from '../data/atlas';
import { kindOf } from '../data/kinds';
import type { Loop } from '../data/loop';
import { exact, rounded } from '../data/quantities';
import { copy, download, h, replaceChildren } from '../dom';
import { pictureOf } from '../pictures';
import type { Pen, Picture, Point } from '../pictures/picture';
import { Frame } from '../plot/frame';
import { currentTheme, familyColour } from '../plot/theme';
import type { Store } from '../state';
import { Clock } from './clock';
import { Space } from './space';
import { familyCsv, fileName, orbitJson } from './export';
import { stabilityBand } from './tree';

const certificateTexts: Record<string, string> = {
  closure: 'gap after re-integrating in segments',
  taylor_closure: 'the same by Taylor series',
  integrators_apart: 'distance of the two integrations',
  single_shot: 'gap after one integration all around',
  energy_drift: 'largest change of the energy',
  other_drift: 'of other conserved quantities',
  symmetry_defect: 'distance from its symmetry',
  recurrence: 'distance from a shorter orbit',
  orbit_distance: 'distance to the true orbit',
  contraction: "Newton's second step in parts of the first",
  pairing: '|product of multipliers − 1|',
  index_gap: "distance from the certificate's own index",
  loss_rms: 'residual, rms |dz/dt − f|',
  tail: 'largest of the last harmonics',
  stability_error: 'error bound of the stability index',
  log_volume: 'logarithm of the product of all multipliers',
  off_branch_eigenvalue: 'smallest eigenvalue off the family',
};

function complexText({ re, im }: Complex): string {
  return Math.abs(im) > 0 ? `${rounded(re)} ${im < 0 ? '−' : '+'} ${rounded(Math.abs(im))} i` : rounded(re);
}

/** Beyond the unit circle 2 − 1/r stands for r: a pair mu, 1/mu lies at equal distances from the circle. */
function inCompressedPlane({ re, im }: Complex): Point {
  const r = Math.hypot(re, im);
  const scale = r > 1 ? (2 - 1 / r) / r : 1;
  return [re * scale, im * scale];
}

export class OrbitView {
  readonly element: HTMLElement;
  readonly clock = new Clock();
  private loop: Loop | null = null;
  private shown = -1;
  private readonly head = h('div', { class: 'head' });
  private readonly slider = h('input', { type: 'range', min: '0', value: '0', step: '1', 'aria-label': 'Orbit along the family' });
  private readonly strip = h('div', { class: 'strip' });
  private readonly place = h('output', { class: 'place' });
  private readonly facts = h('dl', { class: 'facts' });
  private readonly stateTable = h('table', { class: 'numbers' });
  private readonly crossingCard = h('div', { class: 'card crossing' });
  private readonly multiplierList = h('div', { class: 'values' });
  private readonly certificate = h('div', {});
  private readonly note = h('p', { class: 'note', role: 'status', 'aria-live': 'polite' });
  private readonly stand = h('p', { class: 'soft', hidden: true });
  private readonly play = h('button', { type: 'button', class: 'icon' });
  private readonly scrub = h('input', { type: 'range', min: '0', max: '1', step: '0.001', value: '0', 'aria-label': 'Time in the period' });
  private picture: Picture | null;
  private readonly frames: { picture: Frame; planes: Frame[]; time: Frame; spectrum: Frame; multipliers: Frame };
  private readonly planeAxes: [number, number][];
  private readonly hiddenCourses = new Set<number>();
  private readonly swatches: HTMLElement[] = [];
  private readonly space: Space | null;

  constructor(private readonly store: Store) {
    const { atlas } = store;
    const names = atlas.index.stateNames;
    this.picture = this.makePicture(-1);
    const d = names.length;
    const half = d % 2 === 0 && d >= 2 ? d / 2 : Math.min(1, d - 1);
    this.planeAxes = d >= 4 ? [[0, 1], [0, half]] : [[0, Math.min(1, d - 1)], [0, d - 1]];
    const bare = this.picture !== null && !this.picture.axes;
    this.frames = {
      picture: new Frame({ label: 'The orbit, animated', square: true, bare, inPanel: true }),
      planes: this.planeAxes.map((_, i) => new Frame({ label: `Path ${i + 1}`, inPanel: true })),
      time: new Frame({ label: 'Time courses', inPanel: true }),
      spectrum: new Frame({ label: 'Fourier spectrum', inPanel: true }),
      multipliers: new Frame({ label: 'Multipliers', square: true, bare: true, fixed: true }),
    };
    const f = this.frames;
    f.picture.onDraw = () => this.drawPicture();
    f.picture.onOverlay = () => this.drawFigure();
    if (this.picture?.turn)
      f.picture.onTurn = (turn, tilt) => {
        this.picture!.turn!.rotate(turn, tilt);
        if (this.loop) this.trace();
        f.picture.draw();
      };
    f.planes.forEach((frame, i) => {
      frame.onDraw = () => this.drawPlane(i);
      frame.onOverlay = () => this.drawPlaneDot(i);
    });
    f.time.onDraw = () => this.drawTime();
    f.time.onOverlay = () => this.drawTimeCursor();
    f.time.onPick = (px) => this.clock.set(f.time.fromX(px) / this.period);
    f.spectrum.onDraw = () => this.drawSpectrum();
    f.multipliers.onDraw = () => this.drawMultipliers();
    f.multipliers.setWhole({ x0: -2, x1: 2, y0: -2, y1: 2 });
    this.clock.on(() => {
      f.picture.tick();
      f.planes.forEach((frame) => frame.tick());
      f.time.tick();
      if (document.activeElement !== this.scrub || this.clock.isRunning) this.scrub.value = String(this.clock.time);
    });
    this.slider.addEventListener('input', () => {
      const family = this.family;
      if (family) store.pick(family.first + Number(this.slider.value));
    });
    this.scrub.addEventListener('input', () => {
      this.run(false);
      this.clock.set(Number(this.scrub.value));
    });
    this.play.addEventListener('click', () => this.run(!this.clock.isRunning));
    this.run(this.clock.isRunning);
    const speed = h('select', { 'aria-label': 'Seconds a period takes' });
    for (const [seconds, label] of [[24, '¼×'], [12, '½×'], [6, '1×'], [3, '2×'], [1.5, '4×']] as const)
      speed.append(h('option', { value: String(seconds) }, label));
    speed.value = '6';
    speed.addEventListener('change', () => (this.clock.seconds = Number(speed.value)));
    // Systems with three places and three velocities have their path in space.
    this.space = d >= 3 ? new Space(names, [0, 1, 2], d === 6) : null;
    const button = (text: string, id: string, act: () => void, title = ''): HTMLButtonElement =>
      h('button', { type: 'button', id, title, click: act }, text);
    const section = (title: string, open: boolean, ...content: (Node | string)[]): HTMLDetailsElement => {
      const details = h('details', { open }, h('summary', {}, title), ...content);
      details.addEventListener('toggle', () => this.redraw());
      return details;
    };
    const courses = h('div', { class: 'chips' });
    names.forEach((name, i) => {
      const box = h('input', { type: 'checkbox', checked: true });
      const swatch = h('span', { class: 'line', 'aria-hidden': 'true' });
      this.swatches.push(swatch);
      box.addEventListener('change', () => {
        if (box.checked) this.hiddenCourses.delete(i);
        else this.hiddenCourses.add(i);
        this.fitTime();
        f.spectrum.draw();
      });
      courses.append(h('label', {}, box, swatch, name));
    });
    const planes = f.planes.map((frame, i) => {
      const choose = (part: 0 | 1): HTMLSelectElement => {
        const list = h('select', { 'aria-label': `${part ? 'Vertical' : 'Horizontal'} axis of path ${i + 1}` });
        names.forEach((name, n) => list.append(h('option', { value: String(n) }, name)));
        list.value = String(this.planeAxes[i]![part]);
        list.addEventListener('change', () => {
          this.planeAxes[i]![part] = Number(list.value);
          this.fitPlane(i);
        });
        return list;
      };
      return h('div', { class: 'plane' }, h('div', { class: 'bar' }, choose(1), ' against ', choose(0)), h('div', { class: 'plot small' }, frame.canvas));
    });
    this.element = h('section', { class: 'orbit', 'aria-label': 'The picked orbit' },
      this.head,
      h('div', { class: 'along' },
        h('button', { type: 'button', class: 'icon', title: 'Orbit before (,)', 'aria-label': 'Orbit before', click: () => this.step(-1) }, '‹'),
        h('div', { class: 'rail' }, this.slider, this.strip),
        h('button', { type: 'button', class: 'icon', title: 'Next orbit (.)', 'aria-label': 'Next orbit', click: () => this.step(1) }, '›')),
      this.place,
      this.crossingCard,
      h('div', { class: 'actions' },
        button('Copy state', 'copy-state', () => this.copyText(`[${atlas.parts('state', store.state.orbit).join(', ')}]`, 'The state'), 'The initial state at full precision'),
        button('Copy as JSON', 'copy-json', () => this.copyText(orbitJson(store, store.state.orbit), 'The orbit'), 'System, parameters, period, energy and state'),
        button('Copy link', 'copy-link', () => this.copyText(store.link(), 'The link'), 'A link to what is shown'),
        button('Family as CSV', 'csv', () => this.family && download(fileName(this.family.name, 'csv'), familyCsv(store, this.family), 'text/csv'), 'All orbits of the family')),
      this.note,
      section(this.picture?.title ?? 'Moving', true,
        this.stand,
        h('div', { class: 'plot picture' }, f.picture.canvas),
        h('div', { class: 'player' }, this.play, this.scrub, speed)),
      section('State and numbers', true, this.stateTable, this.facts),
      section('Paths', true, h('div', { class: 'planes' }, ...planes)),
      this.space ? section('Path in three coordinates', d === 6, this.space.element) : '',
      section('Time courses and spectrum', true, courses, h('div', { class: 'plot small' }, f.time.canvas), h('div', { class: 'plot small' }, f.spectrum.canvas)),
      section('Multipliers', true, h('div', { class: 'multipliers' }, h('div', { class: 'plot round' }, f.multipliers.canvas), this.multiplierList)),
      section('Certificate', true, this.certificate));
    store.on((parts) => {
      if (parts.has('orbit') || parts.has('crossing')) void this.show();
      if (parts.has('look')) this.redraw();
    });
    this.redraw();
    void this.show();
  }

  private makePicture(orbit: number): Picture | null {
    const { atlas } = this.store;
    const parameters = orbit < 0 ? atlas.parameters() : atlas.parametersOf(orbit);
    return pictureOf(atlas.index.system, parameters, atlas.index.stateNames);
  }
  private get family() {
    const { orbit } = this.store.state;
    return orbit >= 0 ? this.store.atlas.family(orbit) : undefined;
  }
  private get period(): number {
    return this.store.atlas.value('period', this.shown);
  }

  step(by: number): void {
    const family = this.family;
    if (!family) return;
    const to = this.store.state.orbit + by;
    if (to >= family.first && to < family.first + family.count) this.store.pick(to);
  }

  run(on: boolean): void {
    this.clock.isRunning = on;
    this.play.textContent = on ? '❚❚' : '▶';
    this.play.setAttribute('aria-label', on ? 'Stop' : 'Play');
    this.play.title = `${on ? 'Stop' : 'Play'} (space)`;
  }

  private async copyText(text: string, what: string): Promise<void> {
    this.note.textContent = (await copy(text)) ? `${what} is in the clipboard.` : `The browser does not let the page copy. ${text}`;
  }

  redraw(): void {
    const f = this.frames;
    for (const frame of [f.picture, ...f.planes, f.time, f.spectrum, f.multipliers]) frame.draw();
    this.space?.frame.draw();
    const theme = currentTheme();
    this.swatches.forEach((swatch, i) => (swatch.style.background = familyColour(theme, i)));
    this.fillStrip();
  }

  private async show(): Promise<void> {
    const { atlas, state } = this.store;
    this.fillCrossing();
    const orbit = state.orbit;
    if (orbit < 0) {
      this.element.classList.add('empty');
      replaceChildren(this.head, h('h2', {}, 'This atlas has no orbits'));
      return;
    }
    if (orbit === this.shown) return;
    const isOther = this.shown < 0 || atlas.familyOf[this.shown] !== atlas.familyOf[orbit];
    this.shown = orbit;
    this.note.textContent = '';
    this.fillHead();
    if (isOther) this.fillStrip();
    this.fillNumbers();
    const drawn = atlas.nearestWithLoop(orbit);
    const loop = drawn < 0 ? null : await atlas.loop(drawn);
    if (this.shown !== orbit) return;
    this.loop = loop;
    const turn = this.picture?.turn;
    this.picture = drawn < 0 ? this.picture : this.makePicture(drawn);
    if (this.picture && turn) this.picture.turn?.from(turn);
    this.stand.hidden = drawn === orbit;
    this.stand.textContent = drawn < 0 ? 'This page has no loop of this family.' : `Drawn is step ${atlas.value('step', drawn)} of the family: of ${atlas.orbits} orbits the page has ${atlas.index.loops} loops.`;
    if (!loop) return;
    this.fitPicture();
    this.planeAxes.forEach((_, i) => this.fitPlane(i));
    this.space?.show(loop);
    this.fitTime();
    this.fitSpectrum();
    this.frames.multipliers.draw();
  }

  private fillHead(): void {
    const { atlas, state } = this.store;
    const family = this.family!;
    const orbit = state.orbit;
    const link = (row: number): HTMLElement =>
      h('button', { type: 'button', class: 'link', click: () => this.store.pickFamily(row) }, atlas.families[row]!.name);
    const crossing = atlas.crossings[family.crossing];
    const s = atlas.stable[orbit];
    const badge = h('span', { class: `badge ${s === 1 ? 'stable' : s === 0 ? 'unstable' : 'unknown'}` }, s === 1 ? 'stable' : s === 0 ? 'unstable' : 'stability not known');
    replaceChildren(this.head,
      h('h2', {}, family.name, badge),
      h('p', {},
        family.parent >= 0
          ? [crossing ? h('button', { type: 'button', class: 'link', click: () => this.store.pickCrossing(crossing.row) }, kindOf(crossing.kind).text) : 'branch', ' of ', link(family.parent), family.multiplicity > 1 ? `, ${family.multiplicity} times around` : '', '. ']
          : 'From an equilibrium. ',
        family.isotropy ? `Symmetry ${family.isotropy}. ` : 'No symmetry. ',
        `Ends: ${family.endReason}`,
        family.endFamily >= 0 && family.endFamily !== family.row && atlas.families[family.endFamily] ? [' → ', link(family.endFamily)] : ''),
      family.children.length
        ? h('p', { class: 'children' }, 'Branches: ', family.children.map((row, i) => [i ? ', ' : '', link(row)]).flat())
        : null);
    this.slider.max = String(family.count - 1);
    this.slider.value = String(orbit - family.first);
    const step = atlas.value('step', orbit);
    this.slider.setAttribute('aria-valuetext', `step ${step}, T ${rounded(atlas.value('period', orbit))}`);
    this.place.textContent = `Orbit ${orbit - family.first + 1} of ${family.count} (step ${step})`;
  }

  private fillStrip(): void {
    const { atlas } = this.store;
    const family = this.family;
    if (!family) return;
    const theme = currentTheme();
    this.strip.style.backgroundImage = stabilityBand(this.store, family, theme);
    const marks: HTMLElement[] = [];
    for (const row of family.crossings) {
      const crossing = atlas.crossings[row]!;
      let below = 0;
      while (below < family.count && atlas.value('arclength', family.first + below) < crossing.arclength) ++below;
      const at = family.count > 1 ? Math.max(0, Math.min(1, (below - 0.5) / (family.count - 1))) : 0.5;
      const mark = h('button', { type: 'button', class: 'tick', tabindex: '-1', title: `${kindOf(crossing.kind).text}, T ${rounded(crossing.period)}`, 'aria-label': `${kindOf(crossing.kind).text} at T ${rounded(crossing.period)}`, click: () => this.store.pickCrossing(row) });
      mark.style.left = `${100 * at}%`;
      marks.push(mark);
    }
    replaceChildren(this.strip, marks);
  }

  private fillCrossing(): void {
    const { atlas, state } = this.store;
    const crossing = atlas.crossings[state.crossing];
    this.crossingCard.hidden = !crossing;
    if (!crossing) return;
    const kind = kindOf(crossing.kind);
    const rows: [string, string][] = [
      ['T', exact(crossing.period)],
      ['E', exact(crossing.energy)],
      ['m', `orbits born there close after ${crossing.multiplicity} period${crossing.multiplicity === 1 ? '' : 's'}`],
      ['multiplier', `exp(2πi · ${crossing.sectorJ}/${crossing.sectorQ}) of the fundamental map`],
      ['kernel', crossing.kernelDimension < 0 ? 'not computed' : `${crossing.kernelDimension} flat direction${crossing.kernelDimension === 1 ? '' : 's'}`],
      ['residual', rounded(crossing.residual, 3)],
      ...crossing.state.map((value, i): [string, string] => [atlas.index.stateNames[i]!, exact(value)]),
    ];
    if (kind.name.startsWith('fold') || kind.name === 'krein') rows.splice(3, 1);
    replaceChildren(this.crossingCard,
      h('div', { class: 'bar' }, h('h3', {}, `${kind.text[0]!.toUpperCase()}${kind.text.slice(1)} (crossing ${crossing.row})`),
        h('button', { type: 'button', class: 'icon', 'aria-label': 'Close', click: () => this.store.set({ crossing: -1 }, 'crossing') }, '×')),
      h('table', { class: 'numbers' }, rows.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value)))),
      h('p', {}, crossing.born.length ? ['Born here: ', crossing.born.map((row, i) => [i ? ', ' : '', h('button', { type: 'button', class: 'link', click: () => this.store.pickFamily(row) }, atlas.families[row]!.name)]).flat()].flat() : 'No family of this atlas is born here.'),
      h('button', { type: 'button', click: () => void this.copyText(`[${crossing.state.join(', ')}]`, "The crossing's state") }, 'Copy its state'));
  }

  private fillNumbers(): void {
    const { atlas, state } = this.store;
    const orbit = state.orbit;
    const names = atlas.index.stateNames;
    replaceChildren(this.stateTable,
      h('caption', {}, 'Initial state, at s = 0'),
      names.map((name, i) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, exact(atlas.value('state', orbit, i))))));
    const facts: [string, string][] = [['period T', exact(atlas.value('period', orbit))]];
    const fact = (name: string, column: string): void => {
      const value = atlas.value(column, orbit);
      if (Number.isFinite(value)) facts.push([name, exact(value)]);
    };
    fact('energy E', 'energy');
    fact('action', 'action');
    fact('parameter', 'parameter');
    const noun = atlas.index.multipliers ? 'multiplier' : 'stability index';
    atlas.stabilityValues('stability', orbit).forEach((v) => facts.push([noun, complexText(v)]));
    facts.push(['arclength', rounded(atlas.value('arclength', orbit))]);
    facts.push(['amplitude', rounded(atlas.value('amplitude', orbit))]);
    const turns = atlas.parts('winding', orbit);
    if (turns.some((t) => t !== 0)) facts.push(['turns', turns.join(', ')]);
    replaceChildren(this.facts, facts.map(([name, value]) => h('div', {}, h('dt', {}, name), h('dd', {}, value))));
    const verdict = atlas.value('verdict', orbit);
    const text = verdict < 0 ? 'none was computed' : (atlas.index.verdicts[verdict] ?? `verdict ${verdict}`);
    const shown = Object.keys(certificateTexts).filter((name) => Number.isFinite(atlas.value(name, orbit)));
    replaceChildren(this.certificate,
      h('p', {}, 'An independent check says: ', h('strong', { class: verdict === 0 ? 'good' : verdict > 1 ? 'bad' : '' }, text), '.'),
      h('table', { class: 'numbers small' }, shown.map((name) => h('tr', {}, h('th', { scope: 'row' }, certificateTexts[name]!), h('td', {}, rounded(atlas.value(name, orbit), 3))))),
      h('p', { class: 'soft' }, `Harmonics: ${atlas.value('cutoff', orbit)} stored in the archive.`));
    const list = (title: string, column: 'stability' | 'fundamental_stability'): Node | null => {
      const values = atlas.multipliers(column, orbit);
      return values.length ? h('div', {}, h('h4', {}, title), h('ul', {}, values.map((v) => h('li', {}, `${complexText(v)}, |μ| = ${rounded(Math.hypot(v.re, v.im), 5)}`)))) : null;
    };
    replaceChildren(this.multiplierList, list('Over the period', 'stability'), list('Of the fundamental map', 'fundamental_stability'),
      h('p', { class: 'soft' }, 'Outside the circle 2 − 1/r stands for r. Those of the flow and of conserved quantities are left out.'));
    const all = atlas.multipliers('stability', orbit);
    this.frames.multipliers.describe(all.length ? `Multipliers: ${all.map(complexText).join('; ')}` : 'Multipliers were not computed.');
  }

  // --- the picture

  private pen(frame: Frame): Pen {
    return {
      context: frame.context, theme: frame.theme, px: (x) => frame.px(x), py: (y) => frame.py(y),
      unit: Math.abs(frame.px(1) - frame.px(0)), x0: frame.x.low, x1: frame.x.high, y0: frame.y.low, y1: frame.y.high,
    };
  }

  /** Bounds of some points, so that nothing is wider than it is. */
  private static box(points: Iterable<Point>) {
    const box = { x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity };
    for (const [x, y] of points) {
      box.x0 = Math.min(box.x0, x);
      box.x1 = Math.max(box.x1, x);
      box.y0 = Math.min(box.y0, y);
      box.y1 = Math.max(box.y1, y);
    }
    return box;
  }

  private traces: Point[][] = [];

  private trace(): void {
    const loop = this.loop!;
    const points = this.picture?.points ?? ((state: number[]): Point[] => [[state[0]!, state[1] ?? 0]]);
    this.traces = [];
    for (let j = 0; j < loop.times.length; ++j)
      points(loop.states.map((x) => x[j]!)).forEach((point, i) => (this.traces[i] ??= []).push(point));
  }

  private fitPicture(): void {
    const loop = this.loop!;
    const frame = this.frames.picture;
    const names = this.store.atlas.index.stateNames;
    const turn = this.picture?.turn;
    if (turn)
      turn.centre = [0, 1, 2].map((i) => (Math.min(...loop.states[i]!) + Math.max(...loop.states[i]!)) / 2) as typeof turn.centre;
    this.trace();
    const paths = OrbitView.box(this.traces.flat());
    const box = OrbitView.box([...this.traces.flat(), ...(this.picture?.extent ?? [])]);
    if (!this.picture?.extent.length) {
      // A small orbit is shown with some of what is around it.
      const by = 0.35 * Math.max(paths.x1 - paths.x0, paths.y1 - paths.y0);
      box.x0 -= by;
      box.x1 += by;
      box.y0 -= by;
      box.y1 += by;
    }
    const [labelX, labelY] = this.picture?.axes ?? [names[0] ?? '', names[1] ?? ''];
    frame.x.label = labelX;
    frame.y.label = labelY;
    frame.setWhole(box);
    frame.describe(`${this.picture?.title ?? 'Moving'}: ${this.family!.name}, animated over its period ${rounded(this.period)}.${turn ? ' Arrows turn it.' : ''}`);
  }

  private drawPicture(): void {
    if (!this.loop) return;
    const frame = this.frames.picture;
    const pen = this.pen(frame);
    this.picture?.background?.(pen, this.store.atlas.value('energy', this.shown));
    this.traces.forEach((trace, i) => this.path(frame, trace.length, (j) => trace[j]!, frame.theme.families[i % 8]!, 1.8));
  }

  private drawFigure(): void {
    if (!this.loop) return;
    const frame = this.frames.picture;
    const state = this.loop.at(this.clock.time);
    if (this.picture) this.picture.figure(this.pen(frame), state);
    else this.dot(frame, state[0]!, state[1] ?? 0);
  }

  private path(frame: Frame, count: number, at: (j: number) => Point, colour: string, width: number): void {
    const ctx = frame.context;
    ctx.beginPath();
    for (let j = 0; j < count; ++j) {
      const [x, y] = at(j);
      if (j) ctx.lineTo(frame.px(x), frame.py(y));
      else ctx.moveTo(frame.px(x), frame.py(y));
    }
    ctx.strokeStyle = colour;
    ctx.lineWidth = width;
    ctx.lineJoin = 'round';
    ctx.stroke();
  }

  private dot(frame: Frame, x: number, y: number): void {
    const ctx = frame.context;
    ctx.beginPath();
    ctx.arc(frame.px(x), frame.py(y), 5, 0, 2 * Math.PI);
    ctx.fillStyle = frame.theme.pick;
    ctx.fill();
    ctx.strokeStyle = frame.theme.panel;
    ctx.lineWidth = 1.5;
    ctx.stroke();
  }

  // --- planes

  private fitPlane(i: number): void {
    if (!this.loop) return;
    const [a, b] = this.planeAxes[i]!;
    const [x, y] = [this.loop.states[a]!, this.loop.states[b]!];
    const frame = this.frames.planes[i]!;
    const names = this.store.atlas.index.stateNames;
    frame.x.label = names[a]!;
    frame.y.label = names[b]!;
    frame.setWhole(this.visible(OrbitView.box(Array.from(x, (v, j): Point => [v, y[j]!]))));
    frame.describe(`Path of the orbit, ${names[b]} against ${names[a]}.`);
  }

  /** Ranges that are rounding beside the other coordinates are widened, so that they do not fill the plot. */
  private visible<B extends { x0: number; x1: number; y0: number; y1: number }>(box: B): B {
    const widest = Math.max(...this.loop!.states.map((s) => Math.max(...s) - Math.min(...s)));
    const widen = (low: number, high: number): [number, number] => {
      const least = 2e-4 * widest;
      return high - low >= least ? [low, high] : [(low + high) / 2 - least / 2, (low + high) / 2 + least / 2];
    };
    [box.x0, box.x1] = widen(box.x0, box.x1);
    [box.y0, box.y1] = widen(box.y0, box.y1);
    return box;
  }

  private drawPlane(i: number): void {
    if (!this.loop) return;
    const [a, b] = this.planeAxes[i]!;
    const [x, y] = [this.loop.states[a]!, this.loop.states[b]!];
    const frame = this.frames.planes[i]!;
    this.path(frame, x.length, (j) => [x[j]!, y[j]!], frame.theme.families[0]!, 1.8);
    const ctx = frame.context;
    ctx.fillStyle = frame.theme.ink;
    ctx.fillRect(frame.px(x[0]!) - 3, frame.py(y[0]!) - 3, 6, 6);
  }

  private drawPlaneDot(i: number): void {
    if (!this.loop) return;
    const state = this.loop.at(this.clock.time);
    const [a, b] = this.planeAxes[i]!;
    this.dot(this.frames.planes[i]!, state[a]!, state[b]!);
  }

  // --- time courses and spectrum

  private fitTime(): void {
    const loop = this.loop;
    if (!loop) return;
    const frame = this.frames.time;
    let [low, high] = [Infinity, -Infinity];
    loop.states.forEach((x, i) => {
      if (this.hiddenCourses.has(i)) return;
      for (const v of x) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
    });
    if (low > high) [low, high] = [-1, 1];
    frame.x.label = 't';
    frame.y.label = this.store.atlas.index.stateNames.filter((_, i) => !this.hiddenCourses.has(i)).join(', ');
    frame.setWhole(this.visible({ x0: 0, x1: this.period, y0: low, y1: high }));
    frame.describe(`Time courses of ${frame.y.label} over the period ${rounded(this.period)}.`);
  }

  private drawTime(): void {
    const loop = this.loop;
    if (!loop) return;
    const frame = this.frames.time;
    loop.states.forEach((x, i) => {
      if (!this.hiddenCourses.has(i))
        this.path(frame, x.length, (j) => [loop.times[j]! * this.period, x[j]!], frame.theme.families[i % 8]!, 1.8);
    });
  }

  private drawTimeCursor(): void {
    const frame = this.frames.time;
    const ctx = frame.context;
    const px = frame.px(this.clock.time * this.period);
    ctx.beginPath();
    ctx.moveTo(px, frame.inner.y0);
    ctx.lineTo(px, frame.inner.y1);
    ctx.strokeStyle = frame.theme.pick;
    ctx.lineWidth = 1.5;
    ctx.stroke();
  }

  private fitSpectrum(): void {
    const loop = this.loop!;
    const frame = this.frames.spectrum;
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
    frame.setWhole({ x0: 0, x1: loop.spectrum[0]!.length * loop.harmonicsABin, y0: Math.max(low, -18), y1: high });
    frame.describe(`Fourier spectrum of the loop: moduli from 10 to the ${rounded(high, 3)} down to 10 to the ${rounded(low, 3)}.`);
  }

  private drawSpectrum(): void {
    const loop = this.loop;
    if (!loop) return;
    const frame = this.frames.spectrum;
    const ctx = frame.context;
    loop.spectrum.forEach((bins, i) => {
      if (this.hiddenCourses.has(i)) return;
      ctx.fillStyle = ctx.strokeStyle = frame.theme.families[i % 8]!;
      ctx.beginPath();
      let open = false;
      bins.forEach((v, k) => {
        // Harmonics that a symmetry forbids are rounding: dots alone show them.
        const px = frame.px((k + 1) * loop.harmonicsABin);
        const py = frame.py(Math.max(v, -19));
        if (Number.isFinite(v)) ctx.fillRect(px - 2, py - 2, 4, 4);
        if (v < -15) return;
        if (open) ctx.lineTo(px, py);
        else ctx.moveTo(px, py);
        open = true;
      });
      ctx.lineWidth = 1;
      ctx.globalAlpha = 0.45;
      ctx.stroke();
      ctx.globalAlpha = 1;
    });
  }

  private drawMultipliers(): void {
    if (this.shown < 0) return;
    const frame = this.frames.multipliers;
    const { theme, context: ctx } = frame;
    const { atlas } = this.store;
    const unit = frame.px(1) - frame.px(0);
    ctx.strokeStyle = theme.grid;
    ctx.lineWidth = 1;
    for (const [a, b] of [[[-2, 0], [2, 0]], [[0, -2], [0, 2]]] as [Point, Point][]) {
      ctx.beginPath();
      ctx.moveTo(frame.px(a[0]), frame.py(a[1]));
      ctx.lineTo(frame.px(b[0]), frame.py(b[1]));
      ctx.stroke();
    }
    ctx.setLineDash([3, 3]);
    ctx.beginPath();
    ctx.arc(frame.px(0), frame.py(0), 2 * unit, 0, 2 * Math.PI);
    ctx.stroke();
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.arc(frame.px(0), frame.py(0), unit, 0, 2 * Math.PI);
    ctx.strokeStyle = theme.ink;
    ctx.lineWidth = 1.5;
    ctx.stroke();
    ctx.font = `${Math.max(11, theme.text * 0.72)}px system-ui, sans-serif`;
    ctx.fillStyle = theme.soft;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    ctx.fillText('∞', frame.px(1.9), frame.py(0) - 9);
    ctx.fillText('1', frame.px(1) + 7, frame.py(0) + 10);
    ctx.fillText('−1', frame.px(-1) - 10, frame.py(0) + 10);
    const draw = (column: 'stability' | 'fundamental_stability', filled: boolean): void => {
      for (const value of atlas.multipliers(column, this.shown)) {
        const [x, y] = inCompressedPlane(value);
        const isOut = Math.hypot(value.re, value.im) > 1 + 1e-3;
        ctx.beginPath();
        ctx.arc(frame.px(x), frame.py(y), filled ? 5 : 7, 0, 2 * Math.PI);
        ctx.fillStyle = ctx.strokeStyle = isOut ? theme.unstable : theme.stable;
        ctx.lineWidth = 2;
        if (filled) ctx.fill();
        else ctx.stroke();
      }
    };
    draw('fundamental_stability', false);
    draw('stability', true);
  }
}
