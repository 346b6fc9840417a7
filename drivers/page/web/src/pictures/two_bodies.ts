import { disc, label, line, type Pen, type Point } from './picture';

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

/** L1 to L5. */
function librations(mu: number): Point[] {
  const pull = (x: number): number =>
    x - ((1 - mu) * (x + mu)) / Math.abs(x + mu) ** 3 - (mu * (x + mu - 1)) / Math.abs(x + mu - 1) ** 3;
  const near = 1e-6;
  return [
    [zero(pull, -mu + near, 1 - mu - near), 0],
    [zero(pull, 1 - mu + near, 2), 0],
    [zero(pull, -2, -mu - near), 0],
    [0.5 - mu, Math.sqrt(3) / 2],
    [0.5 - mu, -Math.sqrt(3) / 2],
  ];
}

/** The bodies of the restricted problem and its libration points, where `seen` shows places of their plane. */
export function drawBodies(pen: Pen, mu: number, seen: (x: number, y: number) => Point): void {
  const { theme } = pen;
  disc(pen, seen(-mu, 0), 9, theme.families[0]!);
  disc(pen, seen(1 - mu, 0), 6, theme.families[4]!);
  // Labels stand on the other side of what the points are beside: a body, or the line through both.
  const beside: Point[] = [[1 - mu, 0], [1 - mu, 0], [-mu, 0], [0.5 - mu, 0], [0.5 - mu, 0]].map(([x, y]) => seen(x!, y!));
  librations(mu).forEach((place, i) => {
    const [x, y] = seen(...place);
    const arm = 4 / pen.unit;
    line(pen, [[x - arm, y], [x + arm, y]], theme.ink, 1.5);
    line(pen, [[x, y - arm], [x, y + arm]], theme.ink, 1.5);
    const [dx, dy] = [pen.px(x) - pen.px(beside[i]![0]), pen.py(y) - pen.py(beside[i]![1])];
    const far = Math.hypot(dx, dy);
    label(pen, [x, y], `L${i + 1}`, far > 0 ? (14 * dx) / far : 0, far > 0 ? (14 * dy) / far : -14);
  });
}
