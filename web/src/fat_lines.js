// Lines with a width, as many pieces as wanted, changed in place.
import { InstancedInterleavedBuffer, InterleavedBufferAttribute } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { colorOf } from './paint.js';

const THINNEST = 1.5; // [pixels]
const THICKEST = 14; // [pixels]

export class FatLines {
  object;
  width = 0.003; // [m]
  #room = 0;
  #ends;
  #lengths;

  constructor() {
    const material = new LineMaterial({ linewidth: 2 });
    this.object = new LineSegments2(new LineSegmentsGeometry(), material);
    this.object.frustumCulled = false;
    this.object.raycast = () => {};
  }

  /**
   * @param {number} count  of pieces
   * @param {(index: number, end: 0|1) => number[]} at  where they begin and end [m]
   * @param {{rgba: number[], width: number, dash?: number}} look
   */
  set(count, at, { rgba, width, dash = 0 }) {
    if (!this.#ends || count > this.#room) this.#grow(count);
    const [ends, lengths] = [this.#ends.array, this.#lengths.array];
    let way = 0;
    for (let i = 0; i < count; ++i) {
      const [a, b] = [at(i, 0), at(i, 1)];
      ends.set(a, 6 * i);
      ends.set(b, 6 * i + 3);
      lengths[2 * i] = way;
      way += Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      lengths[2 * i + 1] = way;
    }
    this.#ends.needsUpdate = this.#lengths.needsUpdate = true;
    this.object.geometry.instanceCount = count;
    this.object.visible = count > 0;
    this.#paint(rgba, dash);
    this.width = width;
  }

  /** @param {number} pixel  [m] that one stands for where the line is */
  look(pixel) {
    const { material } = this.object;
    material.linewidth = Math.max(THINNEST, Math.min(THICKEST, this.width / pixel));
  }

  dispose() {
    this.object.removeFromParent();
    this.object.geometry.dispose();
    this.object.material.dispose();
  }

  #paint(rgba, dash) {
    const { material } = this.object;
    material.color = colorOf(rgba);
    material.opacity = rgba[3] ?? 1;
    material.transparent = material.opacity < 1;
    if (material.dashed !== dash > 0) material.dashed = dash > 0;
    material.dashSize = material.gapSize = dash || 1;
  }

  #grow(count) {
    this.#room = Math.max(64, 2 * count);
    const geometry = new LineSegmentsGeometry();
    this.#ends = new InstancedInterleavedBuffer(new Float32Array(6 * this.#room), 6, 1);
    this.#lengths = new InstancedInterleavedBuffer(new Float32Array(2 * this.#room), 2, 1);
    const parts = [['instanceStart', this.#ends, 3, 0], ['instanceEnd', this.#ends, 3, 3],
      ['instanceDistanceStart', this.#lengths, 1, 0], ['instanceDistanceEnd', this.#lengths, 1, 1]];
    for (const [name, buffer, size, at] of parts) {
      geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, size, at));
    }
    this.object.geometry.dispose();
    this.object.geometry = geometry;
  }
}
