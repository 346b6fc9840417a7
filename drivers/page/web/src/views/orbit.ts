import { kindOf } from '../data/kinds';
import { rounded } from '../data/quantities';
import { copy, download, h, replaceChildren } from '../dom';
import { currentTheme } from '../plot/theme';
import type { Store } from '../state';
import { Clock } from './clock';
import { Courses } from './courses';
import { CrossingCard } from './crossing_card';
import { familyCsv, fileName, orbitJson } from './export';
import { familyLink, familyLinks } from './family_links';
import { Motion } from './motion';
import { Multipliers } from './multipliers';
import { Numbers } from './numbers';
import { section, type OrbitPart } from './orbit_part';
import { Planes } from './planes';
import { Space } from './space';
import { stabilityBand } from './tree';

/** The picked orbit: where it is on its family, and each of its parts one below the other. */
export class OrbitView {
  readonly element: HTMLElement;
  readonly clock = new Clock();
  private shown = -1;
  private readonly head = h('div', { class: 'head' });
  private readonly slider = h('input', { type: 'range', min: '0', value: '0', step: '1', 'aria-label': 'Orbit along the family' });
  private readonly strip = h('div', { class: 'strip' });
  private readonly place = h('output', { class: 'place' });
  private readonly note = h('p', { class: 'note', role: 'status', 'aria-live': 'polite' });
  private readonly crossing: CrossingCard;
  private readonly motion: Motion;
  private readonly numbers: Numbers;
  private readonly courses: Courses;
  private readonly multipliers: Multipliers;
  /** All that draw the loop. */
  private readonly parts: OrbitPart[];

  constructor(private readonly store: Store) {
    const { atlas } = store;
    const names = atlas.index.stateNames;
    const d = names.length;
    const copyText = (text: string, what: string): void => void this.copyText(text, what);
    this.crossing = new CrossingCard(store, copyText);
    this.motion = new Motion(store, this.clock);
    this.numbers = new Numbers(atlas);
    this.courses = new Courses(names, this.clock);
    this.multipliers = new Multipliers(atlas);
    const planes = new Planes(names, this.clock);
    // Systems with three places and three velocities have their path in space.
    const space = d >= 3 ? new Space(names, [0, 1, 2], d === 6) : null;
    this.parts = [this.motion, planes, ...(space ? [space] : []), this.courses];
    this.slider.addEventListener('input', () => {
      const family = this.family;
      if (family) store.pick(family.first + Number(this.slider.value));
    });
    const button = (text: string, id: string, title: string, act: () => void): HTMLButtonElement =>
      h('button', { type: 'button', id, title, click: act }, text);
    this.element = h('section', { class: 'orbit', 'aria-label': 'The picked orbit' },
      this.head,
      h('div', { class: 'along' },
        h('button', { type: 'button', class: 'icon', title: 'Orbit before (,)', 'aria-label': 'Orbit before', click: () => this.step(-1) }, '‹'),
        h('div', { class: 'rail' }, this.slider, this.strip),
        h('button', { type: 'button', class: 'icon', title: 'Next orbit (.)', 'aria-label': 'Next orbit', click: () => this.step(1) }, '›')),
      this.place,
      this.crossing.element,
      h('div', { class: 'actions' },
        button('Copy state', 'copy-state', 'The initial state at full precision', () => copyText(`[${atlas.parts('state', store.state.orbit).join(', ')}]`, 'The state')),
        button('Copy as JSON', 'copy-json', 'System, parameters, period, energy and state', () => copyText(orbitJson(store, store.state.orbit), 'The orbit')),
        button('Copy link', 'copy-link', 'A link to what is shown', () => copyText(store.link(), 'The link')),
        button('Family as CSV', 'csv', 'All orbits of the family', () => this.family && download(fileName(this.family.name, 'csv'), familyCsv(store, this.family), 'text/csv'))),
      this.note,
      this.motion.element,
      this.numbers.element,
      planes.element,
      space ? section('Path in three coordinates', d === 6, space.frames, space.element) : '',
      this.courses.element,
      this.multipliers.element,
      this.numbers.certificateElement);
    store.on((changed) => {
      if (changed.has('orbit') || changed.has('crossing')) void this.show();
      if (changed.has('look')) this.redraw();
    });
    this.redraw();
    void this.show();
  }

