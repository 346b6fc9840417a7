import { drawPotential } from './contours';
import { disc, type MakePicture } from './picture';
import { drawBodies } from './two_bodies';

/** The frame that turns with the bodies, the five libration points, and where an orbit of this energy cannot go. */
export const pcr3bp: MakePicture = ({ mu = 0.01215058560962404 }) => {
  const potential = (x: number, y: number): number =>
    -(x * x + y * y) / 2 - (1 - mu) / Math.hypot(x + mu, y) - mu / Math.hypot(x + mu - 1, y);
  return {
    title: 'In the frame that turns with the bodies',
    coordinates: ['x', 'y'],
    axes: ['x', 'y'],
    points: ([x, y]) => [[x!, y!]],
    extent: [],
    background(pen, energy) {
      drawPotential(pen, potential, [], energy);
      drawBodies(pen, mu, (x, y) => [x, y]);
    },
    figure(pen, [x, y]) {
      disc(pen, [x!, y!], 6, pen.theme.families[1]!);
    },
  };
};
