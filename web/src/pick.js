// What is under a pixel.
import { Raycaster, Vector2 } from 'three';

const caster = new Raycaster();

export class Picker {
  #stage;
  #model;

  constructor(stage, model) {
    this.#stage = stage;
    this.#model = model;
  }

  /** The line of sight through a pixel of the canvas. @returns {import('three').Ray} */
  ray(x, y) {
    this.#aim(x, y);
    return caster.ray.clone();
  }

  /** @returns {{body: number, geom: number, point: import('three').Vector3}|null} */
  geomAt(x, y) {
    this.#aim(x, y);
    const hit = caster.intersectObjects(this.#model.targets(), false)[0];
    if (!hit) return null;
    const { body, geom } = hit.object.userData;
    return { body, geom, point: hit.point, distance: hit.distance };
  }

  /** The first of `objects` that is hit. @returns {import('three').Intersection|null} */
  firstOf(objects, x, y) {
    this.#aim(x, y);
    return caster.intersectObjects(objects, false)[0] ?? null;
  }

  #aim(x, y) {
    const { width, height, camera } = this.#stage;
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), camera);
  }
}
