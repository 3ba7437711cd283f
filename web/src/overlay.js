// What is drawn on top of the model: the items of the newest `overlay` message.
import { Group } from 'three';
import { ARTISTS } from './overlay_items.js';
import { Balls } from './balls.js';

export class Overlay {
  items = [];
  #root = new Group();
  #front = new Group();
  #kept = new Map(); // artists by what they can be used again for
  #balls = new Balls();
  #around;
  #stage;
  #labels = true;

  /** @param {{stage: object, model: object, eye: object}} around  what artists look things up in */
  constructor(around) {
    this.#around = around;
    this.#stage = around.stage;
    this.#root.add(this.#balls.object);
    around.stage.scene.add(this.#root);
    around.stage.front.add(this.#front);
  }

  /** @param {object[]} items */
  take(items) {
    this.items = items;
    const before = this.#kept;
    this.#kept = new Map();
    this.#balls.set(items.filter((item) => item.kind === 'sphere'));
    for (const item of items) {
      const kind = ARTISTS[item.kind];
      if (!kind) continue;
      const key = kind.key(item);
      const artist = before.get(key)?.pop() ?? this.#make(kind, item);
      artist.set(item);
      if (!this.#kept.has(key)) this.#kept.set(key, []);
      this.#kept.get(key).push(artist);
    }
    for (const artists of before.values()) for (const artist of artists) artist.dispose();
    this.#stage.changed();
  }

  /** Everything anew: the shapes of the model, or the colours of the page, are others. */
  refresh() {
    for (const artists of this.#kept.values()) for (const artist of artists) artist.dispose();
    this.#kept.clear();
    this.take(this.items);
  }

  get labels() {
    return this.#labels;
  }

  setLabels(on) {
    this.#labels = on;
    this.#front.visible = on;
    this.#stage.changed();
  }

  /** Before each picture: what is of one size on the screen. */
  update() {
    for (const artists of this.#kept.values()) for (const artist of artists) artist.look?.();
  }

  /** Meshes of ghosts that can be clicked; `userData.ghost` is the item. */
  clickable() {
    const out = [];
    for (const artists of this.#kept.values()) {
      for (const artist of artists) if (artist.item?.item >= 0 && artist.meshes) out.push(...artist.meshes);
    }
    return out;
  }

  #make(kind, item) {
    return kind.make(item, { ...this.#around, root: this.#root, front: this.#front });
  }
}
