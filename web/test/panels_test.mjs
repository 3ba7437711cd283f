// The panels of a robot: what the server puts there, and what it does then.
import { deepStrictEqual, ok, strictEqual } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';

const FIRST_PLOT = 'Tool position';

/** @param {import('./session.mjs').Session} session  with the UR5e */
export function testPanels(session) {
  beforeEach(() => session.begin());

  test('each checkbox and each choice is switched in the program, and back', async () => {
    const { witness } = session;
    let count = 0;
    for (const { title, items } of witness.latest.panels.sections) {
      for (const { kind, name, on, words, current } of items) {
        if (kind === 'checkbox') {
          await session.check(name, !on, title);
          await session.check(name, on, title);
        } else if (kind === 'choice') {
          for (const word of [...words].reverse()) await session.choose(name, word, title);
          await session.choose(name, words[current], title);
        } else continue;
        ++count;
      }
    }
    ok(count >= 12, `${count} of them`);
  });

  test('buttons jog the target by what is chosen', async () => {
    const { witness } = session;
    await witness.standing();
    const press = async (name, index, way) => {
      const before = witness.target.pos;
      await session.panel(name).click();
      await witness.until(`${name} by ${way} m`, () => witness.target.pos.every(
        (x, i) => Math.abs(x - before[i] - (i === index ? way : 0)) < 1e-6), () => [before, witness.target.pos]);
    };
    await session.choose('Frame', 'world');
    await session.choose('Move by', '10 mm');
    await press('+ x', 0, 0.01);
    await press('- y', 1, -0.01);
    await session.choose('Move by', '50 mm');
    await press('+ y', 1, 0.05);
    await session.choose('Move by', '1 mm');
    await press('- x', 0, -0.001);
    await session.choose('Frame', 'tool'); // it looks down
    await press('+ z', 2, -0.001);
    await session.choose('Frame', 'world');
    await session.choose('Turn by', '15 deg');
    for (const axis of ['rx', 'ry', 'rz']) {
      const { quat } = witness.target;
      const isTurned = (degrees) => witness.until(`a turn by ${degrees} degrees about ${axis}`, () => {
        const same = Math.abs(witness.target.quat.reduce((sum, x, i) => sum + x * quat[i], 0));
        return Math.abs(same - Math.cos((degrees * Math.PI) / 360)) < 1e-5;
      });
      await session.panel(`+ ${axis}`).click();
      await isTurned(15);
      await session.panel(`- ${axis}`).click();
      await isTurned(0);
    }
  });

  test('the target goes back to the arm', async () => {
    const { witness } = session;
    await witness.standing();
    await session.check('Follow', false);
    const { pos } = witness.target;
    await session.choose('Move by', '50 mm');
    await session.panel('- z').click();
    await witness.until('it to leave', () => pos[2] - witness.target.pos[2] > 0.04);
    await session.panel('Back to arm').click();
    await witness.until('it to be back', () => witness.target.pos.every((x, i) => Math.abs(x - pos[i]) < 1e-3));
  });

  test('what is shown besides is drawn in the page', async () => {
    const { witness, page } = session;
    const isDrawn = async (kind, on) => {
      await witness.until(`${kind}: ${on}`, () => witness.overlay.includes(kind) === on, () => witness.overlay);
      await page.waitForFunction(([k, o]) => window.mjarm.overlay.includes(k) === o, [kind, on]);
    };
    await session.choose('Trail', 'balls');
    await session.choose('Move by', '50 mm');
    witness.send({ type: 'speed', speed: 0.05 }); // else it is there before its ghost is seen
    await session.panel('+ y').click();
    for (const [name, kind] of [['Ghost of goal', 'ghost'], ['Ellipsoid', 'ellipsoid']]) {
      await session.check(name, true);
      await isDrawn(kind, true);
      await session.check(name, false);
      await isDrawn(kind, false);
    }
    witness.send({ type: 'speed', speed: 1 });
    await isDrawn('sphere', true);
    await session.choose('Trail', 'line');
    await isDrawn('sphere', false);
    await session.choose('Trail', 'off');
  });

  test('plots of the program: on, read under the mouse, a line hidden, off', async () => {
    const { witness, page } = session;
    const names = witness.latest.panels.sections.find(({ title }) => title === 'Plots').items.map(({ name }) => name);
    for (const name of names) await session.check(name, true, 'Plots');
    await witness.until('all plots', () => witness.latest.plots.plots.length === names.length);
    await page.waitForFunction((count) => document.querySelectorAll('figure').length === count, names.length);
    for (const name of names.slice(1)) await session.check(name, false, 'Plots');
    await page.waitForFunction(() => document.querySelectorAll('figure').length === 1);

    const { title, series } = witness.latest.plots.plots[0];
    const figure = session.control('plot-0');
    strictEqual(await figure.locator('strong').textContent(), title);
    const lines = figure.locator('.key');
    deepStrictEqual(await lines.allTextContents(), series.map(({ name }) => name).filter(Boolean));
    await figure.locator('.u-over').hover();
    await page.waitForFunction(() => Number.isFinite(parseFloat(document.querySelector('figure .tip .value').textContent)));
    await lines.first().click();
    strictEqual(await lines.first().getAttribute('aria-pressed'), 'false');
    await lines.first().click();
    await session.check(FIRST_PLOT, false, 'Plots');
    await page.waitForFunction(() => document.querySelectorAll('figure').length === 0);
  });

  test('a section is folded away and back', async () => {
    const head = session.control('section-0-head');
    await head.click();
    ok(!(await session.control('section-0-body').isVisible()));
    await head.press('Enter');
    ok(await session.control('section-0-body').isVisible());
  });
}
