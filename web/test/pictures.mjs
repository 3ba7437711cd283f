// Pictures of the page as the documentation shows it: npm run pictures [-- FOLDER]; into a folder of
// one's own come more of them, to be looked at.
import { join } from 'node:path';
import { argv } from 'node:process';
import { fileURLToPath } from 'node:url';
import { byTest, closeBrowser, dragMouse, openBrowser } from './browser.mjs';
import { Session } from './session.mjs';

const DOCUMENTATION = fileURLToPath(new URL('../../docs/images', import.meta.url));
const DESKTOP = { size: [880, 560], scale: 1 };
const PHONE = { size: [390, 780], scale: 1, phone: true };
const PICTURES = {
  serve_desktop: { ...DESKTOP, theme: 'light', settings: { language: 'en' } },
  serve_phone: { ...PHONE, theme: 'dark', settings: { language: 'zh' } },
  serve_desktop_zh: { ...DESKTOP, theme: 'dark', settings: { language: 'zh' } },
  serve_phone_en: { ...PHONE, theme: 'light', settings: { language: 'en' } },
};
/** Numbers of items of the panels: the same in each language. */
const ITEM = { follow: 1001, moveBy: 1005, minusX: 1100, minusY: 1102, minusZ: 1104, toolPosition: 2100 };
const SHOWN = ['serve_desktop', 'serve_phone'];

/** The arm on its way, a ghost where the target was dragged to. */
async function arrange(session) {
  const { page, witness } = session;
  const use = (id, value) => witness.send({ type: 'panel', id, value });
  await witness.standing();
  use(ITEM.toolPosition, 1);
  use(ITEM.moveBy, 2);
  for (const jog of [ITEM.minusX, ITEM.minusY, ITEM.minusZ, ITEM.minusZ, ITEM.minusX]) {
    use(jog, 1);
    await witness.standing();
  }
  use(ITEM.follow, 0);
  const [x, y, z] = witness.target.pos;
  await dragMouse(page, [await session.pixel([x, y, z]), await session.pixel([x + 0.44, y, z + 0.16])]);
  await witness.until('a ghost', () => witness.overlay.includes('ghost'));
  await byTest(page, 'side').evaluate((node) => node.scrollTo(0, 0));
  await page.mouse.move(5, 5);
  await page.waitForTimeout(1000);
}

async function take(name, look, folder) {
  const session = new Session();
  await session.open(look.settings.language === 'zh' ? ['--lang', 'zh-CN', 'ur5e'] : ['ur5e'], look);
  await arrange(session);
  await session.page.screenshot({ path: join(folder, `${name}.png`) });
  await session.close();
}

const folder = argv[2] ?? DOCUMENTATION;
await openBrowser();
for (const [name, look] of Object.entries(PICTURES)) {
  if (argv[2] || SHOWN.includes(name)) await take(name, look, folder);
}
await closeBrowser();
