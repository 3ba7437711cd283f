// The camera: turned about a point, or one of the model's own.
import { Matrix4, Quaternion, Vector3 } from 'three';
import { mayGlide } from './motion.js';

const STEEPEST = Math.PI / 2;
const GLIDE = 220; // [ms]
const FOVY = 0.78; // [rad] of the free view
const WIDEST = 1.15; // [rad] of it where the picture is narrow

const basis = new Matrix4();

export class Eye {
  lookat = new Vector3();
  distance = 2;
  azimuth = 0; // [rad] heading of the line of sight, 0 looks along +x
  elevation = 0; // [rad] its pitch, negative looks down
  /** Index of the model's camera in use, -1 for the free view. */
  chosen = -1;
  #stage;
  #first;
  #glide = null;
  #bodyPose;
  #cameras;
  /** Called after each change. */
  onChange = null;

  /**
   * @param {import('./stage.js').Stage} stage
   * @param {object} scene  see scene.json
   * @param {(body: number) => {p: Vector3, q: Quaternion}} bodyPose
   */
  constructor(stage, scene, bodyPose) {
    this.#stage = stage;
    this.#bodyPose = bodyPose;
    this.#cameras = scene.cameras ?? [];
    const view = scene.view;
    this.#first = {
      lookat: new Vector3(...view.lookat), distance: view.distance, azimuth: view.azimuth,
      elevation: view.elevation,
    };
    this.#put(this.#first);
  }

  firstView() {
    this.#go(this.#first);
  }

  /** Turns about the point that is looked at. @param {number} right [rad] @param {number} up [rad] */
  turn(right, up) {
    this.#free();
    this.azimuth -= right;
    this.elevation = Math.min(STEEPEST, Math.max(-STEEPEST, this.elevation + up));
    this.apply();
  }

  /** Moves what is seen by so many pixels. */
  move(right, down) {
    this.#free();
    const scale = this.metresPerPixel(this.lookat);
    this.lookat.addScaledVector(this.right, -right * scale).addScaledVector(this.up, down * scale);
    this.apply();
  }

  /** @param {number} factor  of the distance */
  zoom(factor) {
    this.#free();
    this.distance = Math.min(200, Math.max(0.03, this.distance * factor));
    this.apply();
  }

  /** Looks along this heading and pitch. */
  face(azimuth, elevation) {
    this.#go({ lookat: this.lookat, distance: this.distance, azimuth, elevation });
  }

  /** Shows all of a ball. */
  fit(middle, radius) {
    const narrow = Math.min(1, this.#stage.width / this.#stage.height);
    const half = Math.atan(Math.tan(this.#freeFovy() / 2) * narrow);
    const distance = (1.02 * radius) / Math.sin(half);
    this.#go({ lookat: middle.clone(), distance, azimuth: this.azimuth, elevation: this.elevation });
  }

  /** Takes a camera of the model; -1 for the free view. */
  choose(index) {
    if (index < 0) {
      this.#free();
    } else {
      this.#glide = null;
      this.chosen = index;
    }
    this.apply();
  }

  /** Glides on; a camera of the model goes with its body. @param {number} now [ms] */
  tick(now, moved) {
    if (this.#glide) {
      const share = Math.min(1, (now - this.#glide.start) / GLIDE);
      this.#put(between(this.#glide.from, this.#glide.to, share * share * (3 - 2 * share)));
      if (share >= 1) this.#glide = null;
      this.apply();
    } else if (this.chosen >= 0 && moved) {
      this.apply();
    }
  }

  /** [m] that one pixel stands for at a point of the world. */
  metresPerPixel(point) {
    const depth = Math.max(this.depth(point), 1e-3);
    return (2 * depth * Math.tan(this.fovy / 2)) / this.#stage.height;
  }

  /** [m] in front of the eye. */
  depth(point) {
    return point.clone().sub(this.position).dot(this.forward);
  }

  get fovy() {
    return (this.#stage.camera.fov * Math.PI) / 180;
  }
  get position() {
    return new Vector3().setFromMatrixPosition(this.#stage.camera.matrixWorld);
  }
  get right() {
    return new Vector3().setFromMatrixColumn(this.#stage.camera.matrixWorld, 0);
  }
  get up() {
    return new Vector3().setFromMatrixColumn(this.#stage.camera.matrixWorld, 1);
  }
  get forward() {
    return new Vector3().setFromMatrixColumn(this.#stage.camera.matrixWorld, 2).negate();
  }

  /** Pixel of the canvas where a point of the world is seen. */
  project(point) {
    const { width, height, camera } = this.#stage;
    const seen = point.clone().project(camera);
    return {
      x: ((seen.x + 1) / 2) * width, y: ((1 - seen.y) / 2) * height, visible: this.depth(point) > 0,
    };
  }

  apply() {
    const { camera } = this.#stage;
    if (this.chosen >= 0) {
      const own = this.#cameras[this.chosen];
      const { p, q } = this.#bodyPose(own.body);
      const [w, x, y, z] = own.quat;
      camera.quaternion.copy(q).multiply(new Quaternion(x, y, z, w));
      camera.position.set(...own.pos).applyQuaternion(q).add(p);
      this.#lens(own.fovy, 1);
    } else {
      const [a, e] = [this.azimuth, this.elevation];
      const forward = new Vector3(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e));
      const right = new Vector3(Math.sin(a), -Math.cos(a), 0);
      basis.makeBasis(right, right.clone().cross(forward), forward.clone().negate());
      camera.quaternion.setFromRotationMatrix(basis);
      camera.position.copy(this.lookat).addScaledVector(forward, -this.distance);
      this.#lens(this.#freeFovy(), this.distance);
    }
    camera.updateMatrix();
    camera.updateMatrixWorld(true);
    this.#stage.changed();
    this.onChange?.();
  }

  /** A narrow picture sees as much to the sides as a square one, as far as that goes. */
  #freeFovy() {
    const narrow = Math.min(1, this.#stage.width / this.#stage.height);
    return Math.min(WIDEST, 2 * Math.atan(Math.tan(FOVY / 2) / narrow));
  }

  #lens(fovy, distance) {
    const { camera } = this.#stage;
    camera.fov = (fovy * 180) / Math.PI;
    camera.near = Math.min(0.05, 0.02 * distance);
    camera.far = 200 + 4 * distance;
    camera.updateProjectionMatrix();
  }

  /** Goes on freely from where a camera of the model, or a glide, is. */
  #free() {
    this.#glide = null;
    if (this.chosen < 0) return;
    const forward = this.forward;
    this.azimuth = Math.atan2(forward.y, forward.x);
    this.elevation = Math.asin(Math.max(-1, Math.min(1, forward.z)));
    this.distance = Math.max(0.1, this.depth(this.#first.lookat));
    this.lookat.copy(this.position).addScaledVector(forward, this.distance);
    this.chosen = -1;
  }

  #go(to) {
    this.#free();
    const { distance, azimuth, elevation } = this;
    const from = { lookat: this.lookat.clone(), distance, azimuth, elevation };
    const turn = Math.atan2(Math.sin(to.azimuth - from.azimuth), Math.cos(to.azimuth - from.azimuth));
    const goal = { ...to, lookat: to.lookat.clone(), azimuth: from.azimuth + turn };
    if (mayGlide()) {
      this.#glide = { from, to: goal, start: performance.now() };
    } else {
      this.#put(goal);
    }
    this.apply();
  }

  #put({ lookat, distance, azimuth, elevation }) {
    this.lookat.copy(lookat);
    Object.assign(this, { distance, azimuth, elevation });
  }
}

function between(from, to, share) {
  const mix = (a, b) => a + share * (b - a);
  return {
    lookat: from.lookat.clone().lerp(to.lookat, share),
    distance: mix(from.distance, to.distance),
    azimuth: mix(from.azimuth, to.azimuth),
    elevation: mix(from.elevation, to.elevation),
  };
}
