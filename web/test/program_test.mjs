// A motion program: run, stopped, looked back at.
import { ok, strictEqual } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { dragMouse, pixelOf, untilPage } from './browser.mjs';
import { askMjarm } from './program.mjs';

/** @param {import('./session.mjs').Session} session  with a program of four moves, speeds.yaml */
export function testProgram(session) {
  beforeEach(async () => {
    await session.begin();
    await session.panel('Restart').click();
    await isIn('ready');
  });

  const hurry = () => session.witness.send({ type: 'speed', speed: 5 });

  const state = () => session.witness.item('State').value;
  const isIn = (...states) => session.witness.until(states.join(' or '), () => states.includes(state()), state);
  const list = () => session.witness.item('', 'Program');
  const line = () => session.witness.item('', 'Time');
  const way = (a, b) => Math.max(...a.map((q, i) => Math.abs(q - b[i])));

  test('runs, stops where it is, and goes on to the end', async () => {
    const { witness, page } = session;
    const begin = witness.frame.qpos;
    await session.panel('Run').click();
    await isIn('running');
    await witness.until('the arm to move', () => way(witness.frame.qpos, begin) > 0.1);
    await session.panel('Stop').click();
    await isIn('stopped');
    ok(list().current < 3, `it stopped in motion ${list().current}`);
    hurry();
    const stands = await witness.standing();
    await session.panel('Run').click();
    await witness.until('it to go on', () => way(witness.frame.qpos, stands) > 0.1);
    await isIn('done');
    await untilPage(page, (id) => document.querySelector(`[data-test="panel-${id}"]`).disabled, witness.item('Run').id);
    const end = await askMjarm('fk', '--robot', 'ur5e', `--q=${(await witness.standing()).join(',')}`);
    ok(Math.hypot(end.pos[0] + 0.134, end.pos[1] - 0.492, end.pos[2] - 0.488) < 0.002, `${end.pos}`); // home
  });

  test('steps by one motion each, and begins anew', async () => {
    const { witness, page } = session;
    const begin = witness.frame.qpos;
    hurry();
    for (const motion of [1, 2]) {
      await session.panel('Step').click();
      await witness.until(`motion ${motion}`, () => list().current === motion && ['stopped', 'ready'].includes(state()), state);
      await untilPage(page, ([id, index]) => document.querySelector(`[data-test="panel-${id}-${index}"]`)
        .getAttribute('aria-current') === 'true', [list().id, motion]);
    }
    ok(way(witness.frame.qpos, begin) > 0.3);
    await session.panel('Restart').click();
    await witness.until('the beginning', () => list().current === 0 && way(witness.frame.qpos, begin) < 1e-3);
  });

  test('its past is looked at: scrubbed by mouse and keys, by motion, replayed; then the present', async () => {
    const { witness, page } = session;
    const begin = witness.frame.qpos;
    hurry();
    await session.panel('Run').click();
    await isIn('done');
    const end = await witness.standing();
    const slider = session.control(`panel-${line().id}`);
    const shows = async (shown) => witness.until(`shown: ${shown}`, () => witness.item('Shown').value === shown,
      () => witness.item('Shown').value);

    await dragMouse(page, [await pixelOf(slider, 0.9), await pixelOf(slider, 0.5), await pixelOf(slider, 0.02)]);
    await shows('the past');
    await witness.until('the beginning', () => line().time < 0.05 * line().end, () => line());
    const time = line().time;
    await witness.until('what was at first', () => way(witness.frame.qpos, begin) < 0.1, () => line());
    await slider.focus();
    for (let i = 0; i < 3; ++i) await page.keyboard.press('PageUp');
    await witness.until('keys to go on', () => line().time > time + 0.1 * line().end, () => line());

    await session.control(`panel-${list().id}-2`).click();
    await witness.until('the third motion', () => list().current === 2, () => list().current);
    const third = line().time;
    ok(third > 0.3 * line().end);

    await session.panel('Replay').click();
    await shows('replay');
    await witness.until('the replay to go on', () => line().time > third + 0.2, () => line());
    await session.panel('Now').click();
    await shows('now');
    await witness.until('the present', () => way(witness.frame.qpos, end) < 1e-3);
    strictEqual(state(), 'done');
  });

  test('what it draws is switched', async () => {
    const { witness } = session;
    const lines = () => witness.overlay.filter((kind) => kind === 'line').length;
    await witness.until('planned paths', () => lines() >= 4);
    await session.check('Planned paths', false);
    await witness.until('no planned paths', () => lines() === 0);
    await session.check('Planned paths', true);
    const before = witness.overlay.length;
    await session.check('Goal', true);
    await witness.until('the goal', () => witness.overlay.length > before);
    await session.check('Goal', false);
    await session.check('Trail', false);
    await session.check('Trail', true);
  });

  test('its plots come with its run', async () => {
    const { witness, page } = session;
    await session.panel('Run').click();
    await witness.until('two plots', () => witness.latest.plots.plots.length === 2);
    await untilPage(page, () => document.querySelectorAll('figure canvas').length === 2);
    await session.check('Tracking error', false, 'Plots');
    await untilPage(page, () => document.querySelectorAll('figure').length === 1);
    await session.check('Tracking error', true, 'Plots');
  });
}
