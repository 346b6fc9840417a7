/** The time that all views of an orbit share, in parts of its period. */
export class Clock {
  time = 0;
  isRunning = !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
  /** Seconds in which a period passes. */
  seconds = 6;
  private before = 0;
  private readonly listeners: (() => void)[] = [];

  constructor() {
    const step = (now: number): void => {
      const passed = Math.min(100, now - this.before);
      this.before = now;
      if (this.isRunning) {
        this.time = (this.time + passed / 1000 / this.seconds) % 1;
        this.tell();
      }
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  on(listener: () => void): void {
    this.listeners.push(listener);
  }

  set(time: number): void {
    this.time = ((time % 1) + 1) % 1;
    this.tell();
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
