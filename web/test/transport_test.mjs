// Pause, steps, speed, reset.
import { strictEqual, ok } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { toScene } from './browser.mjs';

const STEP = 0.002; // [s] of the shipped arms
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** @param {import('./session.mjs').Session} session  with an arm */
export function testTransport(session) {
  beforeEach(() => session.begin());

  /** How fast the simulation goes, beside the clock on the wall. */
  async function pace() {
    const { witness } = session;
    await sleep(150); // what was under way is there
    const [time, wall] = [witness.frame.time, performance.now()];
    await sleep(500);
    return (witness.frame.time - time) / ((performance.now() - wall) / 1000);
  }

  /** @returns {Promise<number>} [s] where the program stands: it may have had steps to make up for */
  async function pause() {
    const { witness } = session;
    await session.control('pause').click();
    await witness.until('the pause', () => witness.frame.paused);
    for (let time = -1; time !== witness.frame.time;) {
      time = witness.frame.time;
      await sleep(200);
    }
    return witness.frame.time;
  }

  test('pause stops the program, and steps move it by one step each', async () => {
    const { witness, page } = session;
    const time = await pause();
    await sleep(200);
    strictEqual(witness.frame.time, time);
    const isAt = (steps) => witness.until(
      `step ${steps}`, () => Math.abs(witness.frame.time - time - steps * STEP) < 1e-9, () => witness.frame.time - time);
    await session.control('step').click();
    await isAt(1);
    await toScene(page);
    await page.keyboard.press('ArrowRight');
    await isAt(2);
    await page.keyboard.press('ArrowLeft');
    await isAt(1);
    await session.control('step-back').click();
    await isAt(0);
    await toScene(page);
    await page.keyboard.press('Space');
    await witness.until('it to go on', () => !witness.frame.paused && witness.frame.time > time + 10 * STEP);
  });

  test('the speed is that of the program', async () => {
    const { page } = session;
    const goesAt = async (speed) => {
      const measured = await pace();
      ok(Math.abs(measured / speed - 1) < 0.4, `${measured} instead of ${speed}`);
      strictEqual(await session.control('speed').inputValue(), String(speed));
    };
    await session.control('speed').selectOption('0.1');
    await goesAt(0.1);
    await session.control('faster').click();
    await goesAt(0.2);
    await session.control('slower').click();
    await session.control('slower').click();
    await goesAt(0.05);
    await toScene(page);
    await page.keyboard.press('+');
    await page.keyboard.press('+');
    await page.keyboard.press('-');
    await goesAt(0.1);
  });

  for (const [way, reset] of [
    ['its button', () => session.control('reset').click()],
    ['a key', async () => {
      await toScene(session.page);
      await session.page.keyboard.press('Backspace');
    }],
  ]) {
    test(`reset by ${way} begins anew`, async () => {
      const { witness } = session;
      const home = witness.frame.qpos[0];
      await session.control('joint-shoulder_pan_joint-value').fill('20');
      await session.control('joint-shoulder_pan_joint-value').press('Enter');
      await witness.until('the arm to leave', () => Math.abs(witness.frame.qpos[0] - home) > 0.2);
      const { time } = witness.frame;
      await reset();
      await witness.until('the beginning', () => witness.frame.time < time && Math.abs(witness.frame.qpos[0] - home) < 1e-3);
    });
  }

  test('the clock of the page is that of the program', async () => {
    const { page, witness } = session;
    const time = await pause();
    await page.waitForFunction((shown) => document.querySelector('[data-test="time"]').textContent === shown,
      `${time.toFixed(3)} s`);
    strictEqual(await session.control('pause').getAttribute('aria-pressed'), 'true');
    strictEqual(witness.frame.time, time);
  });
}
