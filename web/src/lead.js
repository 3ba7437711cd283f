// Leads the arm: keys that are held, a gamepad, and two pads under the thumbs.
import { byTest, el } from './dom.js';
import { fill } from './words.js';

const EVERY = 100; // [ms] what is held is said again
const DEAD_ZONE = 0.125; // of a stick's way
const SLOW = 0.25; // with Shift
const AXES = 7; // three along, three about x y z, the gripper

/** Keys by their place on the keyboard: axis and way. */
const KEYS = {
  KeyW: [0, 1], KeyS: [0, -1], KeyA: [1, 1], KeyD: [1, -1], KeyQ: [2, 1], KeyE: [2, -1],
  KeyJ: [3, 1], KeyL: [3, -1], ArrowUp: [4, 1], ArrowDown: [4, -1], ArrowLeft: [5, 1], ArrowRight: [5, -1],
  KeyG: [6, 1], KeyH: [6, -1],
};

export class Lead {
  #outbox;
  #held = new Set();
  #slow = false;
  #pads = {};
  #enabled = false;
  #said = new Array(AXES).fill(0);
  #next = 0;

  /** @param {object} outbox @param {boolean} wanted  the program follows */
  constructor(outbox, wanted) {
    this.#outbox = outbox;
    this.wanted = wanted;
    if (!wanted) return;
    this.#makePads();
    // Pictures may be slow; who says nothing has let go.
    setInterval(() => this.update(performance.now()), EVERY / 2);
    // Before the keys of the page: here they lead.
    document.addEventListener('keydown', (event) => this.#onKey(event, true), true);
    document.addEventListener('keyup', (event) => this.#onKey(event, false), true);
    window.addEventListener('blur', () => this.release());
    document.addEventListener('visibilitychange', () => this.release());
  }

  /** Whether there is somebody who follows. */
  set enabled(on) {
    this.#enabled = on && this.wanted;
    if (!on) this.release();
  }

  /** What is asked for now: three along, three about the axes, the gripper. @returns {number[]} */
  get hand() {
    const out = new Array(AXES).fill(0);
    for (const code of this.#held) {
      const [axis, way] = KEYS[code];
      out[axis] += (this.#slow && axis < 6 ? SLOW : 1) * way;
    }
    for (const { axes, x, y } of Object.values(this.#pads)) {
      out[axes[0]] += ofStick(y);
      out[axes[1]] += ofStick(x);
    }
    const pad = [...navigator.getGamepads()].find((one) => one?.mapping === 'standard');
    if (pad) addGamepad(pad, out);
    return out.map((value) => Math.max(-1, Math.min(1, value)));
  }

  /** Lets all go. */
  release() {
    this.#held.clear();
    for (const pad of Object.values(this.#pads)) pad.letGo();
  }

  /** Once a picture, and in between. @param {number} now  [ms] */
  update(now) {
    if (!this.#enabled) return;
    const hand = this.hand;
    const same = hand.every((value, i) => value === this.#said[i]);
    if (same && (now < this.#next || hand.every((value) => value === 0))) return;
    this.#said = hand;
    this.#next = now + EVERY;
    this.#outbox.send({ type: 'lead', linear: hand.slice(0, 3), angular: hand.slice(3, 6), grip: hand[6] });
  }

  #onKey(event, down) {
    this.#slow = event.shiftKey;
    if (!(event.code in KEYS)) return;
    if (!down) this.#held.delete(event.code);
    if (!down || event.ctrlKey || event.metaKey || event.altKey || !this.#enabled) return;
    if (event.target.closest?.('input:not([type=checkbox]):not([type=range]), select, textarea, dialog')) return;
    event.preventDefault();
    this.#held.add(event.code);
    this.update(performance.now());
  }

  #makePads() {
    const row = el('div', { class: 'lead', test: 'lead' });
    this.#pads.left = new Pad('lead-left', 'lead_flat', [0, 1]);
    this.#pads.right = new Pad('lead-right', 'lead_high', [2, 5]);
    const button = (test, word, code) => el('button', {
      type: 'button', test, word, on: {
        pointerdown: (event) => {
          event.target.setPointerCapture(event.pointerId);
          this.#held.add(code);
        },
        pointerup: () => this.#held.delete(code),
        pointercancel: () => this.#held.delete(code),
      },
    });
    const grip = el('div', { class: 'lead-grip' },
      button('lead-close', 'lead_close', 'KeyG'), button('lead-open', 'lead_open', 'KeyH'));
    row.append(this.#pads.left.node, grip, this.#pads.right.node);
    fill(row);
    byTest('view').append(row);
  }
}

/** A stick under a thumb: where the finger is, from its middle; up and left are positive. */
class Pad {
  x = 0;
  y = 0;
  #finger = null;

  constructor(test, word, axes) {
    this.axes = axes;
    this.knob = el('span', { class: 'lead-knob' });
    this.node = el('div', {
      class: 'lead-pad', role: 'application', test, wordLabel: word, on: {
        pointerdown: (event) => this.#take(event),
        pointermove: (event) => event.pointerId === this.#finger && this.#move(event),
        pointerup: () => this.letGo(),
        pointercancel: () => this.letGo(),
      },
    }, this.knob);
  }

  letGo() {
    this.#finger = null;
    this.#show(0, 0);
  }

  #take(event) {
    event.preventDefault();
    this.node.setPointerCapture(event.pointerId);
    this.#finger = event.pointerId;
    this.#move(event);
  }

  #move(event) {
    const box = this.node.getBoundingClientRect();
    const of = (value, low, size) => Math.max(-1, Math.min(1, (value - low) / (size / 2) - 1));
    this.#show(-of(event.clientX, box.left, box.width), -of(event.clientY, box.top, box.height));
  }

  #show(x, y) {
    this.x = x;
    this.y = y;
    this.knob.style.transform = `translate(${-36 * x}px, ${-36 * y}px)`;
  }
}

function ofStick(value) {
  const way = Math.max(0, (Math.abs(value) - DEAD_ZONE) / (1 - DEAD_ZONE));
  return Math.sign(value) * way * way;
}

/** Sticks, cross, bumpers and triggers as in the window of the program. */
function addGamepad({ axes, buttons }, out) {
  const between = (plus, minus) => (buttons[plus]?.value ?? 0) - (buttons[minus]?.value ?? 0);
  out[0] += ofStick(-axes[1]);
  out[1] += ofStick(-axes[0]);
  out[2] += ofStick(-axes[3]);
  out[3] += between(4, 5);
  out[4] += between(12, 13);
  out[5] += ofStick(-axes[2]);
  out[6] += between(7, 6);
}
