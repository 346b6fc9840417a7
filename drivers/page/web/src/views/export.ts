import type { Family } from '../data/atlas';
import type { Store } from '../state';

const json = (value: number): number | null => (Number.isFinite(value) ? value : null);

/** One orbit at full precision. */
export function orbitJson(store: Store, orbit: number): string {
  const { atlas } = store;
  return JSON.stringify({
    system: atlas.index.system,
    effects: atlas.index.effects,
    parameters: atlas.parametersOf(orbit),
    family: atlas.family(orbit).name,
    step: atlas.value('step', orbit),
    period: json(atlas.value('period', orbit)),
    energy: json(atlas.value('energy', orbit)),
    coordinates: atlas.index.stateNames,
    state: atlas.parts('state', orbit).map(json),
  });
}

/** RFC 4180: a text with anything but plain letters is quoted. */
function field(text: string): string {
  return /^[\w.+-]*$/.test(text) ? text : `"${text.replaceAll('"', '""')}"`;
}

/** The orbits of a family, in order; numbers with all of their digits, empty where they were not computed. */
export function familyCsv(store: Store, family: Family): string {
  const { atlas } = store;
  const names = atlas.index.stateNames;
  const columns: { head: string; of: (orbit: number) => number }[] = [];
  for (const name of ['step', 'arclength', 'period', 'energy', 'action', 'parameter', 'stable', 'verdict', 'amplitude'])
    if (atlas.width(name)) columns.push({ head: name, of: (orbit) => atlas.value(name, orbit) });
  for (const name of ['stability', 'fundamental_stability'])
    for (let part = 0; part < atlas.width(name); ++part) {
      const head = atlas.index.complex ? `${name}_${part >> 1}_${part % 2 ? 'im' : 're'}` : `${name}_${part}`;
      columns.push({ head, of: (orbit) => atlas.value(name, orbit, part) });
    }
  names.forEach((name, i) => columns.push({ head: `state_${name}`, of: (orbit) => atlas.value('state', orbit, i) }));
  const lines = [columns.map((c) => field(c.head)).join(',')];
  for (let orbit = family.first; orbit < family.first + family.count; ++orbit)
    lines.push(columns.map((c) => (Number.isFinite(c.of(orbit)) ? String(c.of(orbit)) : '')).join(','));
  return `${lines.join('\r\n')}\r\n`;
}

/** A file name without what file systems or shells read otherwise. */
export function fileName(name: string, ending: string): string {
  return `${name.replace(/[^\p{L}\p{N}_-]+/gu, '_').slice(0, 80) || 'family'}.${ending}`;
}
