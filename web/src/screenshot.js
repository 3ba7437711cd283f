// The picture of the scene as a PNG file.
import { el } from './dom.js';
import { t } from './words.js';

/**
 * @param {import('./stage.js').Stage} stage
 * @param {string} name  of the model
 * @param {import('./notices.js').Notices} notices
 */
export async function saveScreenshot(stage, name, notices) {
  const picture = await stage.picture();
  if (!picture) {
    notices.say(t('not_saved'), true);
    return;
  }
  const stamp = new Date().toISOString().slice(0, 19).replace(/[-:]/g, '').replace('T', '-');
  const file = `${name || 'mjarm'}-${stamp}.png`;
  const address = URL.createObjectURL(picture);
  el('a', { href: address, download: file }).click();
  setTimeout(() => URL.revokeObjectURL(address), 30000);
  notices.say(t('saved', file));
}
