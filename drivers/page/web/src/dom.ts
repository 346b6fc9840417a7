type Child = Node | string | null | undefined | false;

/** An element; texts become text nodes, never markup. Attributes with a function are listeners. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, unknown> = {},
  ...children: (Child | Child[])[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name, value as EventListener);
    else if (value === true) element.setAttribute(name, '');
    else element.setAttribute(name, String(value));
  }
  for (const child of children.flat()) if (child || child === '') element.append(child as Node | string);
  return element;
}

export function replaceChildren(parent: Element, ...children: (Child | Child[])[]): void {
  parent.replaceChildren(...children.flat().filter((c): c is Node | string => Boolean(c)));
}

export function select(label: string, options: { id: string; label: string }[], value: string, onChange: (id: string) => void, visible = label): HTMLLabelElement {
  const list = h('select', { 'aria-label': label });
  for (const option of options) list.append(h('option', { value: option.id }, option.label));
  list.value = value;
  list.addEventListener('change', () => onChange(list.value));
  return h('label', { class: 'select' }, h('span', {}, visible), list);
}

/** Copies a text; true where the browser let us. */
export async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = h('textarea', { class: 'off-screen' });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}

export function download(name: string, text: string, type: string): void {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = h('a', { href: url, download: name });
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(url), 1000);
}
