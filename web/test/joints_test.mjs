// The sliders of the joints.
import { ok, strictEqual } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { dragMouse, pixelOf } from './browser.mjs';

const DEGREE = Math.PI / 180;
const NEAR = 0.4 * DEGREE; // what a held joint may sag

/** @param {import('./session.mjs').Session} session  with the UR5e */
export function testJoints(session) {
  beforeEach(() => session.begin());

  const slider = (joint) => session.control(`joint-${joint}-slider`);
  const field = (joint) => session.control(`joint-${joint}-value`);
  const isNear = (index, degrees) => session.witness.until(`joint ${index} at ${degrees} degrees`,
    () => Math.abs(session.witness.frame.qpos[index] - degrees * DEGREE) < NEAR,
    () => session.witness.frame.qpos[index] / DEGREE);

  test('a slider that is drawn moves its joint to where it says', async () => {
    const joint = slider('shoulder_pan_joint');
    const { lower, upper } = session.witness.scene.options.joints[0];
    const from = (session.witness.frame.qpos[0] - lower) / (upper - lower);
    const to = from + 0.07;
    await dragMouse(session.page, [await pixelOf(joint, from), await pixelOf(joint, to)]);
    const shown = Number(await field('shoulder_pan_joint').inputValue());
    ok(Math.abs(shown * DEGREE - (lower + to * (upper - lower))) < 0.2, `it shows ${shown} degrees`);
    await isNear(0, shown);
  });

  test('keys move a slider by one degree, with Shift by ten', async () => {
    let [, , degrees] = (await session.witness.standing()).map((q) => q / DEGREE);
    await slider('elbow_joint').focus();
    for (const [key, way] of [['ArrowRight', 1], ['ArrowUp', 1], ['Shift+ArrowLeft', -10], ['ArrowDown', -1]]) {
      await session.page.keyboard.press(key);
      degrees += way;
      await isNear(2, degrees);
      await session.witness.standing();
    }
  });

  test('each joint goes where its field says', async () => {
    const { joints } = session.witness.scene.options;
    strictEqual(joints.length, 6);
    const wanted = [-80, -80, 80, -100, -75, 20];
    for (const [index, { name }] of joints.entries()) {
      await field(name).fill(String(wanted[index]).replace('80', '80,0'));
      await field(name).press('Enter');
    }
    for (const [index, { qpos }] of joints.entries()) await isNear(qpos, wanted[index]);
    await field('wrist_3_joint').press('ArrowUp');
    await field('wrist_3_joint').press('Shift+ArrowDown');
    await isNear(5, 11);
  });

  test('what is no number is marked and moves nothing; what is too large ends at the stop', async () => {
    const { witness } = session;
    const begin = await witness.standing();
    await field('elbow_joint').fill('1e');
    await field('elbow_joint').press('Enter');
    strictEqual(await field('elbow_joint').getAttribute('aria-invalid'), 'true');
    const later = await witness.standing();
    ok(Math.abs(later[2] - begin[2]) < 1e-3);
    await field('elbow_joint').press('Escape');
    await field('wrist_1_joint').fill('1000');
    await field('wrist_1_joint').press('Enter');
    await isNear(3, 360);
  });
}
