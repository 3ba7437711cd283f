// How the bodies stood in a recorded run, at any time.

export class Recording {
  /** [s] of each moment */
  times;
  #qpos;
  #nq;
  #still;
  #bodies;
  #moves;

  /**
   * @param {import('./packed_run.js').Unpacker} from  behind the meshes
   * @param {{moments: number, bodies: number[], still: number[]}} run
   * @param {number} nq
   */
  constructor(from, { moments, bodies, still }, nq) {
    this.times = from.doubles(moments);
    this.#qpos = from.doubles(moments * nq);
    this.#nq = nq;
    this.#still = Float32Array.from(still);
    this.#bodies = bodies;
    this.#moves = bodies.map(() => from.body(moments));
  }

  get end() {
    return this.times.at(-1) ?? 0;
  }

  /** The last moment not after a time. */
  momentAt(time) {
    let [low, high] = [0, this.times.length - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** @returns {{bodies: Float32Array, qpos: Float32Array}} between two moments in even proportion */
  at(time) {
    const i = this.momentAt(time);
    const next = Math.min(i + 1, this.times.length - 1);
    const span = this.times[next] - this.times[i];
    const share = span > 0 ? Math.min(1, Math.max(0, (time - this.times[i]) / span)) : 0;
    const between = (a, b) => a + share * (b - a);
    const bodies = this.#still.slice();
    this.#bodies.forEach((body, index) => {
      const row = this.#moves[index];
      const out = bodies.subarray(7 * body, 7 * body + 7);
      for (let k = 0; k < 7; ++k) out[k] = between(row[7 * i + k], row[7 * next + k]);
      const length = Math.hypot(out[3], out[4], out[5], out[6]) || 1;
      for (let k = 3; k < 7; ++k) out[k] /= length;
    });
    const qpos = Float32Array.from({ length: this.#nq }, (_, j) =>
      between(this.#qpos[j * this.times.length + i], this.#qpos[j * this.times.length + next]));
    return { bodies, qpos };
  }
}
