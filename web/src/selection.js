// The card of the body that is selected.
import { byTest, el, icon } from './dom.js';
import { fill, onLanguage, t } from './words.js';

export class Selection {
  body = -1;
  #geom = -1;
  #scene;
  #model;
  #outbox;
  #card = byTest('selection');
  #position = el('dd', { test: 'selection-position' });
  #quaternion = el('dd', { test: 'selection-quaternion' });

  constructor({ scene, model, outbox }) {
    this.#scene = scene;
    this.#model = model;
    this.#outbox = outbox;
    onLanguage(() => this.body >= 0 && this.#build());
  }

  /** @param {{body: number, geom: number, point: import('three').Vector3}|null} hit */
  take(hit) {
    this.body = hit && hit.body > 0 ? hit.body : -1;
    this.#geom = hit?.geom ?? -1;
    const point = hit?.point.toArray() ?? [0, 0, 0];
    this.#outbox.send({ type: 'select', body: this.body, geom: this.body < 0 ? -1 : this.#geom, point });
    this.#model.select(this.body);
    this.#card.hidden = this.body < 0;
    if (this.body >= 0) this.#build();
  }

  /** With each frame. */
  update() {
    if (this.body < 0) return;
    const { p, q } = this.#model.bodyPose(this.body);
    this.#position.textContent = [p.x, p.y, p.z].map((x) => x.toFixed(4)).join('  ');
    this.#quaternion.textContent = [q.w, q.x, q.y, q.z].map((x) => x.toFixed(3)).join('  ');
  }

  #build() {
    const close = el('button', {
      type: 'button', class: 'tool', test: 'deselect', wordLabel: 'deselect', on: { click: () => this.take(null) },
    }, icon('close'));
    const name = this.#scene.bodies[this.body] || `${t('body')} ${this.body}`;
    const geom = this.#scene.geoms[this.#geom];
    const facts = el('dl', { class: 'facts' });
    if (geom) facts.append(el('dt', { word: 'geom' }), el('dd', {}, geom.name || `${this.#geom} (${geom.kind})`));
    facts.append(el('dt', { word: 'position' }), this.#position, el('dt', { word: 'quaternion' }), this.#quaternion);
    this.#card.replaceChildren(el('h2', {}, el('span', { test: 'selection-name' }, name), close), facts);
    fill(this.#card);
    this.update();
  }
}
