// The browser that the tests share, and pages in it.
import { existsSync } from 'node:fs';
import { delimiter, join } from 'node:path';

const NAMES = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable'];
/** The processor draws; the page round the scene without OpenGL, which takes a tenth of the time. */
const DRAWN_BY_PROCESSOR = [
  '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
  '--disable-gpu-compositing',
];
const LONG = 30000; // [ms] until something must have happened
const LOADING = 60000; // [ms]
const HARMLESS = /GPU stall|GL Driver Message|ERR_CONNECTION_|WebSocket connection to/; // lines of the console

let browser = null;

function findChromium() {
  if (process.env.MJARM_TEST_BROWSER) return process.env.MJARM_TEST_BROWSER;
  const folders = (process.env.PATH ?? '').split(delimiter);
  return NAMES.flatMap((name) => folders.map((folder) => join(folder, name))).find((path) => existsSync(path));
}

/** Why there can be no browser; empty where there can. @returns {Promise<string>} */
export async function whatIsMissing() {
  if (!findChromium()) {
    return 'no Chromium (apt-get install --no-install-recommends chromium, or MJARM_TEST_BROWSER=PROGRAM)';
  }
  const packages = await Promise.allSettled([import('playwright-core'), import('ws')]);
  return packages.every(({ status }) => status === 'fulfilled') ? '' : 'playwright-core and ws are not installed (npm ci)';
}

export async function openBrowser() {
  const { chromium } = await import('playwright-core');
  browser = await chromium.launch({ executablePath: findChromium(), args: DRAWN_BY_PROCESSOR });
}

export function closeBrowser() {
  return browser?.close();
}

/**
 * A page of the server, as somebody who is here for the first time sees it.
 * @param {string} url
 * @param {object} [options]
 * @param {[number, number]} [options.size]  [pixels]
 * @param {'light'|'dark'} [options.theme]  of the system
 * @param {boolean} [options.phone]
 * @param {number} [options.scale]  pixels of the device a pixel; few are drawn in less time
 * @param {Object<string, string>} [options.settings]  remembered from earlier visits
 * @param {boolean} [options.offline]  there is no network
 */
export async function openPage(url, { size = [800, 480], theme = 'light', phone = false, scale = 0.5, settings = {}, offline = false } = {}) {
  const context = await browser.newContext({
    viewport: { width: size[0], height: size[1] }, colorScheme: theme, reducedMotion: 'reduce', deviceScaleFactor: scale,
    hasTouch: phone, isMobile: phone, offline,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(LONG);
  page.faults = [];
  page.on('pageerror', (error) => page.faults.push(error.stack));
  page.on('console', (line) => {
    if (['error', 'warning'].includes(line.type()) && !HARMLESS.test(line.text())) page.faults.push(line.text());
  });
  await page.addInitScript((kept) => {
    for (const [name, value] of Object.entries(kept)) localStorage.setItem(`mjarm.${name}`, value);
  }, settings);
  await page.goto(url);
  await page.waitForFunction(() => window.mjarm?.ready && window.mjarm.frame >= 0, null, { timeout: LOADING });
  return page;
}

/** A control by its data-test. */
export function byTest(page, name) {
  return page.locator(`[data-test="${name}"]`);
}

/** Waits for something of the page alone: `condition` is called there. */
export function untilPage(page, condition, argument) {
  return page.waitForFunction(condition, argument);
}

/** Lets keys go to the scene. */
export function toScene(page) {
  return byTest(page, 'canvas').focus();
}

/** Presses at a point and moves to others. @param {[number, number][]} points @param {'left'|'right'} [button] */
export async function dragMouse(page, points, button = 'left') {
  const [first, ...others] = points;
  await page.mouse.move(...first);
  await page.mouse.down({ button });
  for (const point of others) await page.mouse.move(...point, { steps: 3 });
  await page.mouse.up({ button });
}

/** Middle of a control, [pixels]; `shareX` from its left to its right. */
export async function pixelOf(locator, shareX = 0.5) {
  await locator.scrollIntoViewIfNeeded();
  const box = await locator.boundingBox();
  return [box.x + shareX * box.width, box.y + box.height / 2];
}
