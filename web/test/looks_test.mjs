// The page itself: languages, appearance, help, settings, what is folded away.
import { ok, strictEqual } from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { dragMouse, pixelOf, toScene } from './browser.mjs';
import { brightnessOf, differenceOf, pictureOfScene } from './picture.mjs';

/** @param {import('./session.mjs').Session} session  with the UR5e */
export function testLooks(session) {
  beforeEach(() => session.begin());

  const choose = async (what, value) => {
    await session.control('menu').click();
    await session.control(`${what}-select`).selectOption(value);
    await session.page.keyboard.press('Escape');
    ok(await session.control('menu-panel').isHidden());
  };

  test('languages and appearance are chosen, and kept for the next visit', async () => {
    const { page } = session;
    const look = () => page.evaluate(() => [
      document.documentElement.lang, document.documentElement.dataset.theme,
      document.querySelector('[data-test="view-front"]').textContent,
      document.querySelector('[data-test="pause"]').getAttribute('aria-label'),
    ].join(' '));
    strictEqual(await look(), 'en light Front Pause');
    const light = brightnessOf(await pictureOfScene(page));
    await choose('theme', 'dark');
    await choose('language', 'zh');
    strictEqual(await look(), 'zh-CN dark 正面 暂停');
    ok(brightnessOf(await pictureOfScene(page)) < light - 60);
    await page.reload();
    await page.waitForFunction(() => window.mjarm?.ready && window.mjarm.frame >= 0);
    strictEqual(await look(), 'zh-CN dark 正面 暂停');
    await choose('theme', 'auto');
    await choose('language', 'en');
    strictEqual(await look(), 'en light Front Pause');
  });

  test('each word is there in both languages', async () => {
    const { page } = session;
    const words = () => page.evaluate(() => [...document.querySelectorAll('[data-word], [data-word-label]')].map(
      (node) => (node.dataset.word ? node.textContent : node.getAttribute('aria-label'))));
    const english = await words();
    await choose('language', 'zh');
    const chinese = await words();
    await choose('language', 'en');
    ok(english.length > 60, `${english.length} words`);
    for (const [index, word] of english.entries()) {
      ok(word && !/[\u4e00-\u9fff]/.test(word), `English: "${word}"`);
      ok(chinese[index], `Chinese of "${word}"`);
      if (/[a-z]{3}/i.test(word) && !/PgUp|Home|Ctrl/.test(word)) ok(/[\u4e00-\u9fff]/.test(chinese[index]), chinese[index]);
    }
  });

  test('while help is open, keys do nothing else', async () => {
    const { page, witness } = session;
    const help = session.control('help-panel');
    await session.control('help').click();
    ok(await help.isVisible());
    const { shown } = witness.target;
    await page.keyboard.press('t');
    await page.keyboard.press('Escape');
    ok(await help.isHidden());
    strictEqual(witness.target.shown, shown);
    await toScene(page);
    await page.keyboard.press('?');
    ok(await help.isVisible());
    await session.control('help-close').click();
    ok(await help.isHidden());
  });

  test('grid, shadows and labels are switched', async () => {
    const { page } = session;
    await session.control('menu').click();
    for (const name of ['grid', 'shadows']) {
      const before = await pictureOfScene(page);
      const was = await session.control(name).isChecked();
      await session.control(name).setChecked(!was);
      ok(differenceOf(await pictureOfScene(page), before).share > 0.002, name);
      await session.control(name).setChecked(was);
    }
    await session.control('labels').setChecked(false);
    await session.control('labels').setChecked(true);
    await page.mouse.click(100, 300);
    ok(await session.control('menu-panel').isHidden(), 'a click beside it closes it');
  });

  test('panels make room for the scene, plots take some', async () => {
    const { page } = session;
    const { width } = await session.control('view').boundingBox();
    const isWider = (wider) => page.waitForFunction(
      ([w, more]) => (document.querySelector('[data-test="view"]').clientWidth > w + 100) === more, [width, wider]);
    await session.control('hide-side').click();
    await isWider(true);
    await toScene(page);
    await page.keyboard.press('b');
    await isWider(false);
    await session.check('Joints', true, 'Plots');
    const splitter = session.control('plots-splitter');
    await splitter.waitFor();
    const height = async () => (await session.control('plots').boundingBox()).height;
    const begin = await height();
    const [x, y] = await pixelOf(splitter);
    await dragMouse(page, [[x, y], [x, y - 60]]);
    ok(Math.abs((await height()) - begin - 60) < 3, `${begin} and ${await height()}`);
    await splitter.press('ArrowDown');
    ok(Math.abs((await height()) - begin - 40) < 3);
    await session.check('Joints', false, 'Plots');
  });
}
