// Many balls in few draws: one for each opacity.
import { Group, InstancedMesh, Matrix4, MeshStandardMaterial, SphereGeometry } from 'three';
import { colorOf } from './paint.js';

const FINE = new SphereGeometry(1, 24, 16);
const COARSE = new SphereGeometry(1, 12, 8);
const MANY = 300;
const matrix = new Matrix4();

export class Balls {
  object = new Group();
  #sets = new Map();

  /** @param {{pos: number[], radius: number, rgba: number[]}[]} items */
  set(items) {
    const parts = new Map();
    for (const item of items) {
      const opacity = Math.round(20 * (item.rgba[3] ?? 1)) / 20;
      if (!parts.has(opacity)) parts.set(opacity, []);
      parts.get(opacity).push(item);
    }
    for (const [opacity, mesh] of this.#sets) if (!parts.has(opacity)) mesh.count = 0;
    for (const [opacity, part] of parts) this.#fill(this.#room(opacity, part.length), part);
  }

  #fill(mesh, items) {
    mesh.count = items.length;
    mesh.geometry = items.length > MANY ? COARSE : FINE;
    items.forEach((item, index) => {
      matrix.makeScale(item.radius, item.radius, item.radius).setPosition(...item.pos);
      mesh.setMatrixAt(index, matrix);
      mesh.setColorAt(index, colorOf(item.rgba));
    });
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }

  #room(opacity, wanted) {
    const old = this.#sets.get(opacity);
    if (old && old.instanceMatrix.count >= wanted) return old;
    if (old) {
      this.object.remove(old);
      old.dispose();
    }
    const paint = new MeshStandardMaterial({
      roughness: 0.6, opacity, transparent: opacity < 1, depthWrite: opacity >= 1,
    });
    const mesh = new InstancedMesh(FINE, paint, Math.max(16, 2 * wanted));
    mesh.frustumCulled = false;
    this.#sets.set(opacity, mesh);
    this.object.add(mesh);
    return mesh;
  }
}
