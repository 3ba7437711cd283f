// A second client of the server. It knows nothing of the page: what it hears is what the program does.
import WebSocket from 'ws';

const HEAD = 16; // [bytes] of a frame
const LONG = 30000; // [ms] until something must have happened

export class Witness {
  /** The newest message of each type. */
  latest = {};
  /** The newest frame: {time, paused, bodies: [x y z w x y z][], qpos}. */
  frame = null;
  #scene;
  #socket;
  #waiting = new Set();

  /** @param {string} url  of the page */
  static async open(url) {
    const witness = new Witness();
    witness.#scene = await (await fetch(new URL('scene.json', url))).json();
    witness.#socket = new WebSocket(new URL('live', url.replace('http:', 'ws:')));
    witness.#socket.on('message', (data, isBinary) => witness.#take(data, isBinary));
    const hasTarget = witness.#scene.options.can_target;
    await witness.until('everything to be told',
      () => witness.frame && witness.latest.panels && (witness.latest.target || !hasTarget));
    return witness;
  }

  close() {
    this.#socket.terminate();
  }

  get scene() {
    return this.#scene;
  }

  get target() {
    return this.latest.target;
  }

  /** Kinds of what is drawn on top. */
  get overlay() {
    return this.latest.overlay.items.map(({ kind }) => kind);
  }

  /** An item of the panels. @param {string} name @param {string} [section]  its title, where two have the name */
  item(name, section) {
    const places = this.latest.panels.sections.filter(({ title }) => section === undefined || title === section);
    const found = places.flatMap(({ items }) => items).find((item) => item.name === name);
    if (!found) throw new Error(`the panels have no "${name}"`);
    return found;
  }

  send(message) {
    this.#socket.send(JSON.stringify(message));
  }

  /**
   * Waits until `condition` gives something that counts, and hands that over.
   * @param {string} what  "the arm to stand", for the message where that never happens
   * @param {() => any} condition
   * @param {() => any} [state]  told along with it
   */
  until(what, condition, state = () => '') {
    return new Promise((resolve, reject) => {
      const look = () => {
        const met = condition();
        if (!met) return;
        clearTimeout(timer);
        this.#waiting.delete(look);
        resolve(met);
      };
      const timer = setTimeout(() => {
        this.#waiting.delete(look);
        reject(new Error(`waited ${LONG / 1000} s for ${what} ${JSON.stringify(state())}`));
      }, LONG);
      this.#waiting.add(look);
      look();
    });
  }

  /** Waits until the joints stand still. @returns {Promise<number[]>} where */
  async standing() {
    const still = 12; // frames
    let [before, count, number] = [null, 0, -1];
    return this.until('the arm to stand', () => {
      const { qpos, number: now } = this.frame;
      if (now === number) return null;
      number = now;
      const moved = before === null || qpos.some((q, i) => Math.abs(q - before[i]) > 2e-5);
      count = moved ? 0 : count + 1;
      before = qpos;
      return count >= still ? qpos : null;
    });
  }

  #take(data, isBinary) {
    if (isBinary) {
      this.frame = readFrame(data, this.#scene.bodies.length);
    } else {
      const message = JSON.parse(data);
      this.latest[message.type] = message;
    }
    for (const look of [...this.#waiting]) look();
  }
}

function readFrame(data, bodies) {
  const numbers = Array.from({ length: (data.length - HEAD) / 4 }, (_, i) => data.readFloatLE(HEAD + 4 * i));
  return {
    paused: (data[1] & 1) !== 0,
    number: data.readUInt32LE(4),
    time: data.readDoubleLE(8),
    bodies: Array.from({ length: bodies }, (_, i) => numbers.slice(7 * i, 7 * i + 7)),
    qpos: numbers.slice(7 * bodies),
  };
}
