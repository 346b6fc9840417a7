import { drawPotential } from './contours';
import { disc, label, line, type MakePicture, type Point } from './picture';

/** The zero of a falling or rising function between two places, by bisection: the page draws it, nothing is computed from it. */
function zero(f: (x: number) => number, low: number, high: number): number {
  const sign = Math.sign(f(low));
  for (let i = 0; i < 60; ++i) {
    const middle = (low + high) / 2;
    if (Math.sign(f(middle)) === sign) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

/** The frame that turns with the bodies, the five libration points, and where an orbit of this energy cannot go. */
export const pcr3bp: MakePicture = ({ mu = 0.01215058560962404 }) => {
  const potential = (x: number, y: number): number =>
    -(x * x + y * y) / 2 - (1 - mu) / Math.hypot(x + mu, y) - mu / Math.hypot(x + mu - 1, y);
  const pull = (x: number): number =>
    x - ((1 - mu) * (x + mu)) / Math.abs(x + mu) ** 3 - (mu * (x + mu - 1)) / Math.abs(x + mu - 1) ** 3;
  const near = 1e-6;
  const librations: Point[] = [
    [zero(pull, -mu + near, 1 - mu - near), 0],
    [zero(pull, 1 - mu + near, 2), 0],
    [zero(pull, -2, -mu - near), 0],
    [0.5 - mu, Math.sqrt(3) / 2],
    [0.5 - mu, -Math.sqrt(3) / 2],
  ];
  return {
    title: 'In the frame that turns with the bodies',
    axes: ['x', 'y'],
    points: ([x, y]) => [[x!, y!]],
    extent: [],
    background(pen, energy) {
      drawPotential(pen, potential, [], energy);
      const { theme } = pen;
      disc(pen, [-mu, 0], 9, theme.families[0]!);
      disc(pen, [1 - mu, 0], 6, theme.families[4]!);
      librations.forEach(([x, y], i) => {
        const arm = 4 / pen.unit;
        line(pen, [[x - arm, y], [x + arm, y]], theme.ink, 1.5);
        line(pen, [[x, y - arm], [x, y + arm]], theme.ink, 1.5);
        label(pen, [x, y], `L${i + 1}`, 0, i === 4 ? 13 : -12);
      });
    },
    figure(pen, [x, y]) {
      disc(pen, [x!, y!], 6, pen.theme.families[1]!);
    },
  };
};
