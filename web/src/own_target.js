// The target of the tool in a page that has no server: the arm is led by the kinematics in the page.
import { t } from './words.js';

const SHOWN = 10; // numbers of its panel items
const GO = 11;
const POSTURES = 12;
const POSTURE = 13;
const MOST_POSTURES = 8;
const SAME = 1e-3; // [rad or m]
const POSTURE_COLOR = [0.35, 0.5, 0.85, 0.16];
const COLORS = { good: [0.2, 0.75, 0.3, 1], unreachable: [0.9, 0.15, 0.12, 1] }; // as in a window
const BETWEEN = [0.98, 0.65, 0.08, 1];

export class OwnTarget {
  /** Where the arm was led by hand [rad or m]; null: it is where the recording has it. */
  q = null;
  #ik;
  #arm;
  #state;
  #shown = false;
  #number = 0;
  #postures = null; // null: not shown

  /** @param {import('./arm_ik.js').ArmIk} ik @param {object} arm  as the file has it */
  constructor(ik, arm) {
    this.#ik = ik;
    this.#arm = arm;
    this.#state = ik.target();
  }

  /** The arm is where the recording has it. @param {Float64Array|Float32Array} qpos */
  follow(qpos) {
    this.q = null;
    if (this.#shown) this.#take(this.#ik.setGoal(this.#arm.joints.map((joint) => qpos[joint.qpos])));
  }

  /** Does what the user asked for. @returns {boolean} whether it was about the arm */
  handle(message, qpos) {
    switch (message.type) {
      case 'target':
        this.#show(!this.#shown, qpos);
        return true;
      case 'drag':
        this.#number = message.number;
        if (this.#shown) this.#lead(this.#ik.moveTo([...message.pos, ...message.quat]));
        return true;
      case 'joint':
        this.#turn(message, qpos);
        return true;
      case 'panel':
        return this.#use(message, qpos);
      default:
        return false;
    }
  }

  /** See `target` of the protocol. */
  look() {
    const [x, y, z, ...quat] = this.#state.pose;
    return {
      type: 'target', shown: this.#shown, pos: [x, y, z], quat, axes: null,
      rgba: COLORS[this.#state.grade] ?? BETWEEN, number: this.#number, turns: this.#ik.turns,
    };
  }

  line() {
    return this.#shown ? this.#state.text : '';
  }

  /** The frame with the arm where it was led. @param {import('./source.js').Frame} frame */
  posed(frame) {
    if (!this.q) return frame;
    for (const [body, ...place] of this.#ik.bodies(this.q)) frame.bodies.set(place, 7 * body);
    this.#arm.joints.forEach((joint, index) => { frame.qpos[joint.qpos] = this.q[index]; });
    return frame;
  }

  /** The other postures, see `overlay` of the protocol. */
  ghosts() {
    return (this.#postures ?? []).flatMap((q, value) => (isSame(q, this.#state.goal) ? [] : [{
      kind: 'ghost', bodies: this.#ik.bodies(q), rgba: POSTURE_COLOR, item: POSTURE, value,
    }]));
  }

  /** See `panels` of the protocol. */
  section() {
    const on = this.#shown;
    const items = [
      { id: SHOWN, name: t('target'), enabled: true, kind: 'checkbox', on },
      { id: POSTURES, name: t('postures'), enabled: on, kind: 'checkbox', on: this.#postures !== null },
      { id: GO, name: t('go'), enabled: on && this.#state.jump !== null, kind: 'button' },
    ];
    if (this.#postures?.length) {
      const current = this.#postures.findIndex((q) => isSame(q, this.#state.goal));
      const lines = this.#postures.map((q) => q.map((value, index) => this.#shownValue(value, index)).join('  '));
      items.push({ id: POSTURE, name: t('postures'), enabled: true, kind: 'list', lines, current });
    }
    return { title: t('target'), open: true, items };
  }

  #shownValue(value, index) {
    return this.#arm.joints[index].type === 'slide' ? value.toFixed(3) : `${((value * 180) / Math.PI).toFixed(0)}°`;
  }

  #show(on, qpos) {
    this.#shown = on;
    this.#postures = null;
    if (!this.q) this.follow(qpos);
  }

  #turn({ dof, value }, qpos) {
    const index = this.#arm.joints.findIndex((joint) => joint.dof === dof);
    if (index < 0) return;
    const q = this.q ?? this.#arm.joints.map((joint) => qpos[joint.qpos]);
    q[index] = value;
    this.#lead(this.#ik.setGoal(Array.from(q)));
  }

  #use({ id, value }, qpos) {
    if (id === SHOWN) this.#show(value !== 0, qpos);
    else if (id === GO) this.#lead(this.#ik.takeJump());
    else if (id === POSTURES) {
      this.#postures = value !== 0 ? [] : null;
      this.#findPostures();
    } else if (id === POSTURE && this.#postures?.[value]) {
      const postures = this.#postures;
      this.#lead(this.#ik.setGoal(postures[value]));
    } else return false;
    return true;
  }

  #lead(state) {
    this.q = state.goal;
    this.#take(state);
  }

  #take(state) {
    this.#state = state;
    this.#findPostures();
  }

  #findPostures() {
    if (!this.#postures) return;
    const { answers } = this.#ik.solveAll(this.#state.pose, this.#state.goal);
    this.#postures = answers.slice(0, MOST_POSTURES).map(({ q }) => q);
  }
}

function isSame(a, b) {
  return a.every((value, index) => Math.abs(value - b[index]) < SAME);
}
