// A run that is in the file of the page itself: played, scrubbed, and nobody else needed. Where the
// file has the kinematics, too, its arm can be led by hand from where it stands.
import { ArmIk } from './arm_ik.js';
import { Emitter } from './emitter.js';
import { OwnTarget } from './own_target.js';
import { inflated, Unpacker } from './packed_run.js';
import { Recording } from './recording.js';
import { language, onLanguage, t } from './words.js';

const TIMELINE = 0; // number of its panel item
const END = 1e-9; // [s]

/** A line that grows with the time, up to a time; anything else as it is. */
function soFar(item, time) {
  if (!item.times) return item;
  const later = item.times.findIndex((at) => at > time + END);
  return later < 0 ? item : { ...item, points: item.points.slice(0, later) };
}

/** Is a {@link import('./source.js').Source}. */
export class RecordedSource extends Emitter {
  /** @type {import('./source.js').Connection} */
  connection = 'connecting';
  #run;
  #packed;
  #meshes = [];
  #recording = null;
  #ik = null;
  #target = null; // none where the file does not think
  #time = 0;
  #speed = 1;
  #paused = false;
  #number = 0;
  #last = 0; // [ms] of the clock of the page
  #said = new Map(); // by kind, what was told last
  #stale = true; // what is shown is not what is meant

  /**
   * @param {object} run  see mjarm/serve/run_page.cpp
   * @param {{run: string, ik: string|null}} packed  base64
   */
  constructor(run, packed) {
    super();
    this.#run = run;
    this.#packed = packed;
  }

  async scene() {
    const { scene, arm } = this.#run;
    const from = new Unpacker(await inflated(this.#packed.run));
    this.#meshes = scene.meshes.map((mesh) => from.mesh(mesh));
    this.#recording = new Recording(from, this.#run, scene.nq);
    if (this.#packed.ik && arm) {
      this.#ik = await ArmIk.load(await inflated(this.#packed.ik), arm, language());
      this.#target = new OwnTarget(this.#ik, arm);
    }
    this.#packed = null;
    return scene;
  }

  async mesh(index) {
    return this.#meshes[index];
  }

  start() {
    this.connection = 'open';
    this.emit('connection', this.connection);
    this.emit('hello', { can_control: true });
    this.emit('plots', this.#run.plots);
    onLanguage(() => {
      this.#ik?.setLanguage(language());
      this.#tell();
    });
    this.#tell();
    this.#last = performance.now();
  }

  retry() {}

  takeFrame() {
    const now = performance.now();
    if (!this.#paused) this.#go(this.#time + (this.#speed * (now - this.#last)) / 1000);
    this.#last = now;
    if (!this.#stale) return null;
    this.#stale = false;
    this.#tell();
    const frame = { number: ++this.#number, time: this.#time, paused: this.#paused, ...this.#here() };
    return this.#target?.posed(frame) ?? frame;
  }

  send(message) {
    if (this.#target?.handle(message, this.#here().qpos)) {
      if (this.#target.q) this.#paused = true;
      this.#stale = true;
    } else {
      this.#do[message.type]?.(message);
    }
    return true;
  }

  #do = {
    pause: ({ paused }) => {
      if (!paused && this.#time >= this.#recording.end - END) this.#go(0);
      if (!paused) this.#go(this.#time);
      this.#paused = paused;
      this.#stale = true;
    },
    speed: ({ speed }) => { this.#speed = speed; },
    reset: () => this.#go(0),
    step: ({ steps }) => {
      const { times } = this.#recording;
      const at = this.#recording.momentAt(this.#time + END);
      this.#go(times[Math.min(times.length - 1, Math.max(0, at + steps))]);
    },
    panel: ({ id, value }) => {
      if (id === TIMELINE) this.#go(value);
    },
  };

  #here() {
    return this.#recording.at(this.#time);
  }

  /** The arm is the recording's again; it stops at the end. */
  #go(time) {
    const { end } = this.#recording;
    this.#time = Math.min(end, Math.max(0, time));
    if (time >= end) this.#paused = true;
    this.#target?.follow(this.#here().qpos);
    this.#stale = true;
  }

  #tell() {
    const timeline = {
      id: TIMELINE, name: t('time'), enabled: true, kind: 'timeline', time: this.#time, end: this.#recording.end,
    };
    const sections = [{ title: t('recording'), open: true, items: [timeline] }];
    const { overlay, status } = this.#run;
    if (this.#target) sections.push(this.#target.section());
    const ghosts = this.#target?.ghosts() ?? [];
    const items = overlay.items.map((item) => soFar(item, this.#time));
    this.#say('panels', { sections });
    this.#say('overlay', { items: [...items, ...ghosts] }, [ghosts, items.map((item) => item.points?.length)]);
    this.#say('status', { line: this.#target?.line() || status.line });
    if (this.#target) this.#say('target', this.#target.look());
  }

  /** Where it is new. @param {object} key  what tells that */
  #say(kind, message, key = message) {
    const text = JSON.stringify(key);
    if (this.#said.get(kind) === text) return;
    this.#said.set(kind, text);
    this.emit(kind, message);
  }
}
