// Artists: one draws one item of the overlay and can be used again for another of the same key.
import {
  BoxGeometry, CapsuleGeometry, ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial,
  SphereGeometry, Vector3,
} from 'three';
import { FatLines } from './fat_lines.js';
import { makeGhost } from './ghost.js';
import { makeLabel } from './label.js';
import { colorOf } from './paint.js';

const Z = new Vector3(0, 0, 1);
const AXES = [[new Vector3(1, 0, 0), '#e5484d'], [new Vector3(0, 1, 0), '#46a758'], [new Vector3(0, 0, 1), '#3e7bfa']];
const THINNEST = 0.002; // [m] half axis of an ellipsoid

const CYLINDER = new CylinderGeometry(1, 1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5);
const CONE = new ConeGeometry(1, 1, 24).rotateX(Math.PI / 2).translate(0, 0, 0.5);
const BALL = new SphereGeometry(1, 36, 24);
const BOX = new BoxGeometry(2, 2, 2);

/** @typedef {{key: (item: object) => string, make: (item: object, around: object) => object}} Artist */

/** @type {Object<string, Artist>} */
export const ARTISTS = {
  line: lines((item) => item.points.length - 1, (item) => (i, end) => item.points[i + end]),
  segments: lines((item) => Math.floor(item.ends.length / 2), (item) => (i, end) => item.ends[2 * i + end]),
  arrow: { key: () => 'arrow', make: makeArrow },
  frame: { key: () => 'frame', make: makeFrame },
  label: { key: (item) => `label ${item.text}`, make: makeLabel },
  ellipsoid: solid(BALL, (item, mesh) => {
    mesh.scale.set(...item.semi_axes.map((half) => Math.max(half, THINNEST)));
    turn(mesh, item.quat);
  }),
  box: solid(BOX, (item, mesh) => {
    mesh.scale.set(...item.half_sizes);
    turn(mesh, item.quat);
  }),
  capsule: { key: capsuleKey, make: makeCapsule },
  ghost: { key: (item) => `ghost ${item.bodies.map((pose) => pose[0]).join()}`, make: makeGhost },
};

function lines(count, points) {
  return {
    key: (item) => item.kind,
    make(_, { root, eye }) {
      const lines = new FatLines();
      const middle = new Vector3();
      root.add(lines.object);
      return {
        set(item) {
          const pieces = Math.max(0, count(item));
          const at = points(item);
          lines.set(pieces, at, item);
          if (pieces > 0) middle.set(...at(pieces >> 1, 0));
        },
        look: () => lines.look(eye.metresPerPixel(middle)),
        dispose: () => lines.dispose(),
      };
    },
  };
}

function solid(geometry, place) {
  return {
    key: (item) => item.kind,
    make(_, { root }) {
      const mesh = new Mesh(geometry, paintOf());
      root.add(mesh);
      return {
        set(item) {
          mesh.position.set(...item.pos);
          place(item, mesh);
          repaint(mesh.material, item.rgba);
        },
        dispose: () => drop(mesh, mesh.material),
      };
    },
  };
}

function makeArrow(_, { root }) {
  const paint = paintOf();
  const [shaft, head, group] = [new Mesh(CYLINDER, paint), new Mesh(CONE, paint), new Group()];
  group.add(shaft, head);
  root.add(group);
  return {
    set(item) {
      const way = new Vector3(...item.to).sub(new Vector3(...item.from));
      const length = way.length();
      const radius = item.width / 2;
      const tip = Math.min(5 * radius, 0.6 * length);
      group.visible = length > 1e-9;
      group.position.set(...item.from);
      if (group.visible) group.quaternion.setFromUnitVectors(Z, way.divideScalar(length));
      shaft.scale.set(radius, radius, Math.max(length - tip, 1e-9));
      head.scale.set(2.2 * radius, 2.2 * radius, Math.max(tip, 1e-9));
      head.position.z = length - tip;
      repaint(paint, item.rgba);
    },
    dispose: () => drop(group, paint),
  };
}

function makeFrame(_, { root }) {
  const group = new Group();
  const rods = AXES.map(([axis, color]) => {
    const rod = new Mesh(CYLINDER, new MeshStandardMaterial({ color, roughness: 0.5 }));
    rod.quaternion.setFromUnitVectors(Z, axis);
    group.add(rod);
    return rod;
  });
  root.add(group);
  return {
    set(item) {
      group.position.set(...item.pos);
      turn(group, item.quat);
      for (const rod of rods) rod.scale.set(item.width / 2, item.width / 2, item.length);
    },
    dispose: () => drop(group, ...rods.map((rod) => rod.material)),
  };
}

function capsuleKey({ from, to, radius }) {
  const length = Math.hypot(...from.map((x, k) => to[k] - x));
  return `capsule ${length.toFixed(5)} ${radius.toFixed(5)}`;
}

function makeCapsule(first, { root }) {
  const length = new Vector3(...first.to).distanceTo(new Vector3(...first.from));
  const geometry = new CapsuleGeometry(first.radius, length, 8, 24).rotateX(Math.PI / 2);
  const mesh = new Mesh(geometry, paintOf());
  root.add(mesh);
  return {
    set({ from, to, rgba }) {
      const [a, b] = [new Vector3(...from), new Vector3(...to)];
      mesh.position.copy(a).lerp(b, 0.5);
      const way = b.sub(a);
      if (way.length() > 1e-9) mesh.quaternion.setFromUnitVectors(Z, way.normalize());
      repaint(mesh.material, rgba);
    },
    dispose() {
      drop(mesh, mesh.material);
      geometry.dispose();
    },
  };
}

function paintOf() {
  return new MeshStandardMaterial({ roughness: 0.6 });
}

function repaint(material, rgba) {
  const clear = (rgba[3] ?? 1) < 1;
  material.color.copy(colorOf(rgba));
  material.opacity = rgba[3] ?? 1;
  if (material.transparent === clear) return;
  material.transparent = clear;
  material.depthWrite = !clear;
  material.needsUpdate = true;
}

function turn(object, [w, x, y, z]) {
  object.quaternion.set(x, y, z, w);
}

function drop(object, ...materials) {
  object.removeFromParent();
  for (const material of materials) material.dispose();
}
