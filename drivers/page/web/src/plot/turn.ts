export type Triple = [number, number, number];

/** An orthographic view of space from somewhere, and around a place that stays in the middle. */
export class Turn {
  centre: Triple = [0, 0, 0];
  private turn = 0.6;
  private tilt = 0.45;

  rotate(turn: number, tilt: number): void {
    this.turn += turn;
    this.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.tilt + tilt));
  }

  /** Seen from where another is. */
  from(other: Turn): void {
    this.turn = other.turn;
    this.tilt = other.tilt;
  }

  project(place: Triple): [number, number] {
    const [x, y, z] = place.map((v, i) => v - this.centre[i]!) as Triple;
    const [c, s] = [Math.cos(this.turn), Math.sin(this.turn)];
    const depth = s * x + c * y;
    return [c * x - s * y, Math.cos(this.tilt) * z + Math.sin(this.tilt) * depth];
  }
}
