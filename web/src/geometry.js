// The shape of a geom, by its kind and size; z is the axis of round ones.
import { BoxGeometry, CapsuleGeometry, CylinderGeometry, PlaneGeometry, SphereGeometry } from 'three';

const ENDLESS = 60; // [m] half length of a plane without end

const MAKERS = {
  plane: ([x, y]) => new PlaneGeometry(2 * (x || ENDLESS), 2 * (y || ENDLESS)),
  sphere: ([r]) => new SphereGeometry(r, 40, 24),
  capsule: ([r, half]) => upright(new CapsuleGeometry(r, 2 * half, 12, 36)),
  cylinder: ([r, half]) => upright(new CylinderGeometry(r, r, 2 * half, 44)),
  ellipsoid: ([x, y, z]) => new SphereGeometry(1, 40, 24).scale(x, y, z),
  box: ([x, y, z]) => new BoxGeometry(2 * x, 2 * y, 2 * z),
};

function upright(geometry) {
  return geometry.rotateX(Math.PI / 2);
}

/** @param {{kind: string, size: number[]}} geom  no mesh @returns {BufferGeometry|null} */
export function geometryOf(geom) {
  return MAKERS[geom.kind]?.(geom.size) ?? null;
}
