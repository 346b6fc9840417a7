import type { Loop } from '../data/loop';
import { h } from '../dom';
import type { Frame } from '../plot/frame';

/** What the parts of the orbit's view show: an orbit of the atlas, and the loop that is drawn of it. */
export interface Shown {
  orbit: number;
  /** The orbit itself, or the nearest of its family that has a loop on the page. */
  drawn: number;
  loop: Loop;
  period: number;
}

/** A part of the orbit's view that draws its loop. */
export interface OrbitPart {
  readonly frames: Frame[];
  show(shown: Shown): void;
}

/** A part that can be folded away; what was hidden is drawn when it is opened. */
export function section(title: string, isOpen: boolean, frames: Frame[], ...content: (Node | string)[]): HTMLDetailsElement {
  const details = h('details', { open: isOpen }, h('summary', {}, title), ...content);
  details.addEventListener('toggle', () => frames.forEach((frame) => frame.draw()));
  return details;
}
