// Pause, steps, reset and speed.
import { byTest, el } from './dom.js';
import { label, onLanguage, t } from './words.js';

const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

export class Transport {
  paused = false;
  speed = 1;
  #outbox;
  #may;
  #nodes;
  #meant = null; // what was asked for and has not come yet

  /** @param {import('./outbox.js').Outbox} outbox @param {object} may  see options of scene.json */
  constructor(outbox, may) {
    this.#outbox = outbox;
    this.#may = may;
    this.#nodes = {
      pause: byTest('pause'), step: byTest('step'), back: byTest('step-back'), reset: byTest('reset'),
      slower: byTest('slower'), faster: byTest('faster'), speed: byTest('speed'), clock: byTest('time'),
    };
    const { pause, step, back, reset, slower, faster, speed } = this.#nodes;
    speed.append(...SPEEDS.map((value) => el('option', { value }, `${value} ×`)));
    speed.value = '1';
    pause.addEventListener('click', () => this.togglePause());
    step.addEventListener('click', () => this.step(1));
    back.addEventListener('click', () => this.step(-1));
    reset.addEventListener('click', () => this.reset());
    slower.addEventListener('click', () => this.changeSpeed(-1));
    faster.addEventListener('click', () => this.changeSpeed(1));
    speed.addEventListener('change', () => this.setSpeed(Number(speed.value)));
    onLanguage(() => this.#draw());
    this.enable(true);
  }

  /** @param {import('./source.js').Frame} frame */
  show(frame) {
    this.#nodes.clock.textContent = `${frame.time.toFixed(3)} s`;
    if (frame.paused === this.#meant) this.#meant = null;
    if (frame.paused === this.paused) return;
    this.paused = frame.paused;
    this.#draw();
  }

  togglePause() {
    if (!this.#on) return;
    this.#meant = !(this.#meant ?? this.paused);
    this.#outbox.send({ type: 'pause', paused: this.#meant });
  }

  step(steps) {
    if (this.#on && this.#may.can_step) this.#outbox.send({ type: 'step', steps });
  }

  reset() {
    if (this.#on && this.#may.can_reset) this.#outbox.send({ type: 'reset' });
  }

  setSpeed(speed) {
    if (!this.#on) return;
    this.speed = speed;
    this.#nodes.speed.value = String(speed);
    this.#outbox.send({ type: 'speed', speed });
    this.#draw();
  }

  /** @param {1|-1} way */
  changeSpeed(way) {
    const next = SPEEDS[SPEEDS.indexOf(this.speed) + way];
    if (next !== undefined) this.setSpeed(next);
  }

  #on = true;
  enable(on) {
    this.#on = on;
    const { pause, step, back, reset, speed } = this.#nodes;
    pause.disabled = speed.disabled = !on;
    step.disabled = back.disabled = !(on && this.#may.can_step);
    reset.disabled = !(on && this.#may.can_reset);
    this.#draw();
  }

  #draw() {
    const { pause, clock, slower, faster } = this.#nodes;
    const at = SPEEDS.indexOf(this.speed);
    slower.disabled = !this.#on || at <= 0;
    faster.disabled = !this.#on || at >= SPEEDS.length - 1;
    pause.setAttribute('aria-pressed', String(this.paused));
    pause.querySelector('use').setAttribute('href', this.paused ? '#i-play' : '#i-pause');
    label(pause, t(this.paused ? 'resume' : 'pause'));
    clock.classList.toggle('paused', this.paused);
    clock.dataset.paused = t('paused');
  }
}
