import { drawPotential } from './contours';
import { disc, type MakePicture } from './picture';

const potential = (x: number, y: number): number => (x * x + y * y) / 2 + x * x * y - (y * y * y) / 3;
/** The energy of the three saddles, above which orbits may leave. */
const saddle = 1 / 6;

export const henonHeiles: MakePicture = () => ({
  title: 'In the potential',
  coordinates: ['x', 'y'],
  axes: ['x', 'y'],
  points: ([x, y]) => [[x!, y!]],
  extent: [[-0.9, -0.55], [0.9, 1.02]],
  background(pen, energy) {
    drawPotential(pen, potential, [0.01, 1 / 24, 1 / 12, 1 / 8, saddle], energy);
  },
  figure(pen, [x, y]) {
    disc(pen, [x!, y!], 6, pen.theme.families[1]!);
  },
});
