// Pictures of the page by their pixels.
import { inflateSync } from 'node:zlib';
import { byTest } from './browser.mjs';

const NOTICEABLE = 24; // of 255, the sum over three channels

/** The pixels of a PNG of 8 bits a channel, not interlaced. @param {Buffer} png */
export function readPng(png) {
  const parts = [];
  let [width, height, channels] = [0, 0, 0];
  for (let at = 8; at < png.length;) {
    const [length, kind] = [png.readUInt32BE(at), png.toString('latin1', at + 4, at + 8)];
    const body = png.subarray(at + 8, at + 8 + length);
    if (kind === 'IHDR') {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      channels = { 2: 3, 6: 4 }[body[9]];
      if (body[8] !== 8 || !channels || body[12] !== 0) throw new Error('a PNG of another kind');
    }
    if (kind === 'IDAT') parts.push(body);
    at += 12 + length;
  }
  return { width, height, channels, bytes: unfilter(inflateSync(Buffer.concat(parts)), width * channels, height, channels) };
}

/** Takes back what each row was filtered by (PNG specification, 9.2). */
function unfilter(data, stride, height, channels) {
  const out = Buffer.alloc(stride * height);
  for (let row = 0; row < height; ++row) {
    const filter = data[row * (stride + 1)];
    for (let i = 0; i < stride; ++i) {
      const at = row * stride + i;
      const left = i >= channels ? out[at - channels] : 0;
      const above = row > 0 ? out[at - stride] : 0;
      const corner = i >= channels && row > 0 ? out[at - stride - channels] : 0;
      const guess = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][filter];
      out[at] = data[row * (stride + 1) + 1 + i] + guess;
    }
  }
  return out;
}

function paeth(left, above, corner) {
  const [a, b, c] = [Math.abs(above - corner), Math.abs(left - corner), Math.abs(left + above - 2 * corner)];
  if (a <= b && a <= c) return left;
  return b <= c ? above : corner;
}

/** What is seen of the scene. */
export async function pictureOfScene(page) {
  return readPng(await page.screenshot({ clip: await byTest(page, 'view').boundingBox() }));
}

/**
 * Where two pictures differ so that it is seen.
 * @returns {{share: number, box: {left: number, right: number, top: number, bottom: number}}} share of all pixels
 */
export function differenceOf(a, b) {
  if (a.width !== b.width || a.height !== b.height) throw new Error('pictures of two sizes');
  let count = 0;
  const box = { left: a.width, right: -1, top: a.height, bottom: -1 };
  for (let y = 0; y < a.height; ++y) {
    for (let x = 0; x < a.width; ++x) {
      const way = (k) => Math.abs(a.bytes[(y * a.width + x) * a.channels + k] - b.bytes[(y * b.width + x) * b.channels + k]);
      if (way(0) + way(1) + way(2) <= NOTICEABLE) continue;
      ++count;
      box.left = Math.min(box.left, x);
      box.right = Math.max(box.right, x);
      box.top = Math.min(box.top, y);
      box.bottom = Math.max(box.bottom, y);
    }
  }
  return { share: count / (a.width * a.height), box };
}

/** Mean brightness, 0 to 255. */
export function brightnessOf({ bytes, channels }) {
  let sum = 0;
  for (let i = 0; i < bytes.length; i += channels) sum += bytes[i] + bytes[i + 1] + bytes[i + 2];
  return (sum * channels) / (3 * bytes.length);
}
