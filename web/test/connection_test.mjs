// A server that goes and comes back, and who is let in.
import { deepStrictEqual, ok, strictEqual } from 'node:assert/strict';
import { randomBytes } from 'node:crypto';
import { after, before, test } from 'node:test';
import { byTest, untilPage } from './browser.mjs';
import { freePort, Program } from './program.mjs';
import { Session } from './session.mjs';

export function testConnection() {
  const session = new Session();
  const environment = { MJARM_SERVE_TOKEN: randomBytes(16).toString('hex') };
  let port;

  before(async () => {
    port = String(await freePort());
    await session.open(['car', '--port', port], {}, environment);
  });
  after(() => session.close());

  const isIn = (connection) => untilPage(session.page, (name) => window.mjarm?.connection === name, connection);

  /** The same server once more, as far as a page can tell; the witness is another one. */
  async function startAgain(model = 'car') {
    session.witness.close();
    session.program = await Program.serve([model, '--port', port], environment);
    session.witness = await session.witness.constructor.open(session.program.url);
  }

  /** The page controls the program that runs now. */
  async function assertControls() {
    const { witness, page } = session;
    await byTest(page, 'pause').click();
    await witness.until('the pause', () => witness.frame.paused);
    await untilPage(page, () => window.mjarm.paused);
    await byTest(page, 'pause').click();
    await witness.until('it to go on', () => !witness.frame.paused);
  }

  test('a server that was killed is missed, and found again once it is back', async () => {
    const { page } = session;
    await assertControls();
    strictEqual(await session.program.kill(), 'SIGKILL');
    await isIn('lost');
    ok(await byTest(page, 'notice').isVisible());
    for (const name of ['pause', 'reset', 'speed']) ok(await byTest(page, name).isDisabled(), name);
    await startAgain();
    await isIn('open');
    ok(await byTest(page, 'notice').isHidden());
    await assertControls();
  });

  test('a run that is over is found again where somebody asks', async () => {
    const { page } = session;
    strictEqual(await session.program.stop(), 0);
    await isIn('over');
    ok(await byTest(page, 'pause').isDisabled());
    await startAgain();
    await byTest(page, 'notice-action').click();
    await isIn('open');
    await assertControls();
  });

  test('another model at the same address is shown anew', async () => {
    const { page } = session;
    const title = await page.title();
    await session.program.kill();
    await isIn('lost');
    await startAgain('hello');
    await page.waitForFunction((before) => document.title !== before && window.mjarm?.frame >= 0, title);
    await assertControls();
  });

  test('nobody comes in without the address, nor from a page of somebody else', async () => {
    const { page, program } = session;
    const { origin } = new URL(program.url);
    const status = async (path) => (await fetch(origin + path)).status;
    deepStrictEqual([await status('/'), await status(`/${'0'.repeat(32)}/`)], [404, 404]);
    const stranger = await page.context().newPage();
    const heard = await stranger.evaluate((url) => new Promise((resolve) => {
      const socket = new WebSocket(url);
      socket.onmessage = () => resolve('a message');
      socket.onerror = () => resolve('refused');
    }), `${program.url.replace('http', 'ws')}live`);
    strictEqual(heard, 'refused');
    await stranger.close();
  });

  test('the page says nothing it should not', () => session.assertNoFaults());
}
