// What a drag of a handle does to the target.
import { Plane, Quaternion, Vector3 } from 'three';

const GRAZING = 0.26; // sine (15 degrees) below which a direction points at the eye
const FLATTEST = 0.1; // sine: flatter rays to the plane change nothing
const REACH = 3; // in distances to the eye

/**
 * A handle that is held.
 * @param {import('./gizmo_handles.js').Handle} handle
 * @param {{p: Vector3, q: Quaternion}} pose  of the target
 * @param {Vector3[]} axes  of the handles
 * @param {import('./eye.js').Eye} eye
 * @param {import('three').Ray} ray  through the pixel where it was grabbed
 * @param {Vector3} point  of the handle that was grabbed
 * @returns {{move: (ray: import('three').Ray) => {p: Vector3, q: Quaternion, amount: number}}}
 */
export function startDrag(handle, pose, axes, eye, ray, point) {
  const start = { p: pose.p.clone(), q: pose.q.clone() };
  const axis = handle.axis >= 0 ? axes[handle.axis].clone() : eye.forward;
  const sight = start.p.clone().sub(eye.position).normalize();
  const reach = REACH * start.p.distanceTo(eye.position);
  const normal = planeOf(handle, axis, sight, eye);
  const plane = new Plane().setFromNormalAndCoplanarPoint(normal, handle.kind === 'ring' ? point : start.p);
  const first = meet(ray, plane) ?? point.clone();
  const hold = { start, axis, sight, first, reach, point, eye };
  const rule = RULES[ruleOf(handle, axis, sight)](hold);
  let last = { ...start, amount: 0 };
  return {
    move(now) {
      const met = meet(now, plane);
      if (met) last = rule(met);
      return last;
    },
  };
}

function planeOf(handle, axis, sight, eye) {
  if (handle.kind === 'ball') return eye.forward;
  const along = Math.abs(axis.dot(sight));
  if (handle.kind === 'square') return axis;
  if (handle.kind === 'ring') return along >= GRAZING ? axis : eye.forward;
  const across = without(sight, axis);
  return across.length() > GRAZING ? across.normalize() : eye.forward;
}

function ruleOf(handle, axis, sight) {
  if (handle.kind === 'ring') return Math.abs(axis.dot(sight)) >= GRAZING ? 'turn' : 'roll';
  if (handle.kind === 'arrow') return without(sight, axis).length() > GRAZING ? 'slide' : 'push';
  return 'plane';
}

const RULES = {
  /** Along an axis that is seen from the side. */
  slide: ({ start, axis, first, reach }) => (met) => moved(start, axis, met.sub(first).dot(axis), reach),

  /** Along an axis that points at the eye: up in the picture is away from it. */
  push: ({ start, axis, sight, first, reach, eye }) => {
    const sign = Math.sign(axis.dot(sight)) || 1;
    return (met) => moved(start, axis, sign * met.sub(first).dot(eye.up), reach);
  },

  /** In a plane. */
  plane: ({ start, first, reach }) => (met) => {
    const way = met.sub(first).clampLength(0, reach);
    return { p: start.p.clone().add(way), q: start.q.clone(), amount: way.length() };
  },

  /** About an axis, round the ring; several turns add up. */
  turn: ({ start, axis, first }) => {
    const zero = without(first.clone().sub(start.p), axis).normalize();
    const side = axis.clone().cross(zero);
    let [angle, before] = [0, 0];
    return (met) => {
      const arm = met.sub(start.p);
      const now = Math.atan2(arm.dot(side), arm.dot(zero));
      angle += Math.atan2(Math.sin(now - before), Math.cos(now - before));
      before = now;
      return turned(start, axis, angle);
    };
  },

  /** About an axis that lies in the picture: the ring rolls under the mouse. */
  roll: ({ start, axis, first, point }) => {
    const arm = without(point.clone().sub(start.p), axis);
    const along = axis.clone().cross(arm).divideScalar(arm.lengthSq() || 1);
    return (met) => turned(start, axis, met.sub(first).dot(along));
  },
};

function moved(start, axis, amount, reach) {
  const way = Math.max(-reach, Math.min(reach, amount));
  return { p: start.p.clone().addScaledVector(axis, way), q: start.q.clone(), amount: way };
}

function turned(start, axis, angle) {
  const turn = new Quaternion().setFromAxisAngle(axis, angle);
  return { p: start.p.clone(), q: turn.multiply(start.q), amount: angle };
}

function without(v, axis) {
  return v.clone().addScaledVector(axis, -v.dot(axis));
}

/** Where a ray meets a plane in front of the eye; null for rays too flat to it. */
function meet(ray, plane) {
  if (Math.abs(ray.direction.dot(plane.normal)) < FLATTEST) return null;
  return ray.intersectPlane(plane, new Vector3());
}
