/** What happens at a crossing, as a person reads it, and its mark. */
export interface Kind {
  name: string;
  text: string;
  mark: 'square' | 'triangle' | 'turned' | 'diamond' | 'circle' | 'ring' | 'star' | 'cross' | 'dot';
}

export const kinds: Kind[] = [
  { name: 'branch-point', text: 'branch point', mark: 'square' },
  { name: 'period-doubling', text: 'period doubling', mark: 'triangle' },
  { name: 'subharmonic', text: 'subharmonic', mark: 'diamond' },
  { name: 'fold-energy', text: 'fold in energy', mark: 'circle' },
  { name: 'fold-period', text: 'fold in period', mark: 'ring' },
  { name: 'fold-parameter', text: 'fold in the parameter', mark: 'turned' },
  { name: 'torus', text: 'torus', mark: 'star' },
  { name: 'krein', text: 'Krein collision', mark: 'cross' },
];

/** A kind that this page does not know has its own name and a dot. */
export function kindOf(name: string): Kind {
  return kinds.find((kind) => kind.name === name) ?? { name, text: name, mark: 'dot' };
}

/** A mark about (x, y) with half-width r, as a path to fill or stroke. */
export function markPath(ctx: CanvasRenderingContext2D, mark: Kind['mark'], x: number, y: number, r: number): void {
  ctx.beginPath();
  const polygon = (points: [number, number][]): void => {
    points.forEach(([dx, dy], i) => (i ? ctx.lineTo(x + dx * r, y + dy * r) : ctx.moveTo(x + dx * r, y + dy * r)));
    ctx.closePath();
  };
  switch (mark) {
    case 'square':
      ctx.rect(x - 0.85 * r, y - 0.85 * r, 1.7 * r, 1.7 * r);
      break;
    case 'triangle':
      polygon([[0, -1.15], [1.05, 0.75], [-1.05, 0.75]]);
      break;
    case 'turned':
      polygon([[0, 1.15], [1.05, -0.75], [-1.05, -0.75]]);
      break;
    case 'diamond':
      polygon([[0, -1.2], [1, 0], [0, 1.2], [-1, 0]]);
      break;
    case 'star':
      polygon(Array.from({ length: 10 }, (_, i) => {
        const a = (i * Math.PI) / 5;
        const d = i % 2 ? 0.5 : 1.25;
        return [d * Math.sin(a), -d * Math.cos(a)] as [number, number];
      }));
      break;
    case 'cross':
      polygon([[-0.35, -1.1], [0.35, -1.1], [0.35, -0.35], [1.1, -0.35], [1.1, 0.35], [0.35, 0.35], [0.35, 1.1],
        [-0.35, 1.1], [-0.35, 0.35], [-1.1, 0.35], [-1.1, -0.35], [-0.35, -0.35]]);
      break;
    case 'circle':
    case 'ring':
      ctx.arc(x, y, r, 0, 2 * Math.PI);
      break;
    case 'dot':
      ctx.arc(x, y, 0.6 * r, 0, 2 * Math.PI);
      break;
  }
}

/** Filled but for the ring, which folds in period are. */
export function drawMark(ctx: CanvasRenderingContext2D, kind: Kind, x: number, y: number, r: number, ink: string, paper: string): void {
  markPath(ctx, kind.mark, x, y, r);
  ctx.lineWidth = 1.5;
  ctx.fillStyle = kind.mark === 'ring' ? paper : ink;
  ctx.strokeStyle = kind.mark === 'ring' ? ink : paper;
  ctx.fill();
  ctx.stroke();
}
