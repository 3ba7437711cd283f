// A ghost: bodies of the model once more, elsewhere, translucent in one colour. First their depth is
// drawn, then their colour, so that nothing of a ghost shines through itself.
import { Group, Mesh, MeshStandardMaterial } from 'three';
import { colorOf } from './paint.js';

const ORDER = 20; // after what is translucent in the model

export function makeGhost(first, { root, model }) {
  const depth = new MeshStandardMaterial({ colorWrite: false });
  const color = new MeshStandardMaterial({ transparent: true, depthWrite: false, roughness: 0.7 });
  for (const paint of [depth, color]) {
    paint.polygonOffset = true; // where it stands in the arm itself, the arm is seen
    paint.polygonOffsetFactor = 1;
    paint.polygonOffsetUnits = 4;
  }
  const group = new Group();
  const meshes = [];
  const bodies = first.bodies.map(([body]) => {
    const part = new Group();
    for (const shape of model.shapesOf(body)) {
      part.add(copyOf(shape, depth, ORDER));
      const seen = copyOf(shape, color, ORDER + 1);
      part.add(seen);
      meshes.push(seen);
    }
    group.add(part);
    return part;
  });
  root.add(group);
  const artist = {
    meshes,
    item: first,
    set(item) {
      artist.item = item;
      for (const mesh of meshes) mesh.userData.ghost = item;
      item.bodies.forEach(([, x, y, z, qw, qx, qy, qz], index) => {
        bodies[index].position.set(x, y, z);
        bodies[index].quaternion.set(qx, qy, qz, qw);
      });
      group.updateMatrixWorld(true);
      color.color.copy(colorOf(item.rgba));
      color.emissive.copy(color.color).multiplyScalar(0.25);
      color.opacity = item.rgba[3] ?? 0.35;
    },
    dispose() {
      group.removeFromParent();
      depth.dispose();
      color.dispose();
    },
  };
  return artist;
}

function copyOf(shape, material, order) {
  const mesh = new Mesh(shape.geometry, material);
  mesh.matrix.copy(shape.matrix);
  mesh.matrixAutoUpdate = false;
  mesh.renderOrder = order;
  return mesh;
}