  private get family() {
    const { orbit } = this.store.state;
    return orbit >= 0 ? this.store.atlas.family(orbit) : undefined;
  }

  step(by: number): void {
    const family = this.family;
    if (!family) return;
    const to = this.store.state.orbit + by;
    if (to >= family.first && to < family.first + family.count) this.store.pick(to);
  }

  run(on: boolean): void {
    this.motion.run(on);
  }

  private async copyText(text: string, what: string): Promise<void> {
    this.note.textContent = (await copy(text)) ? `${what} is in the clipboard.` : `The browser does not let the page copy. ${text}`;
  }

  redraw(): void {
    for (const part of this.parts) part.frames.forEach((frame) => frame.draw());
    this.multipliers.frame.draw();
    this.courses.colour();
    this.fillStrip();
  }

  private async show(): Promise<void> {
    const { atlas, state } = this.store;
    this.crossing.show();
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
    this.numbers.show(orbit);
    this.multipliers.show(orbit);
    const drawn = atlas.nearestWithLoop(orbit);
    const loop = drawn < 0 ? null : await atlas.loop(drawn);
    if (this.shown !== orbit) return;
    this.motion.tellStandIn(orbit, drawn);
    if (loop) for (const part of this.parts) part.show({ orbit, drawn, loop, period: atlas.value('period', orbit) });
  }

  private fillHead(): void {
    const { atlas, state } = this.store;
    const family = this.family!;
    const orbit = state.orbit;
    const crossing = atlas.crossings[family.crossing];
    const s = atlas.stable[orbit];
    const badge = h('span', { class: `badge ${s === 1 ? 'stable' : s === 0 ? 'unstable' : 'unknown'}` }, s === 1 ? 'stable' : s === 0 ? 'unstable' : 'stability not known');
    replaceChildren(this.head,
      h('h2', {}, family.name, badge),
      h('p', {},
        family.parent >= 0
          ? [crossing ? h('button', { type: 'button', class: 'link', click: () => this.store.pickCrossing(crossing.row) }, kindOf(crossing.kind).text) : 'branch', ' of ', familyLink(this.store, family.parent), family.multiplicity > 1 ? `, ${family.multiplicity} times around` : '', '. ']
          : 'Begun by the scene. ',
        family.isotropy ? `Symmetry ${family.isotropy}. ` : 'No symmetry. ',
        `Ends: ${family.endReason}`,
        family.endFamily >= 0 && family.endFamily !== family.row && atlas.families[family.endFamily] ? [' → ', familyLink(this.store, family.endFamily)] : ''),
      family.children.length
        ? h('p', { class: 'children' }, 'Branches: ', familyLinks(this.store, family.children))
        : null);
    this.slider.max = String(family.count - 1);
    this.slider.value = String(orbit - family.first);
    const step = atlas.value('step', orbit);
    this.slider.setAttribute('aria-valuetext', `step ${step}, T ${rounded(atlas.value('period', orbit))}`);
    this.place.textContent = `Orbit ${orbit - family.first + 1} of ${family.count} (step ${step})`;
  }

  /** Below the slider: where orbits are stable, and the crossings. */
  private fillStrip(): void {
    const { atlas } = this.store;
    const family = this.family;
    if (!family) return;
    this.strip.style.backgroundImage = stabilityBand(this.store, family, currentTheme());
    const marks: HTMLElement[] = [];
    for (const row of family.crossings) {
      const crossing = atlas.crossings[row]!;
      let below = 0;
      while (below < family.count && atlas.value('arclength', family.first + below) < crossing.arclength) ++below;
      const at = family.count > 1 ? Math.max(0, Math.min(1, (below - 0.5) / (family.count - 1))) : 0.5;
      const text = kindOf(crossing.kind).text;
      const mark = h('button', { type: 'button', class: 'tick', tabindex: '-1', title: `${text}, T ${rounded(crossing.period)}`, 'aria-label': `${text} at T ${rounded(crossing.period)}`, click: () => this.store.pickCrossing(row) });
      mark.style.left = `${100 * at}%`;
      marks.push(mark);
    }
    replaceChildren(this.strip, marks);
  }
}
