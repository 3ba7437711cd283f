// The scene: what is seen, from where, and what is taken hold of in it.
import { deepStrictEqual, ok, strictEqual } from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { afterEach, beforeEach, test } from 'node:test';
import { dragMouse, toScene } from './browser.mjs';
import { brightnessOf, differenceOf, pictureOfScene, readPng } from './picture.mjs';

/** @param {import('./session.mjs').Session} session  with the UR5e */
export function testScene(session) {
  beforeEach(() => session.begin());
  afterEach(() => session.page.emulateMedia({ colorScheme: 'light' }));

  const camera = () => session.page.evaluate(() => window.mjarm.camera);
  const body = (name) => session.witness.scene.bodies.indexOf(name);
  const placeOf = (name) => session.witness.frame.bodies[body(name)].slice(0, 3);

  async function setGroup(group, on) {
    await session.control('menu').click();
    await session.control(`group-${group}`).setChecked(on);
    await session.page.keyboard.press('Escape');
  }

  /** Pictures with the arm and without, while nothing else changes. */
  async function pictures() {
    await session.page.mouse.move(5, 5);
    const whole = await pictureOfScene(session.page);
    await setGroup(2, false);
    const bare = await pictureOfScene(session.page);
    await setGroup(2, true);
    return { whole, bare };
  }

  for (const theme of ['light', 'dark']) {
    test(`the arm is seen where the program has it, and turns with a joint: ${theme}`, async () => {
      const { witness, page } = session;
      await page.emulateMedia({ colorScheme: theme });
      await session.check('Target', false, 'Target');
      await witness.standing();
      const { whole, bare } = await pictures();
      ok(theme === 'dark' ? brightnessOf(bare) < 90 : brightnessOf(bare) > 150, `it is ${brightnessOf(bare)} bright`);
      const { share, box } = differenceOf(whole, bare);
      ok(share > 0.02 && share < 0.4, `the arm has ${share} of the picture`);
      const view = await session.control('view').boundingBox();
      const scale = whole.width / view.width;
      for (const link of ['shoulder_link', 'forearm_link', 'wrist_3_link']) {
        const [x, y] = await session.pixel(placeOf(link));
        const [left, top] = [scale * (x - view.x), scale * (y - view.y)];
        ok(left > box.left && left < box.right && top > box.top && top < box.bottom, `${link} is in its picture`);
      }
      await session.control('joint-shoulder_pan_joint-value').fill('-45');
      await session.control('joint-shoulder_pan_joint-value').press('Enter');
      await witness.until('the joint to turn', () => Math.abs(witness.frame.qpos[0] + Math.PI / 4) < 0.01);
      await witness.standing();
      const turned = await pictureOfScene(page);
      ok(differenceOf(turned, whole).share > 0.3 * share, 'another picture');
      ok(differenceOf(turned, bare).share > 0.02, 'with the arm in it');
    });
  }

  test('Ctrl and the mouse pull at a body, as long as they hold it', async () => {
    const { witness, page } = session;
    await session.check('Target', false, 'Target');
    const begin = await witness.standing();
    const away = () => Math.max(...witness.frame.qpos.map((q, i) => Math.abs(q - begin[i])));
    const [x, y] = await session.pixel(placeOf('wrist_1_link'));
    await page.keyboard.down('Control');
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x - 150, y - 100, { steps: 5 });
    await witness.until('the arm to give way', () => away() > 0.004, away);
    ok(/^\d+(\.\d)? N$/.test(await session.control('readout').textContent()), 'it says how strongly');
    await page.mouse.up();
    await page.keyboard.up('Control');
    await witness.until('the arm to come back', () => away() < 0.001, away);
    ok(await session.control('readout').isHidden());
  });

  test('a body that is double-clicked is told about as the program has it', async () => {
    const { witness, page } = session;
    await session.check('Target', false, 'Target');
    await witness.standing();
    await page.mouse.dblclick(...(await session.pixel(placeOf('forearm_link'))));
    const name = await session.control('selection-name').textContent();
    ok(['forearm_link', 'upper_arm_link'].includes(name), name); // they meet there
    const shown = (await session.control('selection-position').textContent()).split(/\s+/).map(Number);
    ok(placeOf(name).every((x, i) => Math.abs(x - shown[i]) < 2e-4), `${shown}`);
    await toScene(page);
    await page.keyboard.press('Escape');
    ok(await session.control('selection').isHidden());
    await page.mouse.dblclick(...(await session.pixel(placeOf('forearm_link'))));
    await session.control('deselect').click();
    ok(await session.control('selection').isHidden());
  });

  test('the mouse turns the view, moves it and comes nearer', async () => {
    const first = await camera();
    await dragMouse(session.page, [[120, 200], [200, 230]]);
    const turned = await camera();
    ok(turned.azimuth < first.azimuth && turned.elevation !== first.elevation);
    deepStrictEqual(turned.lookat, first.lookat);
    await dragMouse(session.page, [[120, 200], [160, 220]], 'right');
    const moved = await camera();
    ok(moved.lookat.some((x, i) => Math.abs(x - turned.lookat[i]) > 0.02));
    await session.page.mouse.wheel(0, -200);
    await session.page.waitForFunction((distance) => window.mjarm.camera.distance < 0.9 * distance, moved.distance);
  });

  test('keys and buttons take the views there are', async () => {
    const { page, witness } = session;
    const isSeen = async (azimuth, elevation) => {
      const now = await camera();
      ok(Math.cos(now.azimuth - azimuth) > 0.999999 && Math.abs(now.elevation - elevation) < 1e-6, JSON.stringify(now));
    };
    const first = await camera();
    const views = { front: [Math.PI, 0], side: [Math.PI / 2, 0], top: [Math.PI / 2, -Math.PI / 2] };
    for (const [index, [name, view]] of Object.entries(views).entries()) {
      await session.control(`view-${name}`).click();
      await isSeen(...view);
      await toScene(page);
      await page.keyboard.press('Home');
      await isSeen(first.azimuth, first.elevation);
      await page.keyboard.press(String(index + 1));
      await isSeen(...view);
    }
    await session.control('axis+y').click();
    ok((await camera()).elevation === 0);
    await toScene(page);
    await page.keyboard.press('Home');
    for (const [key, changed] of [['Shift+ArrowLeft', 'azimuth'], ['Shift+ArrowUp', 'elevation'], ['PageUp', 'distance']]) {
      const before = await camera();
      await page.keyboard.press(key);
      ok((await camera())[changed] !== before[changed], key);
    }
    for (const key of ['w', 'a', 's', 'd']) {
      const { lookat } = await camera();
      await page.keyboard.press(key);
      ok((await camera()).lookat.some((x, i) => Math.abs(x - lookat[i]) > 1e-3), key);
    }
    for (const fit of [() => session.control('fit').click(), () => page.keyboard.press('f')]) {
      await toScene(page);
      await page.keyboard.press('PageDown');
      await fit();
      const [x, y] = await session.pixel(placeOf('forearm_link'));
      const view = await session.control('view').boundingBox();
      ok(x > view.x && x < view.x + view.width && y > view.y && y < view.y + view.height, 'the arm is in the picture');
    }
    const { cameras } = witness.scene;
    ok(cameras.length > 0);
    for (const index of cameras.keys()) {
      await session.control('camera').selectOption(String(index));
      strictEqual((await camera()).chosen, index);
    }
    await session.control('camera').selectOption('first');
    await toScene(page);
    await page.keyboard.press(']');
    strictEqual((await camera()).chosen, 0);
    await page.keyboard.press('[');
    strictEqual((await camera()).chosen, -1);
  });

  test('collision shapes are drawn where they are wanted', async () => {
    const { page } = session;
    const without = await pictureOfScene(page);
    await session.control('collision').click();
    await page.mouse.move(5, 5);
    const shapes = await pictureOfScene(page);
    ok(differenceOf(shapes, without).share > 0.005);
    strictEqual(await session.control('collision').getAttribute('aria-pressed'), 'true');
    await toScene(page);
    await page.keyboard.press('c');
    strictEqual(await session.control('collision').getAttribute('aria-pressed'), 'false');
  });

  test('a picture of the scene is saved', async () => {
    const { page } = session;
    const saved = async (save) => {
      const [download] = await Promise.all([page.waitForEvent('download'), save()]);
      ok(/^ur5e.*\.png$/.test(download.suggestedFilename()), download.suggestedFilename());
      return readPng(await readFile(await download.path()));
    };
    const picture = await saved(() => session.control('screenshot').click());
    const seen = await pictureOfScene(page);
    deepStrictEqual([picture.width, picture.height], [seen.width, seen.height]);
    ok(Math.abs(brightnessOf(picture) - brightnessOf(seen)) < 20, 'it is no blank one');
    await toScene(page);
    strictEqual((await saved(() => page.keyboard.press('p'))).width, picture.width);
  });
}
