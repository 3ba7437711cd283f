// The bodies and their geoms.
import { Box3, BufferGeometry, Group, Mesh, Quaternion, Sphere, Vector3 } from 'three';
import { geometryOf } from './geometry.js';
import { readMesh } from './mesh_file.js';
import { FloorLook } from './floor.js';
import { litUp, Paints } from './paint.js';

const COLLISION = 3; // groups from here on are collision shapes
const HIGHLIGHT = '#ff9a3c';
const SEEN = 2e-6; // [m, or of a quaternion] less is not seen

export class Model {
  /** @type {Group[]} */
  bodies = [];
  floor = new FloorLook();
  ready = false;
  #geoms = []; // {geom, mesh}
  #groups = [true, true, true, false, false, false];
  #paints = new Paints();
  #scene;
  #stage;
  #selected = -1;
  #poses = null;
  /** Called where shapes of ghosts have to be looked up again. */
  onShapes = null;

  /** @param {object} scene  see scene.json @param {import('./stage.js').Stage} stage */
  constructor(scene, stage) {
    this.#scene = scene;
    this.#stage = stage;
    for (const name of scene.bodies) {
      const body = new Group();
      body.name = name;
      this.bodies.push(body);
      stage.scene.add(body);
    }
    scene.geoms.forEach((geom, index) => this.#add(geom, index));
    if (!scene.geoms.some((geom) => geom.kind === 'plane')) this.#addGrid();
    this.#show();
  }

  /**
   * Fetches every mesh once.
   * @param {import('./source.js').Source} source
   * @param {(loaded: number, all: number) => void} tell
   * @returns {Promise<number>} how many could not be had
   */
  async load(source, tell) {
    const all = this.#scene.meshes?.length ?? 0;
    const used = new Set(this.#scene.geoms.filter((g) => g.kind === 'mesh').map((g) => g.mesh));
    const wanted = [...used].filter((index) => index >= 0 && index < all);
    let [done, failed] = [0, 0];
    tell(0, wanted.length);
    await Promise.all(wanted.map(async (index) => {
      try {
        this.#putMesh(index, readMesh(await source.mesh(index)));
      } catch {
        ++failed;
      }
      tell(++done, wanted.length);
    }));
    this.ready = true;
    this.onShapes?.();
    return failed;
  }

  /** @param {Float32Array} poses  see Frame.bodies @returns {boolean} whether anything moved visibly */
  pose(poses) {
    if (this.#poses && poses.every((value, index) => Math.abs(value - this.#poses[index]) < SEEN)) return false;
    this.#poses = poses;
    this.bodies.forEach((body, index) => {
      const at = 7 * index;
      body.position.set(poses[at], poses[at + 1], poses[at + 2]);
      body.quaternion.set(poses[at + 4], poses[at + 5], poses[at + 6], poses[at + 3]);
      body.updateMatrix();
      body.updateMatrixWorld(true);
    });
    this.#stage.changed(true);
    return true;
  }

  /** Pose of a body in the world. */
  bodyPose(index) {
    const body = this.bodies[index] ?? this.bodies[0];
    return { p: body.position, q: body.quaternion };
  }

  get groups() {
    return this.#groups.slice();
  }

  setGroup(group, on) {
    this.#groups[group] = on;
    this.#show();
  }

  get collision() {
    return this.#groups.slice(COLLISION).some(Boolean);
  }

  setCollision(on) {
    for (let group = COLLISION; group < 6; ++group) this.#groups[group] = on;
    this.#show();
  }

  /** Groups that have shapes. */
  usedGroups() {
    return [...new Set(this.#geoms.map(({ geom }) => geom.group))].sort();
  }

  setPalette(palette) {
    this.floor.setPalette(palette);
    this.#stage.changed();
  }

  /** Meshes that can be hit by a ray; `userData.geom` is the index of the geom. */
  targets() {
    return this.#geoms.filter(({ mesh }) => mesh.visible).map(({ mesh }) => mesh);
  }

  /** Shapes of a body that are shown, for its ghosts. @returns {Mesh[]} */
  shapesOf(body) {
    return this.#geoms
      .filter(({ geom, mesh }) => geom.body === body && mesh.visible && geom.kind !== 'plane' && geom.group < COLLISION)
      .map(({ mesh }) => mesh);
  }

  select(body) {
    if (body === this.#selected) return;
    this.#selected = body;
    for (const { geom, mesh } of this.#geoms) {
      if (geom.kind === 'plane') continue;
      const lit = geom.body === body && body > 0;
      if (mesh.material !== mesh.userData.paint) mesh.material.dispose();
      mesh.material = lit ? litUp(mesh.userData.paint, HIGHLIGHT) : mesh.userData.paint;
    }
    this.#stage.changed();
  }

  /** Mass of a body [kg]; 0 where it cannot move. */
  massOf(body) {
    return this.#scene.masses[body] ?? 0;
  }

  /** A ball round all that is shown, planes left out. @returns {Sphere} */
  bounds() {
    const box = new Box3();
    const ball = new Sphere();
    for (const { geom, mesh } of this.#geoms) {
      if (geom.kind === 'plane' || !mesh.visible || !mesh.geometry.attributes.position) continue;
      if (!mesh.geometry.boundingSphere) mesh.geometry.computeBoundingSphere();
      ball.copy(mesh.geometry.boundingSphere).applyMatrix4(mesh.matrixWorld);
      if (ball.radius > 0) box.union(ball.getBoundingBox(new Box3()));
    }
    if (box.isEmpty()) return new Sphere(new Vector3(0, 0, 0.3), 0.6);
    const out = box.getBoundingSphere(new Sphere());
    out.radius = Math.max(out.radius * 0.86, 0.05); // the ball round a box is larger than need be
    return out;
  }

  #add(geom, index) {
    const plane = geom.kind === 'plane';
    const clear = geom.group >= COLLISION ? 0.45 : 1;
    const paint = plane ? this.floor.material(geom.rgba) : this.#paints.of(geom.rgba, clear);
    const mesh = new Mesh(geometryOf(geom) ?? new BufferGeometry(), paint);
    mesh.position.set(...geom.pos);
    const [w, x, y, z] = geom.quat;
    mesh.quaternion.copy(new Quaternion(x, y, z, w));
    mesh.updateMatrix();
    mesh.matrixAutoUpdate = false;
    mesh.castShadow = !plane && (geom.rgba[3] ?? 1) >= 1 && geom.group < COLLISION;
    mesh.receiveShadow = true;
    mesh.renderOrder = plane ? -10 : 0; // the floor fades, so it is drawn before what stands on it
    mesh.userData = { geom: index, body: geom.body, paint };
    this.bodies[geom.body].matrixAutoUpdate = false;
    this.bodies[geom.body].add(mesh);
    this.#geoms.push({ geom, mesh });
  }

  /** Where a model has no floor there are lines at z = 0. */
  #addGrid() {
    const mesh = new Mesh(geometryOf({ kind: 'plane', size: [0, 0] }), this.floor.material(null));
    mesh.renderOrder = -10;
    mesh.material.depthWrite = false;
    this.#stage.scene.add(mesh);
  }

  #putMesh(index, geometry) {
    for (const { geom, mesh } of this.#geoms) {
      if (geom.kind === 'mesh' && geom.mesh === index) mesh.geometry = geometry;
    }
    this.#stage.changed(true);
  }

  #show() {
    for (const { geom, mesh } of this.#geoms) {
      mesh.visible = (this.#groups[geom.group] ?? false) && (geom.rgba[3] ?? 1) > 0;
    }
    this.onShapes?.();
    this.#stage.changed(true);
  }
}
