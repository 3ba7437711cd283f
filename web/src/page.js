// Puts the parts of the page together for one scene.
import { byTest } from './dom.js';
import { Eye } from './eye.js';
import { GhostTool } from './ghost_tool.js';
import { Help } from './help.js';
import { jointSection } from './joints.js';
import { listenToKeys } from './keys.js';
import { Layout } from './layout.js';
import { Lead } from './lead.js';
import { Menu } from './menu.js';
import { Model } from './model.js';
import { Outbox } from './outbox.js';
import { Overlay } from './overlay.js';
import { Panels } from './panels.js';
import { Picker } from './pick.js';
import { Plots } from './plots.js';
import { PointerHub } from './pointer.js';
import { exposeProbe } from './probe.js';
import { Push } from './push.js';
import { Readout } from './readout.js';
import { saveScreenshot } from './screenshot.js';
import { Selection } from './selection.js';
import { Stage } from './stage.js';
import { Target } from './target.js';
import { theme } from './theme.js';
import { Transport } from './transport.js';
import { Triad } from './triad.js';
import { ViewBar } from './view_bar.js';
import { fill, onLanguage, t } from './words.js';

const LARGEST_REGION = 6; // [m] of light and shadow
const FLOOR_REACH = 7; // in distances of the view

/**
 * @param {object} scene  see scene.json
 * @param {import('./source.js').Source} source
 * @param {import('./notices.js').Notices} notices
 */
export function startPage(scene, source, notices) {
  document.title = scene.title;
  byTest('title').textContent = scene.title;
  let stage;
  try {
    stage = new Stage(byTest('canvas'));
  } catch {
    notices.show({ title: 'no_webgl', more: 'no_webgl_more', bad: true });
    return;
  }
  const page = build(scene, source, notices, stage);
  wireControls(page, scene.options);
  listenToSource(page, source);
  followLooks(page);
  run(page, source);
  exposeProbe(page);
  source.start();
  page.model.load(source, showLoading).then((failed) => {
    page.seeAll();
    if (failed > 0) notices.say(t('no_mesh', failed), true);
  });
}

function showLoading(loaded, all) {
  const line = byTest('loading');
  line.hidden = loaded >= all;
  line.textContent = t('loading_meshes', loaded, all);
  byTest('view').setAttribute('aria-busy', String(loaded < all));
}

function build(scene, source, notices, stage) {
  const options = scene.options;
  const outbox = new Outbox(source);
  const model = new Model(scene, stage);
  const eye = new Eye(stage, scene, (body) => model.bodyPose(body));
  const picker = new Picker(stage, model);
  const readout = new Readout(byTest('readout'));
  const target = new Target({ stage, eye, picker, outbox, readout, turns: options.turns });
  const lead = new Lead(outbox, options.can_lead === true);
  const push = new Push({ stage, eye, picker, model, outbox, readout });
  const overlay = new Overlay({ stage, model, eye });
  const ghosts = new GhostTool({ picker, overlay, outbox, stage });
  const selection = new Selection({ scene, model, outbox });
  const transport = new Transport(outbox, options);
  const viewBar = new ViewBar(eye, model, scene.cameras);
  const onGroups = () => {
    menu.update();
    viewBar.update();
  };
  const menu = new Menu({ model, stage, overlay, onGroups });
  viewBar.onGroups = onGroups;
  const panels = new Panels(outbox);
  const joints = jointSection(options.joints, outbox);
  const side = byTest('side');
  if (joints) side.append(joints.node);
  side.append(panels.node);
  fill(side);
  return {
    scene, source, notices, stage, outbox, model, eye, picker, target, lead, push, ghosts, overlay, selection, transport,
    viewBar, menu, panels, joints, plots: new Plots(byTest('plots'), byTest('figures')),
    pointer: new PointerHub(stage.canvas, eye, [push, target, ghosts]), help: new Help(options.can_lead === true), layout: new Layout(),
    triad: new Triad(byTest('triad'), eye), last: { frame: null },
    /** Light and shadow for all that is shown. */
    seeAll() {
      const { center, radius } = model.bounds();
      stage.setRegion(center, Math.min(LARGEST_REGION, Math.max(0.4, 1.3 * radius)));
    },
  };
}

