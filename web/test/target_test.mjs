// The target of the tool: dragged with the mouse, by its handles.
import { ok } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { toScene } from './browser.mjs';
import { askMjarm } from './program.mjs';

const MILLIMETRE = 0.001; // [m]
const HOLD = 0.7; // of the length of an arrow: where it is taken hold of
const RING = 0.74; // radius of the rings in lengths of the arrows

/** @param {import('./session.mjs').Session} session  with the UR5e */
export function testTarget(session) {
  beforeEach(async () => {
    await session.begin();
    await session.witness.standing();
  });

  const handle = async (axis, share) => {
    const { x, y } = await session.page.evaluate(([k, s]) => window.mjarm.handle(k, s), [axis, share]);
    return [x, y];
  };

  /** Waits until the program has heard of all that the mouse did. */
  async function heard() {
    const { witness, page } = session;
    await page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
    const number = await page.evaluate(() => window.mjarm.target.number);
    await witness.until('the program to hear of the drag', () => witness.target.number >= number);
  }

  /** Takes an arrow and moves the mouse along it until the program says that the target is there. */
  async function dragArrow(axis, goal) {
    const { witness, page } = session;
    const from = await handle(axis, HOLD);
    const ahead = [...witness.target.pos];
    const way = goal - ahead[axis];
    ahead[axis] = goal;
    const [a, b] = [await session.pixel(witness.target.pos), await session.pixel(ahead)];
    await page.mouse.move(...from);
    await page.mouse.down();
    let share = 1;
    const begin = witness.target.pos[axis];
    for (let i = 0; i < 8; ++i) {
      await page.mouse.move(from[0] + share * (b[0] - a[0]), from[1] + share * (b[1] - a[1]), { steps: 2 });
      await heard();
      const moved = witness.target.pos[axis] - begin;
      if (Math.abs(moved - way) < 0.3 * MILLIMETRE) break;
      share += (way - moved) / way;
    }
    await page.mouse.up();
    await heard();
  }

  test('dragged to a place within 1 mm; its ghost stands there, and after Go the tool does', async () => {
    const { witness, page } = session;
    await session.check('Follow', false);
    const stands = await witness.standing();
    const toolOf = ([x, y, z, ...quat]) => toLocal(quat, minus(witness.target.pos, [x, y, z]));
    const tool = toolOf(witness.frame.bodies[wrist()]); // in the last link
    const goal = plus(witness.target.pos, [0.09, -0.06, -0.08]);
    await toScene(page);
    for (let i = 0; i < 6; ++i) await page.keyboard.press('PageUp'); // nearer: a pixel is less than a millimetre
    for (const axis of [0, 1, 2]) await dragArrow(axis, goal[axis]);
    const { pos, quat, rgba } = witness.target;
    ok(distance(pos, goal) < MILLIMETRE, `the target is ${distance(pos, goal)} m away`);
    ok(rgba[1] > rgba[0], 'it is reachable');

    const ghost = witness.latest.overlay.items.find(({ kind }) => kind === 'ghost');
    const [, ...pose] = ghost.bodies.find(([body]) => body === wrist());
    const ofGhost = plus(pose.slice(0, 3), toWorld(pose.slice(3), tool));
    ok(distance(ofGhost, pos) < MILLIMETRE, `the ghost's tool is ${distance(ofGhost, pos)} m away`);
    ok(witness.frame.qpos.every((q, i) => Math.abs(q - stands[i]) < 1e-3), 'the arm waits');

    await session.panel('Go').click();
    await witness.until('the arm to leave', () => witness.frame.qpos.some((q, i) => Math.abs(q - stands[i]) > 0.02));
    const qpos = await witness.standing();
    const reached = await askMjarm('fk', '--robot', 'ur5e', `--q=${qpos.join(',')}`);
    ok(distance(reached.pos, pos) < MILLIMETRE, `the tool is ${distance(reached.pos, pos)} m away`);
    ok(angle(reached.quat, quat) < 0.01, `it is turned by ${angle(reached.quat, quat)} rad`);
  });

  test('every posture is a ghost, and the arm goes to the one that is clicked on', async () => {
    const { witness, page } = session;
    await session.check('All postures', true, 'Target');
    const isGhost = ({ kind, item }) => kind === 'ghost' && item >= 0;
    const ghosts = await witness.until('the ghosts', () => {
      const found = witness.latest.overlay.items.filter(isGhost);
      return found.length >= 3 ? found : null;
    });
    await page.waitForFunction((count) => window.mjarm.overlay.filter((kind) => kind === 'ghost').length >= count, ghosts.length);
    const elbow = witness.scene.bodies.indexOf('forearm_link');
    const placeOf = (ghost) => ghost.bodies.find(([body]) => body === elbow)?.slice(1, 4);
    const stands = witness.frame.bodies[elbow].slice(0, 3);
    const farthest = ghosts.filter(placeOf).sort((a, b) => distance(placeOf(b), stands) - distance(placeOf(a), stands))[0];
    await page.mouse.click(...await session.pixel(placeOf(farthest)));
    await witness.until('the arm to leave', () => distance(witness.frame.bodies[elbow].slice(0, 3), stands) > 0.1);
    await witness.standing();
    const there = witness.frame.bodies[elbow].slice(0, 3);
    const nearest = Math.min(...ghosts.filter(placeOf).map((ghost) => distance(placeOf(ghost), there)));
    ok(nearest < MILLIMETRE, `the elbow is ${nearest} m from where a ghost had it`);
    const reached = await askMjarm('fk', '--robot', 'ur5e', `--q=${witness.frame.qpos.join(',')}`);
    ok(distance(reached.pos, witness.target.pos) < MILLIMETRE, 'the tool is where it was');
    await session.check('All postures', false, 'Target');
    await witness.until('no ghosts', () => !witness.latest.overlay.items.some(isGhost));
  });

  test('the arm follows while the ball is held', async () => {
    const { witness, page } = session;
    const [x, y] = await session.pixel(witness.target.pos);
    const [begin, stands] = [witness.target.pos, witness.frame.qpos];
    await page.mouse.move(x, y);
    await page.mouse.down();
    // From before it moves: where drawing is slow the arm is there, and its ghost gone, before the mouse has stopped.
    const follows = () => witness.frame.qpos.some((q, i) => Math.abs(q - stands[i]) > 0.02);
    const followed = witness.until('the arm to follow its ghost', () => follows() && witness.overlay.includes('ghost'));
    await page.mouse.move(x + 30, y + 24, { steps: 6 });
    await heard();
    await followed;
    const [nowX, nowY] = await session.pixel(witness.target.pos);
    ok(Math.hypot(nowX - x - 30, nowY - y - 24) < 2, 'the ball is under the mouse');
    await page.mouse.up();
    await heard();
    ok(distance(witness.target.pos, begin) > 0.02);
    const reached = await askMjarm('fk', '--robot', 'ur5e', `--q=${(await witness.standing()).join(',')}`);
    ok(distance(reached.pos, witness.target.pos) < MILLIMETRE);
  });

  test('a ring turns it about its axis, where it is', async () => {
    const { witness, page } = session;
    const begin = witness.target;
    await session.control('view-top').click();
    const middle = await session.pixel(begin.pos);
    const share = -RING * Math.SQRT1_2; // between two axes, where nothing else is
    const from = plus(minus(await handle(0, share), middle), await handle(1, share));
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(from[0] - 25, from[1] - 25, { steps: 6 });
    await page.mouse.up();
    await heard();
    ok(distance(witness.target.pos, begin.pos) < 1e-6, 'it stays');
    ok(angle(witness.target.quat, begin.quat) > 0.1, 'it is turned');
    const upright = toWorld(begin.quat, [0, 0, 1]);
    ok(distance(toWorld(witness.target.quat, [0, 0, 1]), upright) < 1e-4, 'about z');
  });

  test('out of reach it is red, and the arm stays', async () => {
    const { witness, page } = session;
    const [x, y] = await handle(2, HOLD);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y - 250, { steps: 10 });
    await heard();
    await witness.until('red', () => witness.target.rgba[0] > 0.7 && witness.target.rgba[1] < 0.4, () => witness.target.rgba);
    await page.mouse.move(x, y, { steps: 4 });
    await page.mouse.up();
    await heard();
    await witness.until('green', () => witness.target.rgba[1] > witness.target.rgba[0], () => witness.target.rgba);
  });

  test('it is put away and shown by its button and a key', async () => {
    const { witness, page } = session;
    const isShown = (shown) => witness.until(`shown: ${shown}`, () => witness.target.shown === shown);
    await session.control('target').click();
    await isShown(false);
    await page.waitForFunction(() => !window.mjarm.target.shown);
    await toScene(page);
    await page.keyboard.press('t');
    await isShown(true);
  });

  function wrist() {
    return session.witness.scene.bodies.indexOf('wrist_3_link');
  }
}

const plus = (a, b) => a.map((x, i) => x + b[i]);
const minus = (a, b) => a.map((x, i) => x - b[i]);
const distance = (a, b) => Math.hypot(...minus(a, b));
const angle = (p, q) => 2 * Math.acos(Math.min(1, Math.abs(p.reduce((sum, x, i) => sum + x * q[i], 0))));

/** A vector turned by a unit quaternion (w, x, y, z). */
function toWorld([w, x, y, z], v) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const u = [x, y, z];
  const twice = cross(u, v).map((c) => 2 * c);
  return plus(plus(v, twice.map((c) => w * c)), cross(u, twice));
}

function toLocal([w, x, y, z], v) {
  return toWorld([w, -x, -y, -z], v);
}
