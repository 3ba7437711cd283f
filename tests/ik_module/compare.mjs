// Whether the module of the page answers as the program does, and how fast:
//
//     node compare.mjs MODULE CASES      (ik.wasm; what ik_module_cases wrote)
//
// Exit code 1, and a line for each question that is answered otherwise, at most 20.
//
// Compilers and sines round otherwise in the last bit. Where an answer is the only one (six joints) and
// not next to a singularity, that stays the last bits. Elsewhere the answers may be others that are
// as good: then both have to meet the pose, or to fail. In closed form that is rare with seven joints,
// too.
import { readFile } from 'node:fs/promises';
import { ArmIk } from '../../web/src/arm_ik.js';

// [rad, m] of joint values and errors; of what is larger than 1, its share. Branches of arms of any geometry are
// polished until they are as good as that.
const TOLERANCE = 1e-11;
const SINGULAR = 1e-2; // smallest singular value at an answer, below which the last bits count
const MET = 1e-7; // [rad, m] error of the pose of an answer, as IkOptions has it
const RARE = 0.05; // share of the questions
const GRADES = ['good', 'near_limit', 'near_singular', 'jump', 'unreachable'];

const [module, cases] = process.argv.slice(2);
const bytes = await readFile(module);
let faults = 0;

function fault(where, what) {
  faults += 1;
  if (faults <= 20) console.log(`${where}: ${what}`);
}

/** Largest difference of the numbers of two values; infinite where they differ in anything else. */
function difference(a, b) {
  if (typeof a === 'number' && typeof b === 'number') {
    return a === b ? 0 : Math.abs(a - b) / Math.max(1, Math.abs(a), Math.abs(b));
  }
  if (a === null || b === null || typeof a !== 'object' || typeof b !== 'object') {
    return a === b ? 0 : Infinity;
  }
  const keys = Object.keys(a);
  if (keys.length !== Object.keys(b).length) return Infinity;
  return keys.reduce((most, key) => Math.max(most, difference(a[key], b[key] ?? null)), 0);
}

/** Where that is, for people. */
function firstDifference(a, b, path = '') {
  if (a === null || b === null || typeof a !== 'object' || typeof b !== 'object') {
    return `${path} is ${JSON.stringify(a)}, not ${JSON.stringify(b)}`;
  }
  const key = Object.keys({ ...a, ...b }).find((k) => !(difference(a[k] ?? null, b[k] ?? null) <= TOLERANCE));
  return firstDifference(a[key] ?? null, b[key] ?? null, `${path}.${key}`);
}

/**
 * A part of the questions to an arm.
 * @param {object} part
 * @param {Function} part.ask    what the module answers to an entry
 * @param {Function} part.want   what the program answered
 * @param {Function} part.fixed  (entry) whether that is the only right answer
 * @param {number} part.rare     share of the answers that may be others
 * @param {Function} part.good   (answer, right) whether an answer is right where there are others
 */
function compare(name, list, { ask, want, fixed = () => true, good = () => false, rare = 1 }) {
  const start = process.cpuUsage();
  const answers = list.map(ask);
  const { user } = process.cpuUsage(start);
  let most = 0;
  let others = 0;
  list.forEach((entry, index) => {
    const right = want(entry);
    const off = difference(answers[index], right);
    if (off <= TOLERANCE) most = Math.max(most, off);
    else if (!fixed(entry) && good(answers[index], right)) others += 1;
    else fault(`${name} ${index}`, `off by ${off}: ${firstDifference(answers[index], right)}`);
  });
  if (others > rare * list.length) fault(name, `${others} answers are others`);
  const rate = (1e6 * list.length) / Math.max(user, 1);
  console.log(`${name}: ${list.length}, ${others} of them otherwise, else at most ${most.toPrecision(2)}; ` +
    `${rate.toPrecision(3)} a second of a processor`);
}

const meets = ({ posErr, rotErr }) => posErr <= MET && rotErr <= MET;

/** As the state of a target has it, its line says why. */
const failureOf = ({ failure, text }) => (failure ? { ...failure, text: text ?? failure.text } : null);

function stateOf(right) {
  return {
    pose: right.pose, goal: right.goal, grade: GRADES[right.grade], reached: right.grade < 3,
    room: right.room ?? Infinity, tightest: right.tightest, smallest: right.smallest,
    singular: right.singular, jump: right.jump ?? null, failure: failureOf(right), text: right.text,
  };
}

/** What a search met that had to fail is known to no more than the root of the last bit. */
const plain = (state) => (state.failure ? { ...state, failure: { ...state.failure, best: null, amount: 0 } } : state);

/** A drag is as the program has it until the way comes to where more than one answer is right. */
function compareDrags(ik, name, list, { alone, closed }) {
  const part = closed ? (state) => state : plain;
  let fixed = true;
  const marks = list.map(({ start, smallest }) => {
    if (start) fixed = alone;
    fixed &&= smallest > SINGULAR;
    return fixed;
  });
  compare(`${name} drags`, list.map((entry, index) => ({ ...entry, fixed: marks[index] })), {
    ask: ({ start, pose, takesJump }) => {
      if (start) ik.setGoal(start);
      const state = ik.moveTo(pose);
      return part(state.jump && takesJump ? ik.takeJump() : state);
    },
    want: (right) => part(stateOf(right)),
    fixed: (entry) => entry.fixed,
    good: ({ pose, goal, reached }) => !reached ||
      difference(ik.fk(goal).tool.slice(0, 3), pose.slice(0, 3)) < 10 * MET,
  });
}

for (const entry of JSON.parse(await readFile(cases, 'utf8'))) {
  const ik = await ArmIk.load(bytes, entry.arm);
  const name = `${entry.arm.name} (${ik.dof} joints)`;
  const fixed = ({ smallest }) => entry.alone && smallest > SINGULAR;
  compare(`${name} fk`, entry.fk, {
    ask: ({ q }) => ik.fk(q), want: ({ tool, joints }) => ({ tool, joints }),
  });
  compare(`${name} solve`, entry.solve, {
    ask: ({ pose, seed }) => ik.solve(pose, seed),
    want: (right) => ({ answer: right.answer ?? null, failure: failureOf(right) }),
    fixed,
    rare: entry.closed ? RARE : 1,
    good: ({ answer }, right) => (answer ? right.answer !== null && meets(answer) : right.answer === null),
  });
  compare(`${name} solveAll`, entry.solveAll, {
    ask: ({ pose, seed }) => ik.solveAll(pose, seed).answers, want: ({ answers }) => answers,
    fixed,
    good: (answers, right) => (answers.length > 0) === (right.length > 0) && answers.every(meets),
  });
  compareDrags(ik, name, entry.drags, entry);
  if (!entry.bodies) continue;
  compare(`${name} bodies`, ik.bodies(entry.bodiesAt), {
    ask: (body) => body, want: ([body]) => [body, ...entry.bodies[body]],
  });
}
if (faults > 0) console.log(`${faults} answers differ`);
process.exit(faults > 0 ? 1 : 0);
