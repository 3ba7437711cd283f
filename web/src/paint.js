// Colours as they come, and materials of them, one a colour.
import { Color, MeshStandardMaterial, SRGBColorSpace } from 'three';

/** @param {number[]} rgba  each in [0, 1], as on the screen */
export function colorOf([r, g, b]) {
  return new Color().setRGB(r, g, b, SRGBColorSpace);
}

export class Paints {
  #known = new Map();

  /**
   * @param {number[]} rgba
   * @param {number} [clear]  factor of its opacity
   */
  of(rgba, clear = 1) {
    const key = [...rgba, clear].join();
    if (!this.#known.has(key)) this.#known.set(key, makePaint(rgba, clear));
    return this.#known.get(key);
  }
}

function makePaint(rgba, clear) {
  const opacity = (rgba[3] ?? 1) * clear;
  return new MeshStandardMaterial({
    color: colorOf(rgba), roughness: 0.55, metalness: 0.05, opacity,
    transparent: opacity < 1, depthWrite: opacity >= 1,
  });
}

/** The same material, lit up: of what is selected. */
export function litUp(material, color) {
  const lit = material.clone();
  lit.emissive.set(color);
  lit.emissiveIntensity = 0.35;
  return lit;
}
