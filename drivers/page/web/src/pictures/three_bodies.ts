import { disc, line, type MakePicture, type Point } from './picture';

/** The three masses about their centre, in the frame whose x axis points from the first to the second. */
export const threeBodies: MakePicture = ({ m1 = 1, m2 = 1, m3 = 1 }) => {
  const masses = [m1, m2, m3];
  const both = m1 + m2;
  const all = both + m3;
  const points = ([r, x, y]: number[]): Point[] => {
    const [px, py] = [(-m3 / all) * x!, (-m3 / all) * y!];
    return [[px - (m2 / both) * r!, py], [px + (m1 / both) * r!, py], [(both / all) * x!, (both / all) * y!]];
  };
  const largest = Math.max(...masses);
  return {
    title: 'Three masses, in the frame that turns with the first two',
    coordinates: ['r', 'x', 'y'],
    axes: ['along from 1 to 2', 'across'],
    points,
    extent: [],
    figure(pen, state) {
      const places = points(state);
      line(pen, [places[0]!, places[1]!], pen.theme.soft, 1);
      places.forEach((place, i) => disc(pen, place, Math.max(4, 9 * Math.cbrt(masses[i]! / largest)), pen.theme.families[i]!));
    },
  };
};
