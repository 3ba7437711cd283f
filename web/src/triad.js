// The axes of the world in a corner, as the camera sees them; a click looks along one.
import { svg } from './dom.js';
import { label, onLanguage, t } from './words.js';

const COLORS = ['#e5484d', '#3d9a50', '#3e7bfa'];
const LETTERS = ['x', 'y', 'z'];
const LENGTH = 30;
const FACING = {
  '+x': [Math.PI, 0], '-x': [0, 0], '+y': [-Math.PI / 2, 0], '-y': [Math.PI / 2, 0],
  '+z': [Math.PI / 2, -Math.PI / 2], '-z': [Math.PI / 2, Math.PI / 2],
};

export class Triad {
  #eye;
  #picture = svg('svg', { viewBox: '-42 -42 84 84' });
  #lines = svg('g');
  #knobs = svg('g');
  #ends;

  /** @param {HTMLElement} place @param {import('./eye.js').Eye} eye */
  constructor(place, eye) {
    this.#eye = eye;
    this.#ends = ['+', '-'].flatMap((sign) => LETTERS.map((letter, axis) => this.#end(sign, letter, axis)));
    this.#picture.append(this.#lines, this.#knobs);
    place.append(this.#picture);
    const words = () => this.#ends.forEach(({ knob, name }) => label(knob, t('axis_view', name)));
    onLanguage(words);
    words();
  }

  update() {
    const [right, up, forward] = [this.#eye.right, this.#eye.up, this.#eye.forward];
    for (const end of this.#ends) {
      const way = end.sign === '+' ? 1 : -1;
      const key = LETTERS[end.axis];
      const [x, y] = [way * LENGTH * right[key], -way * LENGTH * up[key]];
      end.depth = way * forward[key];
      end.line?.setAttribute('x2', x.toFixed(2));
      end.line?.setAttribute('y2', y.toFixed(2));
      end.knob.setAttribute('transform', `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
    }
    // What is nearer is drawn later; the order only changes where it has to, to keep the focus.
    const wanted = [...this.#ends].sort((a, b) => b.depth - a.depth).map(({ knob }) => knob);
    if (wanted.some((knob, index) => this.#knobs.children[index] !== knob)) {
      const held = document.activeElement;
      this.#knobs.replaceChildren(...wanted);
      if (wanted.includes(held)) held.focus();
    }
  }

  #end(sign, letter, axis) {
    const name = `${sign}${letter}`;
    const plus = sign === '+';
    const line = plus ? svg('line', { x1: 0, y1: 0, stroke: COLORS[axis], 'stroke-width': 2.5 }) : null;
    const disc = svg('circle', {
      r: plus ? 8.5 : 5.5, fill: COLORS[axis], 'fill-opacity': plus ? 1 : 0.28,
      stroke: COLORS[axis], 'stroke-width': 1.2,
    });
    const go = () => this.#eye.face(...FACING[name]);
    const knob = svg('g', {
      class: 'knob', role: 'button', tabindex: plus ? 0 : -1, test: `axis${name}`,
      on: {
        click: go,
        keydown: (event) => {
          if (event.key !== 'Enter' && event.key !== ' ') return;
          event.preventDefault();
          event.stopPropagation();
          go();
        },
      },
    });
    knob.append(disc);
    if (plus) knob.append(svg('text', {}, letter));
    if (line) this.#lines.append(line);
    return { sign, axis, name, knob, line, depth: 0 };
  }
}
