// The canvas: renderer, light, shadow, sky. Draws only where something has changed.
import {
  Color, DataTexture, DirectionalLight, HemisphereLight, LinearFilter, PCFShadowMap, PerspectiveCamera,
  RGBAFormat, Scene, SRGBColorSpace, Vector3, WebGLRenderer,
} from 'three';

const SUN = new Vector3(0.45, -0.55, 1).normalize(); // where the light comes from
const SLOW = 60; // [ms] a picture, on average
const SLOW_COUNT = 25; // pictures
const PROCESSOR_PACE = 45; // [ms] from picture to picture where the processor draws: it has the simulation to do, too

export class Stage {
  scene = new Scene();
  /** Drawn in front of all of `scene`. */
  front = new Scene();
  camera = new PerspectiveCamera(45, 1, 0.01, 500);
  width = 1; // [CSS pixels]
  height = 1;
  #dirty = true;
  #sun = new DirectionalLight(0xffffff, 2);
  #sky = new HemisphereLight(0xffffff, 0x8890a0, 1);
  #fill = new DirectionalLight(0xffffff, 0.5);
  #pace = { last: 0, sum: 0, count: 0 };
  #drawn = 0; // [ms] when
  #ratio = Math.min(window.devicePixelRatio || 1, 2);
  /** Called once where drawing turns out to be slow. */
  onSlow = null;
  /** Called after each change of size. */
  onResize = null;

  /** @param {HTMLCanvasElement} canvas; throws where there is no WebGL */
  constructor(canvas) {
    this.canvas = canvas;
    /** Whether the processor draws, for want of a graphics card. */
    this.isSoftware = isSoftware();
    const antialias = !this.isSoftware;
    this.renderer = new WebGLRenderer({ canvas, antialias, powerPreference: 'high-performance' });
    this.renderer.autoClear = false;
    this.renderer.debug.checkShaderErrors = false; // asking waits for the compiler
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.camera.matrixAutoUpdate = false;
    this.scene.matrixAutoUpdate = false;
    this.#sun.castShadow = true;
    this.#sun.shadow.mapSize.set(2048, 2048);
    this.#sun.shadow.bias = -0.0004;
    this.#sun.shadow.normalBias = 0.004;
    this.#sun.shadow.radius = 3.5;
    this.#fill.position.set(-0.8, 0.9, 0.35);
    this.#sky.position.set(0, 0, 1);
    this.scene.add(this.#sky, this.#sun, this.#sun.target, this.#fill);
    const frontSky = new HemisphereLight(0xffffff, 0xd8d8d8, 3.0);
    frontSky.position.set(0.2, -0.4, 1);
    this.front.add(frontSky);
    canvas.addEventListener('webglcontextrestored', () => this.changed(true));
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
  }

  /** @param {boolean} [shapes]  whether shadows changed too */
  changed(shapes = false) {
    this.#dirty = true;
    if (shapes) this.renderer.shadowMap.needsUpdate = true;
  }

  /** Light and shadow round what is to be seen. @param {Vector3} middle @param {number} radius [m] */
  setRegion(middle, radius) {
    this.#sun.position.copy(middle).addScaledVector(SUN, 4 * radius);
    this.#sun.target.position.copy(middle);
    const box = this.#sun.shadow.camera;
    [box.left, box.right, box.bottom, box.top] = [-radius, radius, -radius, radius];
    [box.near, box.far] = [0.5 * radius, 8 * radius];
    box.updateProjectionMatrix();
    this.changed(true);
  }

  setPalette(palette) {
    this.#sky.intensity = palette.ambient;
    this.#sun.intensity = palette.sun;
    this.#fill.intensity = palette.fill;
    this.scene.background?.dispose();
    this.scene.background = gradient(palette.skyBottom, palette.skyTop);
    this.changed(true);
  }

  get shadows() {
    return this.#sun.castShadow;
  }

  setShadows(on) {
    this.#sun.castShadow = on;
    this.changed(true);
  }

  /** No shadows, no more pixels than the page has. */
  setLow() {
    this.#ratio = Math.min(1, this.#ratio);
    this.onSlow = null;
    this.setShadows(false);
    this.#resize();
  }

  /** Draws where something changed. @param {number} now [ms] */
  draw(now) {
    if (!this.#dirty) {
      this.#pace.last = 0;
      return;
    }
    if (this.isSoftware && now - this.#drawn < PROCESSOR_PACE) return;
    this.#dirty = false;
    this.#drawn = now;
    this.#render();
    this.#watchPace(now);
  }

  /** The picture as a PNG. @returns {Promise<Blob|null>} */
  picture() {
    this.#render();
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }

  #render() {
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.clearDepth();
    this.renderer.render(this.front, this.camera);
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.width = Math.max(clientWidth, 1);
    this.height = Math.max(clientHeight, 1);
    this.renderer.setPixelRatio(this.#ratio);
    this.renderer.setSize(this.width, this.height, false);
    this.camera.aspect = this.width / this.height;
    this.camera.updateProjectionMatrix();
    this.changed();
    this.onResize?.();
    this.#render(); // else the canvas is blank until the next picture
  }

  #watchPace(now) {
    const pace = this.#pace;
    if (!this.onSlow) return;
    const way = now - pace.last;
    const counts = pace.last > 0 && way < 1000;
    pace.last = now;
    if (!counts) return;
    pace.sum += way;
    if (++pace.count < SLOW_COUNT) return;
    if (pace.sum / pace.count > SLOW) this.onSlow();
    pace.sum = pace.count = 0;
  }
}

/** Asked of a canvas of its own, as smooth edges have to be chosen with the context. */
function isSoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** A picture that goes from one colour at the bottom to another at the top. */
function gradient(bottom, top) {
  const rows = 64;
  const bytes = new Uint8Array(4 * rows);
  const [from, to] = [new Color(bottom), new Color(top)];
  for (let row = 0; row < rows; ++row) {
    const hex = from.clone().lerp(to, row / (rows - 1)).getHex(SRGBColorSpace);
    bytes.set([hex >> 16, (hex >> 8) & 255, hex & 255, 255], 4 * row);
  }
  const texture = new DataTexture(bytes, 1, rows, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
