// The target of the tool: shown as the server says, dragged by its handles.
import { Quaternion, Vector3 } from 'three';
import { GizmoShapes } from './gizmo_shapes.js';
import { handleAt, handles } from './gizmo_handles.js';
import { startDrag } from './gizmo_drag.js';

const SIZE = 0.17; // of the height of the picture
const SMALLEST = 78; // [pixels]
const LARGEST = 130; // [pixels]
const NEAR = { mouse: 9, pen: 12, touch: 22 }; // [pixels]

export class Target {
  shown = false;
  p = new Vector3();
  q = new Quaternion();
  rgba = [0.3, 0.8, 0.4, 1];
  number = 0; // of the last drag
  #axes = null;
  #turns = true;
  #shapes = new GizmoShapes();
  #hovered = null;
  #drag = null;
  #stage;
  #eye;
  #picker;
  #outbox;
  #readout;
  enabled = true;

  /** @param {import('./readout.js').Readout} readout  says how far it was dragged */
  constructor({ stage, eye, picker, outbox, readout, turns }) {
    this.#stage = stage;
    this.#eye = eye;
    this.#picker = picker;
    this.#outbox = outbox;
    this.#readout = readout;
    this.#turns = turns;
    stage.front.add(this.#shapes.group);
  }

  get held() {
    return this.#drag !== null;
  }

  /** A connection begins: the next message says where the numbers stand. */
  renew() {
    this.release();
    this.number = 0;
  }

  /** What the server says about it: an answer to an older drag does not move it. */
  take(message) {
    this.shown = message.shown;
    this.rgba = message.rgba;
    this.#turns = message.turns;
    if (!message.shown) this.release();
    const late = message.number < this.number;
    if (!this.#drag) {
      this.#axes = message.axes;
      this.number = Math.max(this.number, message.number);
    }
    if (!late && !this.#drag) {
      const [w, x, y, z] = message.quat;
      this.p.set(...message.pos);
      this.q.set(x, y, z, w);
    }
    this.#stage.changed();
  }

  /** Before each picture. */
  update() {
    this.#shapes.group.visible = this.shown;
    if (!this.shown) return;
    const bright = this.#drag ? { ...this.#drag.handle, held: true } : this.#hovered;
    const sight = this.p.clone().sub(this.#eye.position).normalize();
    this.#shapes.update(
      { p: this.p, axes: this.#directions(), size: this.#size(), rgba: this.rgba, turns: this.#turns },
      bright, sight,
    );
  }

  // A tool of the pointer.

  hover(pointer) {
    const found = this.#find(pointer)?.handle ?? null;
    if (found?.kind !== this.#hovered?.kind || found?.axis !== this.#hovered?.axis) this.#stage.changed();
    this.#hovered = found;
    return found ? 'grab' : null;
  }

  begin(pointer) {
    if (pointer.button !== 0 || pointer.ctrl) return false;
    const found = this.#find(pointer);
    if (!found) return false;
    const ray = this.#picker.ray(pointer.x, pointer.y);
    const pose = { p: this.p, q: this.q };
    const rule = startDrag(found.handle, pose, this.#directions(), this.#eye, ray, found.point);
    this.#drag = { handle: found.handle, rule };
    this.#stage.changed();
    return true;
  }

  move(pointer) {
    if (!this.#drag) return;
    const { p, q, amount } = this.#drag.rule.move(this.#picker.ray(pointer.x, pointer.y));
    this.p.copy(p);
    this.q.copy(q);
    this.#readout.show(pointer, amountText(this.#drag.handle, amount));
    this.#tell(true);
    this.#stage.changed();
  }

  end() {
    this.release();
  }

  /** Lets go. */
  release() {
    if (!this.#drag) return;
    this.#drag = null;
    this.#hovered = null;
    this.#readout.hide();
    this.#tell(false);
    this.#stage.changed();
  }

  /** Pixel of the canvas where a point of an arrow is seen. */
  handlePixel(axis, share) {
    return this.#eye.project(this.p.clone().addScaledVector(this.#directions()[axis], share * this.#size()));
  }

  #tell(held) {
    const { p, q } = this;
    this.number += 1;
    const message = {
      type: 'drag', pos: p.toArray(), quat: [q.w, q.x, q.y, q.z], held, number: this.number,
    };
    if (held) {
      this.#outbox.sendLatest('drag', message);
    } else {
      this.#outbox.drop('drag');
      this.#outbox.send(message);
    }
  }

  #find({ x, y, type }) {
    if (!this.shown || !this.enabled || this.#eye.depth(this.p) <= 0) return null;
    const target = { middle: this.p, axes: this.#directions(), size: this.#size() };
    return handleAt(handles(this.#turns), target, this.#eye, { x, y }, NEAR[type] ?? NEAR.mouse);
  }

  /** [m] length of the arrows. */
  #size() {
    const pixels = Math.max(SMALLEST, Math.min(LARGEST, SIZE * this.#stage.height));
    return pixels * this.#eye.metresPerPixel(this.p);
  }

  #directions() {
    const m = this.#axes; // rows; the directions are its columns
    if (m) return [0, 1, 2].map((k) => new Vector3(m[k], m[k + 3], m[k + 6]));
    return [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)].map((v) => v.applyQuaternion(this.q));
  }
}

function amountText(handle, amount) {
  if (handle.kind === 'ring') return `${((amount * 180) / Math.PI).toFixed(1)}°`;
  return `${(1000 * amount).toFixed(0)} mm`;
}
