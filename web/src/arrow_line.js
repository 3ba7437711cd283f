// A straight line with a head, of the same width on the screen however far it is.
import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, SphereGeometry, Vector3 } from 'three';
import { colorOf } from './paint.js';

const Z = new Vector3(0, 0, 1);
const SHAFT = 1.6; // [pixels] radius
const HEAD = 5; // [pixels] radius
const HEAD_LENGTH = 14; // [pixels]

export class ArrowLine {
  object = new Group();
  #shaft;
  #head;
  #ball;

  /** @param {number[]} rgba */
  constructor(rgba) {
    const paint = new MeshLambertMaterial({ color: colorOf(rgba) });
    this.#shaft = new Mesh(new CylinderGeometry(1, 1, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5), paint);
    this.#head = new Mesh(new ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5), paint);
    this.#ball = new Mesh(new SphereGeometry(1, 16, 12), paint);
    this.object.add(this.#shaft, this.#head, this.#ball);
    this.object.visible = false;
  }

  /** @param {Vector3} from @param {Vector3} to @param {number} pixel  [m] that one stands for */
  set(from, to, pixel) {
    const way = to.clone().sub(from);
    const length = way.length();
    this.object.visible = true;
    this.object.position.copy(from);
    this.object.quaternion.setFromUnitVectors(Z, length > 0 ? way.divideScalar(length) : Z);
    const head = Math.min(HEAD_LENGTH * pixel, length);
    this.#shaft.scale.set(SHAFT * pixel, SHAFT * pixel, Math.max(length - head, 1e-6));
    this.#head.scale.set(HEAD * pixel, HEAD * pixel, Math.max(head, 1e-6));
    this.#head.position.set(0, 0, length - head);
    this.#ball.scale.setScalar(3.4 * pixel);
  }
}
