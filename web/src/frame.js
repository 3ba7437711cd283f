// The bytes of a frame.

const HEAD = 16;

/**
 * @param {ArrayBuffer} bytes  little endian: u8 kind 1, u8 flags, u16, u32 number, f64 time, f32...
 * @param {number} bodies  how many the scene has
 * @param {number} nq      how many numbers qpos has
 * @returns {import('./source.js').Frame|null} null where it is no frame of this scene
 */
export function readFrame(bytes, bodies, nq) {
  if (bytes.byteLength !== HEAD + 4 * (7 * bodies + nq)) return null;
  const head = new DataView(bytes, 0, HEAD);
  if (head.getUint8(0) !== 1) return null;
  return {
    paused: (head.getUint8(1) & 1) !== 0,
    number: head.getUint32(4, true),
    time: head.getFloat64(8, true),
    bodies: new Float32Array(bytes, HEAD, 7 * bodies),
    qpos: new Float32Array(bytes, HEAD + 28 * bodies, nq),
  };
}
