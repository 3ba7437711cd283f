// The handles of the target: which there are, where they are, which is under a pixel.
import { Vector3 } from 'three';

// Lengths in those of the arrows.
export const ARROW_BEGIN = 0.24;
export const RING = 0.74; // radius
export const SQUARE = 0.4; // from the middle to the middle of a square
export const SQUARE_HALF = 0.11;
export const BALL = 0.1; // radius
const RING_PIECES = 48;
const EDGE_ON = 0.14; // sine of the angle below which a square is not seen
const DEPTH_COST = 0.35; // of a handle one arrow length behind another

/** @typedef {{kind: 'arrow'|'square'|'ring'|'ball', axis: number}} Handle */

/** @param {boolean} turns  whether there are rings @returns {Handle[]} */
export function handles(turns) {
  const kinds = turns ? ['arrow', 'square', 'ring'] : ['arrow', 'square'];
  const out = [{ kind: 'ball', axis: -1 }];
  for (const kind of kinds) for (const axis of [0, 1, 2]) out.push({ kind, axis });
  return out;
}

/** Whether it can be seen, and taken hold of. @param {Vector3} sight  unit, from the eye */
export function isVisible(handle, axes, sight) {
  return handle.kind !== 'square' || Math.abs(axes[handle.axis].dot(sight)) > EDGE_ON;
}

/** Points of the line along a handle, in the world. */
export function outline(handle, middle, axes, size) {
  const at = (u, v, a, b) => middle.clone().addScaledVector(a, u * size).addScaledVector(b, v * size);
  const a = axes[handle.axis];
  const [u, v] = [axes[(handle.axis + 1) % 3], axes[(handle.axis + 2) % 3]];
  switch (handle.kind) {
    case 'arrow':
      return [at(ARROW_BEGIN, 0, a, a), at(1, 0, a, a)];
    case 'ring':
      return Array.from({ length: RING_PIECES + 1 }, (_, i) => {
        const angle = (2 * Math.PI * i) / RING_PIECES;
        return at(RING * Math.cos(angle), RING * Math.sin(angle), u, v);
      });
    case 'square': {
      const [low, high] = [SQUARE - SQUARE_HALF, SQUARE + SQUARE_HALF];
      return [at(low, low, u, v), at(high, low, u, v), at(high, high, u, v), at(low, high, u, v)];
    }
    default:
      return [middle];
  }
}

/**
 * The handle nearest to a pixel.
 * @param {Handle[]} all
 * @param {{middle: Vector3, axes: Vector3[], size: number}} target
 * @param {import('./eye.js').Eye} eye
 * @param {{x: number, y: number}} pixel
 * @param {number} near  [pixels]
 * @returns {{handle: Handle, point: Vector3}|null}  where on it
 */
export function handleAt(all, target, eye, pixel, near) {
  const sight = target.middle.clone().sub(eye.position).normalize();
  const depth = eye.depth(target.middle);
  let best = null;
  for (const handle of all) {
    if (!isVisible(handle, target.axes, sight)) continue;
    const line = outline(handle, target.middle, target.axes, target.size);
    const found = nearest(handle, line, eye, pixel, target);
    if (!found || found.miss > near) continue;
    const behind = (eye.depth(found.point) - depth) / target.size;
    const cost = found.miss / near + DEPTH_COST * behind;
    if (!best || cost < best.cost) best = { handle, point: found.point, cost };
  }
  return best;
}

function nearest(handle, line, eye, pixel, target) {
  const seen = line.map((point) => eye.project(point));
  if (handle.kind === 'ball') {
    const radius = (BALL * target.size) / eye.metresPerPixel(target.middle);
    const miss = Math.hypot(pixel.x - seen[0].x, pixel.y - seen[0].y) - radius;
    return { miss: Math.max(0, miss), point: line[0].clone() };
  }
  if (handle.kind === 'square') return nearestInSquare(line, seen, pixel);
  let best = null;
  for (let i = 0; i + 1 < seen.length; ++i) {
    const { miss, share } = missOfPiece(seen[i], seen[i + 1], pixel);
    if (!best || miss < best.miss) best = { miss, point: line[i].clone().lerp(line[i + 1], share) };
  }
  return best;
}

function nearestInSquare(line, seen, pixel) {
  let side = 0;
  for (let i = 0; i < 4; ++i) {
    const [a, b] = [seen[i], seen[(i + 1) % 4]];
    side += Math.sign((b.x - a.x) * (pixel.y - a.y) - (b.y - a.y) * (pixel.x - a.x));
  }
  if (Math.abs(side) < 4) return null;
  return { miss: 0, point: line[0].clone().lerp(line[2], 0.5) };
}

function missOfPiece(a, b, pixel) {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const square = dx * dx + dy * dy;
  const along = square > 0 ? ((pixel.x - a.x) * dx + (pixel.y - a.y) * dy) / square : 0;
  const share = Math.max(0, Math.min(1, along));
  return { miss: Math.hypot(pixel.x - a.x - share * dx, pixel.y - a.y - share * dy), share };
}