function wireControls(page, options) {
  const { outbox, stage, scene, notices, pointer, picker, ghosts, selection, transport, eye } = page;
  const act = {
    target: () => options.can_target && outbox.send({ type: 'target' }),
    screenshot: () => saveScreenshot(stage, scene.name, notices),
    deselect: () => selection.body >= 0 && selection.take(null),
  };
  byTest('target').addEventListener('click', act.target);
  byTest('target').hidden = !options.can_target;
  byTest('screenshot').addEventListener('click', act.screenshot);
  pointer.onClick = (where) => ghosts.click(where);
  pointer.onDouble = ({ x, y }) => selection.take(picker.geomAt(x, y));
  listenToKeys({ transport, eye, viewBar: page.viewBar, help: page.help, layout: page.layout, act });
}

function listenToSource(page, source) {
  const { overlay, plots, panels, target, notices } = page;
  const status = byTest('status');
  source.on('hello', ({ can_control: may }) => {
    target.renew();
    enable(page, may);
    if (!may) notices.say(t('read_only'));
  });
  source.on('overlay', ({ items }) => overlay.take(items));
  source.on('plots', (message) => plots.take(message.plots));
  source.on('panels', ({ sections }) => panels.take(sections));
  source.on('status', ({ line }) => {
    status.textContent = line;
    status.hidden = line === '';
  });
  source.on('target', (message) => {
    target.take(message);
    byTest('target').setAttribute('aria-pressed', String(message.shown));
  });
  source.on('connection', (connection) => {
    if (connection !== 'open') enable(page, false);
  });
}

/** Whether there is somebody who does what the controls say. */
function enable({ scene, transport, panels, joints, target, lead, push, ghosts }, on) {
  const { can_push: canPush, can_target: canTarget } = scene.options;
  transport.enable(on);
  panels.enable(on);
  joints?.enable(on);
  if (!on) {
    target.release();
    push.end();
  }
  target.enabled = ghosts.enabled = on;
  lead.enabled = on;
  push.enabled = on && canPush;
  byTest('target').disabled = !(on && canTarget);
}

function followLooks({ stage, model, overlay, plots, panels, eye, triad, viewBar, menu, notices }) {
  const repaint = (palette) => {
    stage.setPalette(palette);
    model.setPalette(palette);
    overlay.refresh();
    plots.refresh();
  };
  theme.on('change', repaint);
  repaint(theme.palette);
  onLanguage(() => panels.refresh());
  model.onShapes = () => overlay.refresh();
  const drawLess = () => {
    stage.setLow();
    menu.shadows.checked = false;
  };
  stage.onSlow = () => {
    drawLess();
    notices.say(t('quality_low'));
  };
  stage.onResize = () => eye.apply();
  if (stage.isSoftware) drawLess();
  eye.onChange = () => {
    triad.update();
    viewBar.update();
    model.floor.setView(eye.lookat, Math.max(4, FLOOR_REACH * eye.distance));
  };
  eye.apply();
}

/** Once a picture: takes the newest frame, lets the tools go on, draws. */
function run(page, source) {
  const {
    model, transport, joints, selection, eye, push, target, lead, overlay, plots, pointer, outbox, stage, last,
  } = page;
  const tick = (now) => {
    requestAnimationFrame(tick);
    const frame = source.takeFrame();
    let moved = false;
    if (frame) {
      const first = last.frame === null;
      last.frame = frame;
      moved = model.pose(frame.bodies);
      transport.show(frame);
      joints?.show(frame.qpos);
      plots.setTime(frame.time);
      selection.update();
      if (first) page.seeAll();
    }
    eye.tick(now, moved);
    pointer.update();
    push.update();
    target.update();
    lead.update(now);
    overlay.update();
    plots.update();
    outbox.flush();
    stage.draw(now);
  };
  requestAnimationFrame(tick);
}
