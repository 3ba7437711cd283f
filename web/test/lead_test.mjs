// An arm that is led from the page: keys, a gamepad, thumbs.
import { ok, strictEqual } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { byTest, openPage } from './browser.mjs';

/** @param {import('./session.mjs').Session} session  with the Panda before its table */
export function testLead(session) {
  const tool = () => {
    const { witness } = session;
    return witness.frame.bodies[witness.scene.bodies.indexOf('hand')].slice(0, 3);
  };
  const until = (what, axis, way, least) => {
    const begin = tool()[axis];
    return session.witness.until(what, () => way * (tool()[axis] - begin) > least, tool);
  };

  beforeEach(async () => {
    await session.begin();
    await byTest(session.page, 'canvas').focus();
  });

  test('a held key leads the tool, and let go it stands', async () => {
    const { page, witness } = session;
    await page.keyboard.down('q');
    await until('the tool to rise', 2, 1, 0.03);
    await page.keyboard.up('q');
    await witness.standing();
  });

  test('the tool stops above the table and the page says what is near', async () => {
    const { page, witness } = session;
    await page.keyboard.down('e');
    await witness.until('something to be near', () => / mm/.test(witness.latest.status?.line ?? ''),
      () => witness.latest.status);
    await witness.standing();
    await page.keyboard.up('e');
    ok(tool()[2] > 0.3, 'the hand is above the table');
  });

  test('the gripper closes and opens', async () => {
    const { page, witness } = session;
    const finger = () => witness.frame.bodies[witness.scene.bodies.indexOf('left_finger')]
      .slice(0, 3).map((p, i) => p - tool()[i]);
    const wide = () => Math.hypot(...finger());
    await page.keyboard.down('g');
    await witness.until('the fingers to meet', () => wide() < 0.064, wide);
    await page.keyboard.up('g');
    await page.keyboard.down('h');
    await witness.until('the fingers to part', () => wide() > 0.069, wide);
    await page.keyboard.up('h');
  });

  test('a gamepad leads the tool', async () => {
    const { page } = session;
    await page.evaluate(() => {
      const buttons = Array.from({ length: 17 }, () => ({ pressed: false, value: 0 }));
      window.testPad = { mapping: 'standard', axes: [0, 0, 0, -1], buttons };
      navigator.getGamepads = () => [window.testPad];
    });
    await until('the tool to rise', 2, 1, 0.03);
    await page.evaluate(() => {
      navigator.getGamepads = () => [];
    });
    await session.witness.standing();
  });

  test('a page that is gone leads nothing', async () => {
    const page = await openPage(session.program.url);
    await byTest(page, 'canvas').focus();
    await page.keyboard.down('q');
    await until('the tool to rise', 2, 1, 0.02);
    await page.context().close();
    await session.witness.standing();
  });

  test('a thumb on a pad leads the tool', async () => {
    const page = await openPage(session.program.url, { size: [390, 844], phone: true });
    const fingers = await page.context().newCDPSession(page);
    const box = await byTest(page, 'lead-right').boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const touch = (type, ...points) => fingers.send('Input.dispatchTouchEvent', {
      type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })),
    });
    ok(box.x + box.width <= 390, 'it is on the screen');
    await touch('touchStart', [x, y]);
    await touch('touchMove', [x, y - 50]);
    await until('the tool to rise', 2, 1, 0.03);
    await touch('touchEnd');
    await session.witness.standing();
    strictEqual(page.faults.join('\n'), '');
    await page.context().close();
  });
}
