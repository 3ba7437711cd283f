// The kinematics of an arm in the page itself: that of the rooms core to path, compiled to WebAssembly
// (web/ik/). Knows neither a server nor what is drawn.

/**
 * x y z [m], w x y z of a unit quaternion: a frame in the world.
 * @typedef {number[]} Pose7
 */

/**
 * Why a pose has no answer.
 * @typedef {object} Failure
 * @property {string} reason  out_of_reach, inner_void, joint_limit, too_far, no_convergence, bad_input
 * @property {number} amount  how far beyond: [m] for reach and void, [rad or m] for a joint
 * @property {number} bound   [m] the radius that is broken, else 0
 * @property {number} joint   which joint, for joint_limit and too_far; else -1
 * @property {Answer} best    the closest attempt
 * @property {string} text    one line for people
 */

/**
 * @typedef {object} Answer
 * @property {number[]} q     [rad or m] of each joint, within the limits
 * @property {number} posErr  [m]
 * @property {number} rotErr  [rad]
 */

/**
 * How the target that is dragged stands, as a window and the page of a server show it.
 * @typedef {object} TargetState
 * @property {Pose7} pose        X_WT as it was asked for
 * @property {number[]} goal     [rad or m] where the arm shall go: as near to it as it gets
 * @property {string} grade      good, near_limit, near_singular, jump, unreachable
 * @property {boolean} reached
 * @property {number} room       [rad or m] from the goal to the nearest limit; Infinity without any
 * @property {number} tightest   the joint it belongs to
 * @property {number} smallest   smallest singular value at the goal
 * @property {string} singular   none, shoulder, elbow, wrist, other
 * @property {number[]|null} jump  the answer that needs a jump, where there is only that one
 * @property {Failure|null} failure
 * @property {string} text       one line for people
 */

const REASONS = 0; // lists of words of the module
const KINDS = 1;
const GRADES = 2;
const FRAMES = ['world', 'tool', 'base'];
const ROOM = 4608; // numbers that the module takes at once

const NO_SYSTEM = 52; // ENOSYS of WASI

/** The few calls of a system that its libraries may make, as for the environment: there is none. */
function imports(module) {
  const out = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    out[from] ??= {};
    out[from][name] = () => NO_SYSTEM;
  }
  return out;
}

export class ArmIk {
  #calls;
  #dof;
  #bodies;

  /**
   * @param {BufferSource} bytes  of ik.wasm
   * @param {object} arm  as arm_json() writes it
   * @param {string} language  en or zh, of all lines for people
   */
  static async load(bytes, arm, language = 'en') {
    const module = await WebAssembly.compile(bytes);
    const instance = await WebAssembly.instantiate(module, imports(module));
    return new ArmIk(instance.exports, arm, language);
  }

  constructor(calls, arm, language) {
    this.#calls = calls;
    this.#dof = arm.joints.length;
    this.#bodies = (arm.bodies ?? []).map(([body]) => body);
    calls._initialize();
    this.setLanguage(language);
    this.#setArm(arm);
  }

  /** Of each joint. */
  get dof() {
    return this.#dof;
  }

  /** Whether the target has an orientation: fewer than six joints take the position alone. */
  get turns() {
    return this.#calls.target_turns() !== 0;
  }

  setLanguage(language) {
    this.#writeText(language);
    this.#calls.set_language();
  }

