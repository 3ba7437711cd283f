// Pulling a body by a spring between a point of it and the pointer.
import { Plane, Quaternion, Vector3 } from 'three';
import { ArrowLine } from './arrow_line.js';

const HARDEST = 150; // [N/m]
const SOFTEST = 1; // [N/m]
const PER_KILOGRAM = 60; // [N/m/kg]
const STRONGEST = 100; // [N] times the stiffness by HARDEST

export class Push {
  enabled = true;
  #held = null;
  #line = new ArrowLine([1, 0.62, 0.24, 1]);
  #stage;
  #eye;
  #picker;
  #model;
  #outbox;
  #readout;

  constructor({ stage, eye, picker, model, outbox, readout }) {
    this.#stage = stage;
    this.#eye = eye;
    this.#picker = picker;
    this.#model = model;
    this.#outbox = outbox;
    this.#readout = readout;
    stage.front.add(this.#line.object);
  }

  get held() {
    return this.#held !== null;
  }

  // A tool of the pointer.

  hover(pointer) {
    return this.enabled && pointer.ctrl ? 'crosshair' : null;
  }

  begin(pointer) {
    if (!this.enabled || !(pointer.ctrl || pointer.long) || pointer.button !== 0) return false;
    const hit = this.#picker.geomAt(pointer.x, pointer.y);
    if (!hit || this.#model.massOf(hit.body) <= 0) return false;
    const { p, q } = this.#model.bodyPose(hit.body);
    const local = hit.point.clone().sub(p).applyQuaternion(q.clone().invert());
    const stiffness = Math.max(SOFTEST, Math.min(HARDEST, PER_KILOGRAM * this.#model.massOf(hit.body)));
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.#eye.forward, hit.point);
    this.#held = { body: hit.body, local, stiffness, plane, end: hit.point.clone(), pointer };
    this.#stage.changed();
    return true;
  }

  move(pointer) {
    if (!this.#held) return;
    this.#held.pointer = pointer;
    const met = this.#picker.ray(pointer.x, pointer.y).intersectPlane(this.#held.plane, new Vector3());
    if (met) this.#held.end.copy(met);
  }

  end() {
    if (!this.#held) return;
    this.#outbox.drop('push');
    this.#outbox.send({ type: 'release', body: this.#held.body });
    this.#held = null;
    this.#readout.hide();
    this.#line.object.visible = false;
    this.#stage.changed();
  }

  /** With each picture while something is held. */
  update() {
    if (!this.#held) return;
    const { body, local, stiffness, end, pointer } = this.#held;
    const { p, q } = this.#model.bodyPose(body);
    const point = local.clone().applyQuaternion(new Quaternion().copy(q)).add(p);
    const force = end.clone().sub(point).multiplyScalar(stiffness);
    force.clampLength(0, (STRONGEST * stiffness) / HARDEST + 1);
    this.#outbox.sendLatest('push', { type: 'push', body, point: point.toArray(), force: force.toArray() });
    this.#line.set(point, end, this.#eye.metresPerPixel(point));
    this.#readout.show(pointer, `${force.length().toFixed(force.length() < 10 ? 1 : 0)} N`);
    this.#stage.changed();
  }
}
