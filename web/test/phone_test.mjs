// A phone: fingers, and what has no room beside the scene.
import { ok, strictEqual } from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { byTest, openPage, pixelOf, untilPage } from './browser.mjs';
import { Session } from './session.mjs';

const LONG_PRESS = 700; // [ms]

/** @param {import('./session.mjs').Session} robot  with the UR5e */
export function testPhone(robot) {
  const session = new Session();
  let fingers;

  before(async () => {
    const { program, witness } = robot;
    const look = { size: [390, 844], theme: 'dark', phone: true, settings: { language: 'zh' } };
    const page = await openPage(program.url, look);
    Object.assign(session, { program, witness, page });
    fingers = await page.context().newCDPSession(page);
  });
  beforeEach(() => session.begin());
  after(() => session.page.context().close());

  const touch = (type, ...points) => fingers.send('Input.dispatchTouchEvent', {
    type, touchPoints: points.map(([x, y], id) => ({ x, y, id })),
  });
  /** Fingers that go from some places to others, all at once. */
  async function slide(from, to, held = async () => {}) {
    await touch('touchStart', ...from);
    const at = (share) => from.map(([x, y], i) => [x + share * (to[i][0] - x), y + share * (to[i][1] - y)]);
    for (const share of [0.2, 0.4, 0.6, 0.8, 1]) await touch('touchMove', ...at(share));
    await held();
    await touch('touchEnd');
  }
  const camera = () => session.page.evaluate(() => window.mjarm.camera);

  test('is in Chinese and dark, and nothing is wider than it', async () => {
    const { page } = session;
    strictEqual(await byTest(page, 'view-front').textContent(), '正面');
    strictEqual(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
    ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
  });

  test('a finger drags the target', async () => {
    const { witness, page } = session;
    await witness.standing();
    const begin = witness.target.pos;
    const { x, y } = await page.evaluate(() => window.mjarm.handle(0));
    await slide([[x, y]], [[x + 40, y + 10]], () => witness.until('the target to move',
      () => Math.abs(witness.target.pos[0] - begin[0]) > 0.01, () => witness.target.pos));
    ok([1, 2].every((axis) => Math.abs(witness.target.pos[axis] - begin[axis]) < 1e-6), 'along its axis alone');
  });

  test('one finger turns the view, two come nearer', async () => {
    const first = await camera();
    await slide([[60, 330]], [[110, 330]]);
    const turned = await camera();
    ok(turned.azimuth !== first.azimuth && turned.distance === first.distance);
    await slide([[150, 250], [200, 250]], [[110, 250], [240, 250]]);
    ok((await camera()).distance < 0.8 * turned.distance);
  });

  test('a long press pulls at the arm', async () => {
    const { witness, page } = session;
    await session.check('Target', false, 'Target');
    const begin = await witness.standing();
    const away = () => Math.max(...witness.frame.qpos.map((q, i) => Math.abs(q - begin[i])));
    const link = witness.scene.bodies.indexOf('wrist_1_link');
    const [x, y] = await session.pixel(witness.frame.bodies[link].slice(0, 3));
    await touch('touchStart', [x, y]);
    await page.waitForTimeout(LONG_PRESS);
    for (const share of [0.3, 0.6, 1]) await touch('touchMove', [x - 70 * share, y - 60 * share]);
    await witness.until('the arm to give way', () => away() > 0.004, away);
    await touch('touchEnd');
    await witness.until('the arm to come back', () => away() < 0.001, away);
  });

  test('a finger draws a slider', async () => {
    const { witness, page } = session;
    const { lower, upper } = witness.scene.options.joints[0];
    const slider = byTest(page, 'joint-shoulder_pan_joint-slider');
    const share = (witness.frame.qpos[0] - lower) / (upper - lower);
    await slide([await pixelOf(slider, share)], [await pixelOf(slider, share + 0.1)]);
    const wanted = lower + (share + 0.1) * (upper - lower);
    const now = () => witness.frame.qpos[0];
    await witness.until('the joint to turn', () => Math.abs(now() - wanted) < 0.15, now);
  });

  test('panels and plots share a sheet, which is drawn up and put away', async () => {
    const { page } = session;
    const isHigh = (low, high) => untilPage(page, ([from, to]) => {
      const { bottom } = document.querySelector('[data-test="sheet-head"]').getBoundingClientRect();
      const share = 1 - bottom / window.innerHeight;
      return share > from && share < to;
    }, [low, high]);
    await byTest(page, 'tab-plots').tap();
    ok(await byTest(page, 'plots').isVisible());
    ok(await byTest(page, 'side').isHidden());
    await byTest(page, 'tab-side').tap();
    ok(await byTest(page, 'side').isVisible());
    await byTest(page, 'sheet-grip').tap();
    await isHigh(0.6, 0.8);
    await byTest(page, 'sheet-grip').tap();
    await isHigh(-0.1, 0.1);
    await byTest(page, 'tab-side').tap();
    await isHigh(0.3, 0.5);
  });
}
