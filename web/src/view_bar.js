// Cameras, presets, fit and the switch of collision shapes, over the scene.
import { byTest, el } from './dom.js';
import { onLanguage, t } from './words.js';

/** Headings and pitches of the presets: from the front one looks against +x. */
export const PRESETS = { front: [Math.PI, 0], side: [Math.PI / 2, 0], top: [Math.PI / 2, -Math.PI / 2] };

export class ViewBar {
  #eye;
  #model;
  #cameras;
  #menu = byTest('camera');
  #collision = byTest('collision');
  /** Called after a switch of groups. */
  onGroups = null;

  constructor(eye, model, cameras) {
    this.#eye = eye;
    this.#model = model;
    this.#cameras = cameras ?? [];
    for (const name of Object.keys(PRESETS)) {
      byTest(`view-${name}`).addEventListener('click', () => this.preset(name));
    }
    byTest('fit').addEventListener('click', () => this.fit());
    this.#menu.addEventListener('change', () => this.#choose(this.#menu.value));
    this.#collision.addEventListener('click', () => this.toggleCollision());
    this.#collision.hidden = !model.usedGroups().some((group) => group >= 3);
    onLanguage(() => this.#words());
    this.#words();
  }

  preset(name) {
    this.#eye.face(...PRESETS[name]);
  }

  fit() {
    const { center, radius } = this.#model.bounds();
    this.#eye.fit(center, radius);
  }

  firstView() {
    this.#eye.firstView();
  }

  /** The next camera of the model, or the one before; the free view is among them. */
  nextCamera(way) {
    const count = this.#cameras.length + 1;
    this.#eye.choose(((this.#eye.chosen + 1 + way + count) % count) - 1);
  }

  toggleCollision() {
    this.#model.setCollision(!this.#model.collision);
    this.update();
    this.onGroups?.();
  }

  /** After any change of the view. */
  update() {
    this.#collision.setAttribute('aria-pressed', String(this.#model.collision));
    const now = String(this.#eye.chosen);
    if (this.#menu.value !== now) this.#menu.value = now;
  }

  #choose(value) {
    if (value === 'first') this.firstView();
    else this.#eye.choose(Number(value));
    this.update();
  }

  #words() {
    this.#menu.replaceChildren(
      el('option', { value: '-1' }, t('free_camera')), el('option', { value: 'first' }, t('first_view')),
      ...this.#cameras.map(({ name }, index) => el('option', { value: index }, name || `${t('camera')} ${index + 1}`)),
    );
    this.update();
  }
}
