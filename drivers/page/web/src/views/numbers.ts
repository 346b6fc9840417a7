import type { Atlas } from '../data/atlas';
import { exact, rounded } from '../data/quantities';
import { h, replaceChildren } from '../dom';
import { complexText } from './multipliers';
import { section } from './orbit_part';

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

/** The state of an orbit and its other numbers, and what the certificate says. */
export class Numbers {
  readonly element: HTMLElement;
  readonly certificateElement: HTMLElement;
  private readonly state = h('table', { class: 'numbers' });
  private readonly facts = h('dl', { class: 'facts' });
  private readonly certificate = h('div', {});

  constructor(private readonly atlas: Atlas) {
    this.element = section('State and numbers', true, [], this.state, this.facts);
    this.certificateElement = section('Certificate', true, [], this.certificate);
  }

  show(orbit: number): void {
    const { atlas } = this;
    replaceChildren(this.state,
      h('caption', {}, 'Initial state, at s = 0'),
      atlas.index.stateNames.map((name, i) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, exact(atlas.value('state', orbit, i))))));
    replaceChildren(this.facts, this.factsOf(orbit).map(([name, value]) => h('div', {}, h('dt', {}, name), h('dd', {}, value))));
    this.showCertificate(orbit);
  }

  private factsOf(orbit: number): [string, string][] {
    const { atlas } = this;
    const facts: [string, string][] = [['period T', exact(atlas.value('period', orbit))]];
    const fact = (name: string, column: string): void => {
      const value = atlas.value(column, orbit);
      if (Number.isFinite(value)) facts.push([name, exact(value)]);
    };
    fact('energy E', 'energy');
    fact('action', 'action');
    fact(atlas.index.moving || 'parameter', 'parameter');
    const noun = atlas.index.multipliers ? 'multiplier' : 'stability index';
    atlas.stabilityValues('stability', orbit).forEach((v) => facts.push([noun, complexText(v)]));
    facts.push(['arclength', rounded(atlas.value('arclength', orbit))]);
    facts.push(['amplitude', rounded(atlas.value('amplitude', orbit))]);
    const turns = atlas.parts('winding', orbit);
    if (turns.some((t) => t !== 0)) facts.push(['turns', turns.join(', ')]);
    return facts;
  }

  private showCertificate(orbit: number): void {
    const { atlas } = this;
    const verdict = atlas.value('verdict', orbit);
    const text = verdict < 0 ? 'none was computed' : (atlas.index.verdicts[verdict] ?? `verdict ${verdict}`);
    const shown = Object.keys(certificateTexts).filter((name) => Number.isFinite(atlas.value(name, orbit)));
    replaceChildren(this.certificate,
      h('p', {}, 'An independent check says: ', h('strong', { class: verdict === 0 ? 'good' : verdict > 1 ? 'bad' : '' }, text), '.'),
      h('table', { class: 'numbers small' }, shown.map((name) => h('tr', {}, h('th', { scope: 'row' }, certificateTexts[name]!), h('td', {}, rounded(atlas.value(name, orbit), 3))))),
      h('p', { class: 'soft' }, `Harmonics: ${atlas.value('cutoff', orbit)} stored in the archive.`));
  }
}
