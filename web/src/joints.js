// Sliders of the joints: degrees for those that turn, metres for those that slide.
import { dial } from './dial.js';
import { section } from './section.js';
import { onLanguage, label, t } from './words.js';

const DEGREE = 180 / Math.PI;
const FREE_TURN = 2 * Math.PI; // [rad] ends of a slider of a joint without stops
const FREE_WAY = 1; // [m]

/**
 * @param {object[]} joints  see options.joints of scene.json
 * @param {import('./outbox.js').Outbox} outbox
 * @returns {{node: HTMLElement, show: (qpos: Float32Array) => void, enable: (on: boolean) => void}|null}
 */
export function jointSection(joints, outbox) {
  if (!joints?.length) return null;
  const rows = joints.map((joint) => jointDial(joint, outbox));
  const { node } = section({ test: 'joints', word: 'joints', open: true, children: rows.map((row) => row.dial.node) });
  onLanguage(() => {
    for (const row of rows) label(row.field, t('joint_value', row.joint.name));
  });
  return {
    node,
    show(qpos) {
      for (const { joint, scale, dial: own } of rows) own.show(qpos[joint.qpos] * scale);
    },
    enable(on) {
      for (const row of rows) row.dial.enable(on);
    },
  };
}

function jointDial(joint, outbox) {
  const scale = joint.angle ? DEGREE : 1;
  const free = joint.angle ? FREE_TURN : FREE_WAY;
  const own = dial({
    name: joint.name, test: `joint-${joint.name}`, valueName: t('joint_value', joint.name),
    lower: (joint.lower ?? -free) * scale, upper: (joint.upper ?? free) * scale,
    endless: joint.lower === null || joint.upper === null,
    step: joint.angle ? 1 : 0.001, digits: joint.angle ? 1 : 4, unit: joint.angle ? '°' : 'm',
    onValue: (value) => outbox.sendLatest(`joint ${joint.dof}`, {
      type: 'joint', dof: joint.dof, value: clampTo(joint, value / scale),
    }),
  });
  return { joint, scale, dial: own, field: own.node.querySelector('.number') };
}

/** Degrees and back must not end beyond a stop. */
function clampTo({ lower, upper }, value) {
  return Math.min(upper ?? Infinity, Math.max(lower ?? -Infinity, value));
}
