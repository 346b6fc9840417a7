import { disc, line, type MakePicture, type Point } from './picture';

/** Rods and bobs; angles from the downward vertical. Bobs of the same density. */
export const doublePendulum: MakePicture = ({ m1 = 1, m2 = 1, l1 = 1, l2 = 1 }) => {
  const points = ([th1, th2]: number[]): Point[] => {
    const inner: Point = [l1 * Math.sin(th1!), -l1 * Math.cos(th1!)];
    return [inner, [inner[0] + l2 * Math.sin(th2!), inner[1] - l2 * Math.cos(th2!)]];
  };
  const reach = l1 + l2;
  const largest = Math.cbrt(Math.max(m1, m2));
  return {
    title: 'Rods and bobs',
    points,
    extent: [[-reach, -reach], [reach, reach]],
    figure(pen, state) {
      const [inner, outer] = points(state) as [Point, Point];
      line(pen, [[0, 0], inner, outer], pen.theme.ink, 3);
      const radius = Math.max(5, Math.min(13, 0.07 * reach * pen.unit));
      disc(pen, [0, 0], 4, pen.theme.soft);
      disc(pen, inner, (radius * Math.cbrt(m1)) / largest, pen.theme.families[0]!);
      disc(pen, outer, (radius * Math.cbrt(m2)) / largest, pen.theme.families[1]!);
    },
  };
};
