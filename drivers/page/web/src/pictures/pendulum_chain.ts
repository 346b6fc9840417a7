import type { MakePicture } from './picture';
import { drawRods, rodEnds } from './rods';

/** Equal rods and bobs, each hanging from the one before. */
export const pendulumChain: MakePicture = ({ links = 3, l = 1 }) => {
  const lengths = new Array<number>(links).fill(l);
  const masses = new Array<number>(links).fill(1);
  const reach = links * l;
  return {
    title: 'Rods and bobs',
    coordinates: lengths.map((_, i) => `th${i + 1}`),
    points: (state) => rodEnds(state, lengths),
    extent: [[-reach / 3, 0.08 * reach], [reach / 3, -1.08 * reach]],
    figure(pen, state) {
      drawRods(pen, [0, 0], rodEnds(state, lengths), masses, reach);
    },
  };
};
