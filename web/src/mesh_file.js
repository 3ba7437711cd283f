// The bytes of a mesh, and normals for it.
import { BufferAttribute, BufferGeometry } from 'three';

const CREASE = Math.cos((38 * Math.PI) / 180); // edges sharper than this stay sharp

/**
 * @param {ArrayBuffer} bytes  little endian: u32 vertices, u32 triangles, f32 xyz[3n], u32 corner[3m]
 * @returns {BufferGeometry} every triangle with corners of its own
 */
export function readMesh(bytes) {
  const [vertices, triangles] = new Uint32Array(bytes, 0, 2);
  if (bytes.byteLength !== 8 + 12 * vertices + 12 * triangles) throw new Error('mesh: wrong size');
  const points = new Float32Array(bytes, 8, 3 * vertices);
  const corners = new Uint32Array(bytes, 8 + 12 * vertices, 3 * triangles);
  for (const corner of corners) if (corner >= vertices) throw new Error('mesh: wrong corner');
  return withNormals(points, corners);
}

function withNormals(points, corners) {
  const faces = faceNormals(points, corners);
  const { places, first, around } = facesAroundPlaces(points, corners);
  const position = new Float32Array(3 * corners.length);
  const normal = new Float32Array(3 * corners.length);
  for (let i = 0; i < corners.length; ++i) {
    position.set(points.subarray(3 * corners[i], 3 * corners[i] + 3), 3 * i);
    const place = places[corners[i]];
    const face = Math.floor(i / 3);
    let [x, y, z] = [0, 0, 0];
    for (let k = first[place]; k < first[place + 1]; ++k) {
      const other = around[k];
      const along = faces.unit[3 * face] * faces.unit[3 * other] +
        faces.unit[3 * face + 1] * faces.unit[3 * other + 1] +
        faces.unit[3 * face + 2] * faces.unit[3 * other + 2];
      if (other !== face && along < CREASE) continue;
      x += faces.area[other] * faces.unit[3 * other];
      y += faces.area[other] * faces.unit[3 * other + 1];
      z += faces.area[other] * faces.unit[3 * other + 2];
    }
    const length = Math.hypot(x, y, z) || 1;
    normal.set([x / length, y / length, z / length], 3 * i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('normal', new BufferAttribute(normal, 3));
  return geometry;
}

function faceNormals(points, corners) {
  const count = corners.length / 3;
  const unit = new Float32Array(3 * count);
  const area = new Float32Array(count);
  for (let f = 0; f < count; ++f) {
    const [a, b, c] = [3 * corners[3 * f], 3 * corners[3 * f + 1], 3 * corners[3 * f + 2]];
    const [ux, uy, uz] = [0, 1, 2].map((k) => points[b + k] - points[a + k]);
    const [vx, vy, vz] = [0, 1, 2].map((k) => points[c + k] - points[a + k]);
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(...n);
    area[f] = length;
    for (let k = 0; k < 3; ++k) unit[3 * f + k] = length > 0 ? n[k] / length : 0;
  }
  return { unit, area };
}

/** Vertices at the same point are one place; which faces touch which place. */
function facesAroundPlaces(points, corners) {
  const places = new Uint32Array(points.length / 3);
  const known = new Map();
  for (let v = 0; v < places.length; ++v) {
    const key = `${points[3 * v]},${points[3 * v + 1]},${points[3 * v + 2]}`;
    if (!known.has(key)) known.set(key, known.size);
    places[v] = known.get(key);
  }
  const first = new Uint32Array(known.size + 1);
  for (const corner of corners) ++first[places[corner] + 1];
  for (let p = 0; p < known.size; ++p) first[p + 1] += first[p];
  const next = first.slice();
  const around = new Uint32Array(corners.length);
  for (let i = 0; i < corners.length; ++i) around[next[places[corners[i]]]++] = Math.floor(i / 3);
  return { places, first, around };
}
