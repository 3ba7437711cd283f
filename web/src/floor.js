// The look of planes: a plain floor with a grid of 0.1 m and 1 m that fades far away.
import { Color, MeshLambertMaterial, Vector3 } from 'three';
import { colorOf } from './paint.js';

const HEAD = `
uniform vec3 lineColor;
uniform vec3 middle;
uniform float reach;
uniform float gridShare;
uniform float bare;
varying vec3 floorPoint;
varying vec3 floorWorld;
float gridLines(vec2 p, float gap, float width) {
  vec2 pixel = max(fwidth(p), vec2(1e-6));
  vec2 away = abs(fract(p / gap - 0.5) - 0.5) * gap;
  vec2 line = clamp(0.5 * width + 0.5 - away / pixel, 0.0, 1.0);
  vec2 seen = clamp(1.0 - 2.5 * pixel / gap, 0.0, 1.0);
  return max(line.x * seen.x, line.y * seen.y);
}`;

const BODY = `
{
  float small = 0.45 * gridLines(floorPoint.xy, 0.1, 0.6);
  float large = gridLines(floorPoint.xy, 1.0, 1.3);
  float lines = gridShare * max(small, large);
  diffuseColor.rgb = mix(diffuseColor.rgb, lineColor, lines);
  diffuseColor.a *= mix(1.0, lines, bare);
  diffuseColor.a *= 1.0 - smoothstep(0.35 * reach, reach, distance(floorWorld, middle));
}`;

export class FloorLook {
  #uniforms = {
    lineColor: { value: new Color() },
    middle: { value: new Vector3() },
    reach: { value: 10 },
    gridShare: { value: 1 },
  };
  #plain = [];

  /**
   * @param {number[]|null} rgba  of the plane; null draws lines alone
   * @returns {MeshLambertMaterial}
   */
  material(rgba) {
    const material = new MeshLambertMaterial({ transparent: true });
    const uniforms = { ...this.#uniforms, bare: { value: rgba ? 0 : 1 } };
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, uniforms);
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', '#include <common>\nvarying vec3 floorPoint; varying vec3 floorWorld;')
        .replace('#include <project_vertex>', `#include <project_vertex>
          floorPoint = position;
          floorWorld = (modelMatrix * vec4(position, 1.0)).xyz;`);
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>\n${HEAD}`)
        .replace('#include <color_fragment>', `#include <color_fragment>\n${BODY}`);
    };
    material.userData.rgba = rgba;
    this.#plain.push(material);
    return material;
  }

  /** @param {object} palette  see theme.js */
  setPalette(palette) {
    this.#uniforms.lineColor.value.set(palette.line);
    const base = new Color(palette.floor);
    for (const material of this.#plain) {
      const rgba = material.userData.rgba;
      material.color.copy(base);
      // The model's own colour tints the floor of the page.
      if (rgba) material.color.lerp(colorOf(rgba), 0.12);
    }
  }

  /** @param {boolean} on */
  setGrid(on) {
    this.#uniforms.gridShare.value = on ? 1 : 0;
  }

  /** Fades round this point. @param {Vector3} middle @param {number} reach [m] */
  setView(middle, reach) {
    this.#uniforms.middle.value.copy(middle);
    this.#uniforms.reach.value = reach;
  }
}
