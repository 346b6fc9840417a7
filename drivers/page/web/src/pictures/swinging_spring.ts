import { disc, line, type MakePicture, type Point } from './picture';

const turns = 9;

/** A bob on a coiled spring; y upwards from the suspension. */
export const swingingSpring: MakePicture = ({ mass = 1, stiffness = 3, length = 1, gravity = 1 }) => {
  const rest = length + (mass * gravity) / stiffness;
  return {
    title: 'Spring and bob',
    coordinates: ['x', 'y'],
    points: ([x, y]) => [[x!, y!]],
    extent: [[-rest * 0.5, 0.15 * rest], [rest * 0.5, -rest * 1.1]],
    figure(pen, state) {
      const [x, y] = state as [number, number];
      const long = Math.hypot(x, y) || 1;
      const across: Point = [-y / long, x / long];
      const coil: Point[] = [[0, 0]];
      for (let i = 0; i <= 2 * turns; ++i) {
        const along = 0.12 + (0.76 * i) / (2 * turns);
        const out = (i === 0 || i === 2 * turns ? 0 : i % 2 ? 1 : -1) * 0.05 * rest;
        coil.push([along * x + out * across[0], along * y + out * across[1]]);
      }
      coil.push([x, y]);
      line(pen, [[-0.2 * rest, 0], [0.2 * rest, 0]], pen.theme.soft, 3);
      line(pen, coil, pen.theme.ink, 1.8);
      disc(pen, [x, y], Math.max(6, Math.min(13, 0.07 * rest * pen.unit)), pen.theme.families[1]!);
    },
  };
};
