// What the user does goes to the source; what comes in floods goes once a picture, the latest wins.

export class Outbox {
  #source;
  #latest = new Map();

  /** @param {import('./source.js').Source} source */
  constructor(source) {
    this.#source = source;
  }

  /** At once. */
  send(message) {
    return this.#source.send(message);
  }

  /** With the next picture. @param {string} key  of those of which only the last one counts */
  sendLatest(key, message) {
    this.#latest.set(key, message);
  }

  /** Forgets what waits under this key. */
  drop(key) {
    this.#latest.delete(key);
  }

  flush() {
    for (const message of this.#latest.values()) this.#source.send(message);
    this.#latest.clear();
  }
}
