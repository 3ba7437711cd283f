// How the handles of the target look.
import {
  ConeGeometry, CylinderGeometry, DoubleSide, Group, Matrix4, Mesh, MeshLambertMaterial, PlaneGeometry,
  SphereGeometry, TorusGeometry, Vector3,
} from 'three';
import { ARROW_BEGIN, BALL, handles, isVisible, RING, SQUARE, SQUARE_HALF } from './gizmo_handles.js';
import { colorOf } from './paint.js';

const COLORS = ['#e5484d', '#46a758', '#3e7bfa'];
const BRIGHT = '#ffd23f';
const HEAD = 0.26; // length of an arrow's head
const LETTERS = ['x', 'y', 'z'];

export class GizmoShapes {
  group = new Group();
  #parts; // {handle, meshes}
  #ball;
  #turns = null;

  constructor() {
    this.group.matrixAutoUpdate = false;
    this.group.visible = false;
  }

  /**
   * @param {{p: Vector3, axes: Vector3[], size: number, rgba: number[], turns: boolean}} look
   * @param {import('./gizmo_handles.js').Handle|null} bright  the one under the mouse, or held
   * @param {Vector3} sight
   */
  update(look, bright, sight) {
    if (this.#turns !== look.turns) this.#build(look.turns);
    const [x, y, z] = look.axes;
    this.group.matrix.makeBasis(x, y, z).scale(new Vector3(look.size, look.size, look.size)).setPosition(look.p);
    this.group.updateMatrixWorld(true);
    for (const { handle, material, mesh } of this.#parts) {
      const on = bright && bright.kind === handle.kind && bright.axis === handle.axis;
      const own = handle.kind === 'ball' ? colorOf(look.rgba) : COLORS[handle.axis];
      material.color.set(on && handle.kind !== 'ball' ? BRIGHT : own);
      material.emissive.set(on ? '#5a4a10' : '#000000');
      mesh.visible = isVisible(handle, look.axes, sight) && !(bright?.held && !on && handle.kind !== 'ball');
    }
    this.#ball.scale.setScalar(bright?.kind === 'ball' ? 1.25 : 1);
    this.#ball.updateMatrix();
    this.#ball.updateMatrixWorld(true);
  }

  #build(turns) {
    this.group.clear();
    this.#turns = turns;
    this.#parts = handles(turns).map((handle) => {
      const material = new MeshLambertMaterial({
        transparent: handle.kind === 'square', opacity: handle.kind === 'square' ? 0.55 : 1, side: DoubleSide,
      });
      const mesh = new Group();
      for (const geometry of MAKERS[handle.kind]()) mesh.add(new Mesh(geometry, material));
      if (handle.axis >= 0) mesh.applyMatrix4(toAxis(handle.axis));
      mesh.name = handle.kind + (LETTERS[handle.axis] ?? '');
      this.group.add(mesh);
      return { handle, material, mesh };
    });
    this.#ball = this.#parts[0].mesh;
  }
}

// All along, about or across z.
const MAKERS = {
  arrow: () => [
    new CylinderGeometry(0.022, 0.022, 1 - HEAD - ARROW_BEGIN, 16).rotateX(Math.PI / 2)
      .translate(0, 0, (1 - HEAD + ARROW_BEGIN) / 2),
    new ConeGeometry(0.075, HEAD, 24).rotateX(Math.PI / 2).translate(0, 0, 1 - HEAD / 2),
  ],
  ring: () => [new TorusGeometry(RING, 0.017, 10, 80)],
  square: () => [new PlaneGeometry(2 * SQUARE_HALF, 2 * SQUARE_HALF).translate(SQUARE, SQUARE, 0)],
  ball: () => [new SphereGeometry(BALL, 28, 20)],
};

/** z to the axis, x and y to the two after it. */
function toAxis(axis) {
  const unit = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
  return new Matrix4().makeBasis(unit[(axis + 1) % 3], unit[(axis + 2) % 3], unit[axis]);
}
