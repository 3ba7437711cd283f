// A text at a point of the world, always of the same size on the screen.
import { CanvasTexture, LinearFilter, Sprite, SpriteMaterial, SRGBColorSpace } from 'three';
import { FONTS, theme } from './theme.js';

const FONT = `500 13px ${FONTS}`;
const SHARP = 2; // pixels of the texture a pixel of the page
const LONGEST = 99; // characters

export function makeLabel(first, { front, eye }) {
  const { texture, width, height } = drawText(first.text.slice(0, LONGEST));
  const sprite = new Sprite(new SpriteMaterial({ map: texture, depthTest: false, transparent: true }));
  sprite.center.set(0, 0);
  front.add(sprite);
  return {
    set: (item) => sprite.position.set(...item.pos),
    look() {
      const pixel = eye.metresPerPixel(sprite.position);
      sprite.scale.set(width * pixel, height * pixel, 1);
    },
    dispose() {
      sprite.removeFromParent();
      texture.dispose();
      sprite.material.dispose();
    },
  };
}

function drawText(text) {
  const canvas = document.createElement('canvas');
  const pen = canvas.getContext('2d');
  pen.font = FONT;
  const width = Math.ceil(pen.measureText(text).width) + 14;
  const height = 22;
  canvas.width = SHARP * width;
  canvas.height = SHARP * height;
  pen.scale(SHARP, SHARP);
  pen.font = FONT;
  pen.fillStyle = theme.palette.labelBack;
  pen.beginPath();
  pen.roundRect(0, 0, width, height, 5);
  pen.fill();
  pen.fillStyle = theme.palette.label;
  pen.textBaseline = 'middle';
  pen.fillText(text, 7, height / 2 + 0.5);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearFilter;
  texture.generateMipmaps = false;
  return { texture, width, height };
}
