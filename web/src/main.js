// The page: what there is, and what tells whom.
import { LiveSource } from './live_source.js';
import { startPage } from './page.js';
import { RecordedSource } from './recorded_source.js';
import { recall } from './settings.js';
import { theme } from './theme.js';
import { setLanguage, t } from './words.js';
import { Notices } from './notices.js';

const PROTOCOL = 1;

async function main() {
  theme.start();
  setLanguage(recall('language') ?? navigator.language);
  const notices = new Notices();
  const source = recordedHere() ?? new LiveSource(new URL('.', window.location.href));
  source.on('connection', (connection) => showConnection(connection, source, notices));
  const again = { word: 'retry', run: () => source.retry() };
  source.on('bye', ({ what }) => notices.show({ title: 'over', more: 'over_more', text: what, action: again }));
  source.on('error', ({ what }) => notices.say(t('refused', what), true));
  source.on('replaced', () => window.location.reload());
  for (const event of ['online', 'pageshow']) window.addEventListener(event, () => source.retry());
  document.addEventListener('visibilitychange', () => document.hidden || source.retry());

  notices.show({ title: 'connecting' });
  const scene = await source.scene();
  setLanguage(recall('language') ?? scene.language);
  if (scene.protocol !== PROTOCOL) {
    notices.show({ title: 'wrong_protocol', more: 'wrong_protocol_more', bad: true });
    return;
  }
  startPage(scene, source, notices);
}

/** The run that is in this file; null where there is none. */
function recordedHere() {
  const run = document.getElementById('run');
  if (!run) return null;
  const packed = (name) => document.getElementById(name)?.textContent ?? null;
  return new RecordedSource(JSON.parse(run.textContent), { run: packed('run-bytes'), ik: packed('ik-bytes') });
}

function showConnection(connection, source, notices) {
  if (connection === 'open') notices.hide();
  if (connection === 'lost') {
    const action = { word: 'retry', run: () => source.retry() };
    notices.show({ title: 'lost', more: 'lost_more', bad: true, action });
  }
}

main();
