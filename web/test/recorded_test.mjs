// A run as one file: opened from the disk, without any network.
import { deepStrictEqual, ok, strictEqual } from 'node:assert/strict';
import { mkdtemp, readFile, rm, stat } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { byTest, openPage, toScene } from './browser.mjs';
import { askMjarm, runMjarm } from './program.mjs';

const LARGEST = 4 * 1024 * 1024; // [bytes]
const SAME = 2e-6; // [rad] the page has joint values as 32 bits
const BETWEEN = 2e-3; // [rad] between two moments it goes straight
const HOLD = 0.7; // of the length of an arrow: where it is taken hold of

export function testRecorded() {
  let folder;
  let page;
  const asked = [];
  const probe = (read) => page.evaluate(read);

  before(async () => {
    folder = await mkdtemp(join(tmpdir(), 'mjarm-page-'));
    const file = join(folder, 'run.html');
    await runMjarm('run', 'movel', '--headless', '--no-timing', '--out', join(folder, 'out'), '--html', file);
    page = await openPage(pathToFileURL(file).href, { offline: true });
    page.on('request', (request) => asked.push(request.url()));
  });
  after(async () => {
    await page?.context().close();
    if (folder) await rm(folder, { recursive: true });
  });

  /** Time and joint values of each row of the log. */
  async function rows() {
    const [head, ...lines] = (await readFile(join(folder, 'out', 'log.csv'), 'utf8')).trim().split('\n');
    const columns = head.split(',').flatMap((name, index) => (/^q \S+ \[rad\]$/.test(name) ? [index] : []));
    return lines.map((line) => line.split(',').map(Number)).map((row) => [row[0], columns.map((index) => row[index])]);
  }

  /** Moves the time line, as a drag does. */
  async function scrub(time) {
    await byTest(page, 'panel-0').evaluate((line, to) => {
      line.value = String(to);
      line.dispatchEvent(new Event('input'));
    }, time);
    await page.waitForFunction((to) => Math.abs(window.mjarm.time - to) < 1e-9, time);
  }

  test('is small enough to be sent', async () => {
    ok((await stat(join(folder, 'run.html'))).size < LARGEST);
  });

  test('plays by itself, pauses, and begins anew behind its end', async () => {
    const begin = await probe(() => window.mjarm.time);
    await page.waitForFunction((time) => window.mjarm.time > time + 0.2, begin);
    await byTest(page, 'pause').click();
    await page.waitForFunction(() => window.mjarm.paused);
    const at = await probe(() => window.mjarm.time);
    await page.waitForTimeout(200);
    strictEqual(await probe(() => window.mjarm.time), at);
    await scrub((await rows()).at(-1)[0]);
    await byTest(page, 'pause').click();
    await page.waitForFunction(() => !window.mjarm.paused && window.mjarm.time < 1);
    await byTest(page, 'pause').click();
    await page.waitForFunction(() => window.mjarm.paused);
  });

  test('scrubbed to any time the joints are those of the log', async () => {
    const log = await rows();
    for (const share of [0, 0.13, 0.5, 0.77, 1]) {
      const [time, q] = log[Math.round(share * (log.length - 1))];
      await scrub(time);
      const shown = await probe(() => window.mjarm.qpos);
      q.forEach((value, joint) => ok(
        Math.abs(value - shown[joint]) < (share === 1 ? SAME : BETWEEN),
        `joint ${joint} at ${time} s: ${shown[joint]}, not ${value}`,
      ));
    }
  });

  test('the trail grows with the time, and the plots mark it', async () => {
    const end = (await rows()).at(-1)[0];
    const now = byTest(page, 'now');
    const seen = [];
    for (const share of [0.2, 0.6, 1]) {
      await scrub(share * end);
      await page.waitForFunction((time) => Math.abs(window.mjarm.time - time) < 1e-9, share * end);
      const marks = await now.evaluateAll((all) => all.filter((mark) => !mark.hidden).map(
        (mark) => mark.offsetLeft / mark.parentElement.clientWidth));
      ok(marks.length > 0, 'no plot has a mark');
      seen.push({ points: await probe(() => window.mjarm.lines.reduce((all, points) => all + points, 0)), mark: marks[0] });
    }
    const [begin, middle, whole] = seen;
    ok(begin.points < middle.points && middle.points < whole.points, JSON.stringify(seen));
    ok(begin.mark < middle.mark && middle.mark < whole.mark && whole.mark > 0.9, JSON.stringify(seen));
  });

  test('its target is dragged; the joints are those of the program', async (context) => {
    if (!(await readFile(join(folder, 'run.html'), 'utf8')).includes('id="ik-bytes"')) {
      context.skip('the page was built without its kinematics');
      return;
    }
    await scrub(0);
    const before = await probe(() => window.mjarm.qpos);
    await toScene(page);
    await byTest(page, 'target').click();
    await page.waitForFunction(() => window.mjarm.target.shown);
    const { pos } = await probe(() => window.mjarm.target);
    const arrows = await probe(() => [0, 1, 2].map((axis) => [window.mjarm.handle(axis, 0), window.mjarm.handle(axis, 1)]));
    const ways = arrows.map(([a, b]) => [b.x - a.x, b.y - a.y]);
    const axis = ways.map(([x, y]) => Math.hypot(x, y)).reduce((best, way, k, all) => (way > all[best] ? k : best), 0);
    const [x, y] = [arrows[axis][0].x + HOLD * ways[axis][0], arrows[axis][0].y + HOLD * ways[axis][1]];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + ways[axis][0] / 2, y + ways[axis][1] / 2, { steps: 8 });
    await page.mouse.up();
    await page.waitForFunction(() => !window.mjarm.target.held);
    const target = await probe(() => window.mjarm.target);
    const moved = Math.hypot(...target.pos.map((value, k) => value - pos[k]));
    ok(moved > 0.02, `the target moved by ${moved} m`);
    // The last moves of the mouse may still be on their way to the arm: it has to stand.
    await page.waitForFunction((q) => {
      const now = window.mjarm.qpos.join();
      window.stood = now === window.stoodAt ? window.stood + 1 : 0;
      window.stoodAt = now;
      return window.stood > 15 && window.mjarm.qpos.some((value, i) => Math.abs(value - q[i]) > 0.01);
    }, before);
    const shown = await probe(() => window.mjarm.qpos);
    const answer = await askMjarm(
      'ik', '--robot', 'ur5e', `--pos=${target.pos.join(',')}`, `--quat=${target.quat.join(',')}`, `--seed-q=${shown.join(',')}`,
    );
    answer.q.forEach((value, joint) => ok(Math.abs(value - shown[joint]) < SAME, `joint ${joint}: ${shown[joint]}, not ${value}`));
  });

  test('the page says nothing it should not, and asks nobody for anything', () => {
    deepStrictEqual(page.faults, []);
    deepStrictEqual(asked.filter((url) => !url.startsWith('blob:') && !url.startsWith('data:')), []);
  });
}
