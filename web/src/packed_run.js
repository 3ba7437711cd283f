// Meshes and moments of a recorded run, as the program packs them (mjarm/serve/packed_run_internal.hpp).

const LENGTH_UNIT = 1e-5; // [m]
const QUAT_UNIT = 1 / 32767;

/** Bytes of base64, inflated. @param {string} text @returns {Promise<Uint8Array>} */
export async function inflated(text) {
  const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads one piece after the other. */
export class Unpacker {
  #bytes;
  #view;
  #at = 0;

  /** @param {Uint8Array} bytes */
  constructor(bytes) {
    this.#bytes = bytes;
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  /** @param {number} count @returns {Float64Array} */
  doubles(count) {
    const out = new Float64Array(count);
    for (let i = 0; i < count; ++i, this.#at += 8) out[i] = this.#view.getFloat64(this.#at, true);
    return out;
  }

  /** A row of whole numbers, each kept as the difference to the one before. */
  whole(count, take) {
    let value = 0;
    for (let i = 0; i < count; ++i) {
      let rest = 0;
      let place = 1;
      let byte;
      do {
        byte = this.#bytes[this.#at++];
        if (byte === undefined) throw new Error('the recording is cut short');
        rest += (byte & 0x7f) * place;
        place *= 128;
      } while (byte & 0x80);
      value += rest % 2 === 0 ? rest / 2 : -(rest + 1) / 2;
      take(value, i);
    }
  }

  /** A mesh as the server gives it: u32 vertices, u32 triangles, f32 xyz, u32 corners. */
  mesh({ vertices, triangles }) {
    const bytes = new ArrayBuffer(8 + 12 * (vertices + triangles));
    new Uint32Array(bytes, 0, 2).set([vertices, triangles]);
    const points = new Float32Array(bytes, 8, 3 * vertices);
    const corners = new Uint32Array(bytes, 8 + 12 * vertices, 3 * triangles);
    const [unit] = this.doubles(1);
    for (let axis = 0; axis < 3; ++axis) {
      this.whole(vertices, (value, i) => { points[3 * i + axis] = value * unit; });
    }
    this.whole(3 * triangles, (value, i) => { corners[i] = value; });
    return bytes;
  }

  /** How a body moves. @returns {Float32Array} x y z, w x y z a moment */
  body(moments) {
    const out = new Float32Array(7 * moments);
    for (let part = 0; part < 7; ++part) {
      const unit = part < 3 ? LENGTH_UNIT : QUAT_UNIT;
      this.whole(moments, (value, i) => { out[7 * i + part] = value * unit; });
    }
    return out;
  }
}
