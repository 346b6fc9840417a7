interface Channel {
  mean: number;
  cosines: Float64Array;
  sines: Float64Array;
}

class Reader {
  private readonly view: DataView;
  constructor(private readonly bytes: Uint8Array, private at: number) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  float(): number {
    const value = this.view.getFloat64(this.at, true);
    this.at += 8;
    return value;
  }
  count(): number {
    let value = 0;
    for (let scale = 1; ; scale *= 128) {
      const byte = this.byte();
      value += (byte & 127) * scale;
      if (byte < 128) return value;
    }
  }
  signed(): number {
    const zigzag = this.count();
    return zigzag % 2 ? -(zigzag + 1) / 2 : zigzag / 2;
  }
  byte(): number {
    return this.bytes[this.at++]!;
  }
  channel(): Channel {
    const step = this.float();
    const mean = this.float();
    const harmonics = this.count();
    const channel = { mean, cosines: new Float64Array(harmonics), sines: new Float64Array(harmonics) };
    for (let k = 0; k < harmonics; ++k) {
      channel.cosines[k] = this.signed() * step;
      channel.sines[k] = this.signed() * step;
    }
    return channel;
  }
}

/** An orbit as the page draws it: states at increasing times, the last one a period after the first. */
export class Loop {
  /** t/T of each sample, from 0 to 1. */
  readonly times: Float64Array;
  /** One array a coordinate, windings included. */
  readonly states: Float64Array[];
  readonly harmonics: number;
  /** log10 of the largest modulus in each bin, for each coordinate; -Infinity for none. */
  readonly spectrum: number[][];
  readonly harmonicsABin: number;

  constructor(bytes: Uint8Array, at: number, dimension: number, winding: number[]) {
    const reader = new Reader(bytes, at);
    const time = reader.channel();
    const channels = Array.from({ length: dimension }, () => reader.channel());
    this.harmonics = Math.max(time.cosines.length, ...channels.map((c) => c.cosines.length));
    const bins = reader.count();
    this.harmonicsABin = reader.count();
    this.spectrum = channels.map(() =>
      Array.from({ length: bins }, () => {
        const byte = reader.byte();
        return byte === 0 ? -Infinity : byte / 10 - 20;
      }),
    );
    const nodes = Math.min(4096, Math.max(240, 12 * this.harmonics));
    const cosines = Float64Array.from({ length: nodes }, (_, j) => Math.cos((2 * Math.PI * j) / nodes));
    const sines = Float64Array.from({ length: nodes }, (_, j) => Math.sin((2 * Math.PI * j) / nodes));
    const evaluate = (channel: Channel, turns: number): Float64Array => {
      const values = new Float64Array(nodes + 1);
      const count = channel.cosines.length;
      for (let j = 0; j <= nodes; ++j) {
        let sum = channel.mean + (turns * 2 * Math.PI * j) / nodes;
        for (let k = 1, at = j % nodes; k <= count; ++k) {
          sum += channel.cosines[k - 1]! * cosines[at]! + channel.sines[k - 1]! * sines[at]!;
          at += j;
          while (at >= nodes) at -= nodes;
        }
        values[j] = sum;
      }
      return values;
    };
    const times = evaluate(time, 0);
    const begin = times[0]!;
    let before = 0;
    for (let j = 0; j <= nodes; ++j) {
      before = Math.max(before, times[j]! - begin + j / nodes);
      times[j] = Math.min(1, before);
    }
    times[nodes] = 1;
    this.times = times;
    this.states = channels.map((channel, i) => evaluate(channel, winding[i] ?? 0));
  }

  /** The state at a part of the period, between 0 and 1. */
  at(time: number): number[] {
    const times = this.times;
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle]! <= time) low = middle;
      else high = middle;
    }
    const width = times[high]! - times[low]!;
    const part = width > 0 ? (time - times[low]!) / width : 0;
    return this.states.map((x) => x[low]! + part * (x[high]! - x[low]!));
  }
}
