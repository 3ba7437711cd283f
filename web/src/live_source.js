// A running `mjarm serve`: scene and meshes by HTTP, the rest over one WebSocket.
import { Emitter } from './emitter.js';
import { readFrame } from './frame.js';

const FIRST_PAUSE = 250; // [ms]
const LONGEST_PAUSE = 3000; // [ms]
const TEXTS = new Set(['hello', 'overlay', 'plots', 'panels', 'status', 'target', 'error', 'bye']);

/** Is a {@link import('./source.js').Source}. */
export class LiveSource extends Emitter {
  /** @type {import('./source.js').Connection} */
  connection = 'connecting';
  #base;
  #sceneText = '';
  #scene = null;
  #socket = null;
  #frame = null;
  #pause = FIRST_PAUSE;
  #timer = 0;
  #started = false;
  #wake = null;

  /** @param {URL} base  of the page: the folder with the token */
  constructor(base) {
    super();
    this.#base = base;
  }

  async scene() {
    for (;;) {
      try {
        this.#sceneText = await this.#fetchScene();
        this.#scene = JSON.parse(this.#sceneText);
        this.#pause = FIRST_PAUSE;
        return this.#scene;
      } catch {
        this.#setConnection('lost');
        await this.#sleep();
      }
    }
  }

  async mesh(index) {
    const answer = await fetch(new URL(`mesh/${index}`, this.#base));
    if (!answer.ok) throw new Error(`mesh ${index}: ${answer.status}`);
    return answer.arrayBuffer();
  }

  start() {
    this.#started = true;
    this.#connect();
  }

  retry() {
    this.#pause = FIRST_PAUSE;
    this.#wake?.();
  }

  takeFrame() {
    const bytes = this.#frame;
    this.#frame = null;
    return bytes && readFrame(bytes, this.#scene.bodies.length, this.#scene.nq);
  }

  send(message) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  #setConnection(connection) {
    if (connection === this.connection) return;
    this.connection = connection;
    this.emit('connection', connection);
  }

  async #fetchScene() {
    const answer = await fetch(new URL('scene.json', this.#base), { cache: 'no-cache' });
    if (!answer.ok) throw new Error(`scene.json: ${answer.status}`);
    return answer.text();
  }

  /** Waits for the pause, which is longer the next time, or until `retry`; for that alone once the run is over. */
  #sleep() {
    return new Promise((resolve) => {
      const done = () => {
        clearTimeout(this.#timer);
        this.#wake = null;
        resolve();
      };
      this.#wake = done;
      if (this.connection !== 'over') this.#timer = setTimeout(done, this.#pause);
      this.#pause = Math.min(2 * this.#pause, LONGEST_PAUSE);
    });
  }

  #connect() {
    const address = new URL('live', this.#base);
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.addEventListener('message', (event) => this.#take(event.data));
    socket.addEventListener('close', () => this.#lost(socket));
    this.#socket = socket;
  }

  #take(data) {
    if (data instanceof ArrayBuffer) {
      this.#frame = data; // an older one that nobody took is gone
      return;
    }
    const message = JSON.parse(data);
    if (message.type === 'hello') {
      this.#pause = FIRST_PAUSE;
      this.#setConnection('open');
    }
    if (message.type === 'bye') this.#setConnection('over');
    if (TEXTS.has(message.type)) this.emit(message.type, message);
  }

  async #lost(socket) {
    if (socket !== this.#socket) return;
    this.#socket = null;
    if (!this.#started) return;
    if (this.connection !== 'over') this.#setConnection('lost');
    for (;;) {
      await this.#sleep();
      try {
        const text = await this.#fetchScene();
        if (text !== this.#sceneText) {
          this.emit('replaced', null);
          return;
        }
        this.#connect();
        return;
      } catch {
        // Still away.
      }
    }
  }
}
