import { Turn, type Triple } from '../plot/turn';
import { disc, line, type MakePicture, type Point } from './picture';
import { drawBodies } from './two_bodies';

/** The frame that turns with the bodies, seen from somewhere: dragging turns it. */
export const cr3bp: MakePicture = ({ mu = 0.01215058560962404 }) => {
  const turn = new Turn();
  const inPlane = (x: number, y: number): Point => turn.project([x, y, 0]);
  return {
    title: 'In the frame that turns with the bodies',
    coordinates: ['x', 'y', 'z'],
    turn,
    points: (state) => [turn.project(state.slice(0, 3) as Triple)],
    extent: [],
    background(pen) {
      // The plane of the bodies: the circle of the smaller one, and the line through both.
      const circle = Array.from({ length: 181 }, (_, i) => inPlane((1 - mu) * Math.cos((i * Math.PI) / 90), (1 - mu) * Math.sin((i * Math.PI) / 90)));
      line(pen, circle, pen.theme.grid, 1);
      line(pen, [inPlane(-1.4, 0), inPlane(1.4, 0)], pen.theme.grid, 1);
      drawBodies(pen, mu, inPlane);
    },
    figure(pen, [x, y, z]) {
      // Its height above the plane of the bodies.
      line(pen, [inPlane(x!, y!), turn.project([x!, y!, z!])], pen.theme.soft, 1);
      disc(pen, turn.project([x!, y!, z!]), 6, pen.theme.families[1]!);
    },
  };
};
