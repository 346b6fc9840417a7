import { Atlas } from './data/atlas';
import { quantitiesOf } from './data/quantities';
import { h, replaceChildren } from './dom';
import type { Tool } from './plot/frame';
import { Store } from './state';
import { aboutDialog, helpDialog, legend } from './views/about';
import { Diagram } from './views/diagram';
import { OrbitView } from './views/orbit';
import { Search } from './views/search';
import { Tree } from './views/tree';

const sizes = ['100%', '125%', '150%'];

function toggleTheme(): void {
  const root = document.documentElement;
  const dark = getComputedStyle(root).getPropertyValue('--dark').trim() === '1';
  root.dataset['theme'] = dark ? 'light' : 'dark';
}

async function start(): Promise<void> {
  const app = document.getElementById('app')!;
  if (typeof DecompressionStream === 'undefined') {
    replaceChildren(app, h('p', { class: 'loading' }, 'This browser is too old for the page: it needs Chrome 103, Firefox 113, Safari 16.4, or later ones.'));
    return;
  }
  const atlas = await Atlas.read();
  const store = new Store(atlas, quantitiesOf(atlas));
  const tools: { tool: Tool } = { tool: 'pan' };
  const first = new Diagram(store, 0, tools);
  const second = new Diagram(store, 1, tools);
  const tree = new Tree(store);
  const search = new Search(store);
  const orbit = new OrbitView(store);
  const help = helpDialog();
  const about = aboutDialog(store);
  document.title = `${atlas.index.title} – Orbweaver`;

  const redraw = (): void => store.set({}, 'look');
  const choice = (label: string, id: string, isOn: () => boolean, set: (on: boolean) => void): HTMLElement => {
    const box = h('input', { type: 'checkbox', id });
    box.checked = isOn();
    box.addEventListener('change', () => {
      set(box.checked);
      redraw();
    });
    store.on(() => (box.checked = isOn()));
    return h('label', { for: id }, box, ` ${label}`);
  };
  const colour = h('select', { id: 'colour', 'aria-label': 'Colour of the curves' },
    h('option', { value: 'stability' }, 'colour: stability'), h('option', { value: 'family' }, 'colour: family'));
  colour.value = store.state.colour;
  colour.addEventListener('change', () => store.set({ colour: colour.value === 'family' ? 'family' : 'stability' }, 'look'));
  store.on(() => (colour.value = store.state.colour));
  const toolBox = h('div', { class: 'tools', role: 'radiogroup', 'aria-label': 'What dragging does' });
  for (const [tool, label, title] of [['pan', 'Pan', 'Dragging moves the diagram'], ['zoom', 'Zoom', 'Dragging zooms to a rectangle (Ctrl)'], ['brush', 'Select', 'Dragging selects orbits (Shift)']] as const) {
    const button = h('button', { type: 'button', role: 'radio', id: `tool-${tool}`, title, 'aria-checked': String(tool === tools.tool) }, label);
    button.addEventListener('click', () => {
      tools.tool = tool;
      for (const other of toolBox.children) other.setAttribute('aria-checked', String(other === button));
    });
    toolBox.append(button);
  }

  const pages = { plot: 'Diagram', orbit: 'Orbit', tree: 'Families' };
  const tabs = h('div', { class: 'tabs', role: 'tablist', 'aria-label': 'Views' });
  const main = h('main', {});
  const show = (page: string): void => {
    main.dataset['page'] = page;
    for (const tab of tabs.children) tab.setAttribute('aria-selected', String((tab as HTMLElement).dataset['page'] === page));
  };
  for (const [page, label] of Object.entries(pages))
    tabs.append(h('button', { type: 'button', role: 'tab', 'data-page': page, click: () => show(page) }, label));
  show('plot');

  const picked = h('p', { class: 'picked', role: 'status', 'aria-live': 'polite' });
  const tellPicked = (): void => {
    const o = store.state.orbit;
    if (o < 0) return;
    const s = atlas.stable[o];
    picked.textContent = `Picked: ${atlas.family(o).name}, step ${atlas.value('step', o)}, T ${Number(atlas.value('period', o).toPrecision(7))}, ${s === 1 ? 'stable' : s === 0 ? 'unstable' : 'stability not known'}`;
  };
  const diagrams = h('div', { class: 'diagrams' }, first.element, second.element);
  const layout = (): void => {
    main.dataset['colour'] = store.state.colour;
    second.element.hidden = !store.state.hasSecond;
    diagrams.classList.toggle('two', store.state.hasSecond);
  };
  store.on((parts) => {
    if (parts.has('look') || parts.has('diagrams')) layout();
    if (parts.has('orbit')) tellPicked();
  });
  layout();
  tellPicked();
  main.append(tree.element,
    h('div', { class: 'centre' },
      h('div', { class: 'bar controls' }, toolBox, colour,
        choice('crossings', 'show-crossings', () => store.state.showCrossings, (on) => (store.state.showCrossings = on)),
        choice('only this family', 'isolate', () => store.state.isolate, (on) => (store.state.isolate = on)),
        choice('second diagram', 'second', () => store.state.hasSecond, (on) => (store.state.hasSecond = on))),
      diagrams, legend(store), picked),
    orbit.element);
  const parameters = atlas.index.parameterNames.map((name, i) => (name === atlas.index.moving ? `${name} moves` : `${name} = ${atlas.index.parameterValues[i]}`))
    .concat(atlas.index.effects.length ? `with ${atlas.index.effects.join(', ')}` : []).join(', ');
  const header = h('header', {},
    h('h1', {}, atlas.index.title, parameters ? h('small', {}, parameters) : null),
    search.element,
    h('div', { class: 'buttons' },
      h('button', { type: 'button', id: 'theme', title: 'Dark or light (t)', 'aria-label': 'Dark or light', class: 'icon', click: () => (toggleTheme(), tree.fill(), redraw()) }, '◐'),
      h('button', { type: 'button', id: 'size', title: 'Larger text, for a projector', 'aria-label': 'Larger text', class: 'icon', click: () => {
        const root = document.documentElement;
        root.style.fontSize = sizes[(sizes.indexOf(root.style.fontSize || '100%') + 1) % sizes.length]!;
        redraw();
      } }, 'A+'),
      h('button', { type: 'button', id: 'about', click: () => about.showModal() }, 'About'),
      h('button', { type: 'button', id: 'help', class: 'icon', 'aria-label': 'Help', title: 'Help (?)', click: () => help.showModal() }, '?')));
  replaceChildren(app, header, tabs, main, help, about);

  document.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || target.matches('input:not([type=range]):not([type=checkbox]), select, textarea') || document.querySelector('dialog[open]')) return;
    const family = store.state.orbit >= 0 ? atlas.familyOf[store.state.orbit]! : -1;
    const other = (by: number): void => {
      for (let row = family + by; row >= 0 && row < atlas.families.length; row += by)
        if (atlas.families[row]!.count > 0) return store.pickFamily(row);
    };
    const acts: Record<string, () => void> = {
      '/': () => search.input.focus(),
      ',': () => orbit.step(-1),
      '.': () => orbit.step(1),
      '[': () => other(-1),
      ']': () => other(1),
      t: () => document.getElementById('theme')!.click(),
      '?': () => help.showModal(),
      Escape: () => store.set({ brushed: null }, 'brush'),
    };
    if (event.key === ' ' && !target.matches('button, summary, input, [role=treeitem]')) orbit.run(!orbit.clock.isRunning);
    else if (acts[event.key]) acts[event.key]!();
    else return;
    event.preventDefault();
  });
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    tree.fill();
    redraw();
  });
  requestAnimationFrame(() => requestAnimationFrame(() => performance.mark('drawn')));
}

start().catch((error: unknown) => {
  const app = document.getElementById('app')!;
  replaceChildren(app, h('p', { class: 'loading' }, `The atlas in this page cannot be read: ${error instanceof Error ? error.message : String(error)}. Was the file cut off?`));
  throw error;
});