  /**
   * Where tool and links are.
   * @param {number[]} q  [rad or m]
   * @returns {{tool: Pose7, joints: Pose7[]}} joints: the frame of each, moved by it
   */
  fk(q) {
    this.#write(q);
    this.#calls.fk();
    const out = this.#reader();
    return { tool: out.take(7), joints: Array.from({ length: this.#dof }, () => out.take(7)) };
  }

  /**
   * Where the bodies of the model are that the arm moves; those of a gripper as they stood at first.
   * @param {number[]} q  [rad or m]
   * @returns {number[][]} [body, x, y, z, qw, qx, qy, qz] of each, as in the ghost of an overlay
   */
  bodies(q) {
    this.#write(q);
    this.#calls.bodies();
    const out = this.#reader();
    return this.#bodies.map((body) => [body, ...out.take(7)]);
  }

  /**
   * The answer next to `seed`, from whatever branch.
   * @param {Pose7} pose
   * @param {number[]} seed  [rad or m]
   * @returns {{answer: Answer|null, failure: Failure|null}}
   */
  solve(pose, seed) {
    this.#write([...pose, ...seed]);
    const solved = this.#calls.solve() !== 0;
    const out = this.#reader();
    return { answer: solved ? this.#answer(out) : null, failure: solved ? null : this.#failure(out) };
  }

  /**
   * All answers, the one next to `seed` first; samples of them where there is no end of them.
   * @returns {{answers: Answer[], failure: Failure|null}}
   */
  solveAll(pose, seed) {
    this.#write([...pose, ...seed]);
    const length = this.#calls.solve_all();
    const out = this.#reader();
    return {
      answers: Array.from({ length }, () => this.#answer(out)),
      failure: length > 0 ? null : this.#failure(out),
    };
  }

  /** @returns {TargetState} */
  target() {
    this.#calls.target_state();
    return this.#state();
  }

  /** The target is where the tool is at `q`. @returns {TargetState} */
  setGoal(q) {
    this.#write(q);
    this.#calls.target_set_goal();
    return this.#state();
  }

  /**
   * Leads the target there, as straight as can be; the joints never jump.
   * @param {Pose7} pose
   * @returns {TargetState}
   */
  moveTo(pose) {
    this.#write(pose);
    this.#calls.target_move_to();
    return this.#state();
  }

  /**
   * Moves the target along (axis 0 to 2, [m]) or turns it about (3 to 5, [rad]) an axis.
   * @param {'world'|'tool'|'base'} frame
   * @returns {TargetState} as it was where that cannot be reached
   */
  jog(frame, axis, amount) {
    this.#calls.target_jog(FRAMES.indexOf(frame), axis, amount);
    return this.#state();
  }

  /** Takes the answer that needs a jump. @returns {TargetState} */
  takeJump() {
    this.#calls.target_take_jump();
    return this.#state();
  }

  /** Orientation of a frame to jog along, w x y z. @param {'world'|'tool'|'base'} frame */
  axes(frame) {
    this.#calls.target_axes(FRAMES.indexOf(frame));
    return this.#reader().take(7).slice(3);
  }

  #setArm(arm) {
    const numbers = arm.joints.flatMap((joint) => [
      joint.type === 'slide' ? 1 : 0, ...joint.X_PJ, ...joint.axis,
      joint.lower ?? -Infinity, joint.upper ?? Infinity,
    ]);
    this.#writeText([arm.name, ...arm.joints.map(({ name }) => name)].join('\n'));
    this.#write([...numbers, ...arm.X_JT, ...arm.home]);
    if (!this.#calls.make_arm(this.#dof)) throw new Error('not an arm');
    this.#write((arm.bodies ?? []).flatMap(([, ...place]) => place));
    this.#calls.set_bodies(this.#bodies.length);
  }

  #answer(out) {
    return { q: out.take(this.#dof), posErr: out.next(), rotErr: out.next() };
  }

  /** Its line is the last text that came. */
  #failure(out) {
    const [code, amount, bound, joint] = out.take(4);
    const best = this.#answer(out);
    const text = this.#text();
    return { reason: this.#word(REASONS, code), amount, bound, joint, best, text };
  }

  #state() {
    const out = this.#reader();
    const text = this.#text();
    const pose = out.take(7);
    const goal = out.take(this.#dof);
    const [grade, room, tightest, smallest, kind, jumps] = out.take(6);
    const jump = out.take(this.#dof);
    const fails = out.next() !== 0;
    const failure = this.#failure(out);
    const word = this.#word(GRADES, grade);
    return {
      pose, goal, grade: word, reached: word !== 'jump' && word !== 'unreachable', room, tightest,
      smallest, singular: this.#word(KINDS, kind), jump: jumps ? jump : null,
      failure: fails ? { ...failure, text } : null, text,
    };
  }

  #word(list, index) {
    this.#calls.word(list, index);
    return this.#text();
  }

  // The memory of the module may have moved with every call.

  #numbers() {
    return new Float64Array(this.#calls.memory.buffer, this.#calls.numbers(), ROOM);
  }

  #write(values) {
    if (values.length > ROOM) throw new Error(`${values.length} numbers are too many`);
    this.#numbers().set(values);
  }

  #reader() {
    const numbers = this.#numbers().slice();
    let at = 0;
    return {
      next: () => numbers[at++],
      take: (count) => Array.from(numbers.subarray(at, (at += count))),
    };
  }

  #writeText(text) {
    const bytes = new TextEncoder().encode(text);
    const at = this.#calls.make_text(bytes.length);
    new Uint8Array(this.#calls.memory.buffer, at, bytes.length).set(bytes);
  }

  #text() {
    const at = this.#calls.text();
    const bytes = new Uint8Array(this.#calls.memory.buffer, at, this.#calls.text_bytes());
    return new TextDecoder().decode(bytes);
  }
}
