// A slider with its name and a field for its value. What the user does stands for a moment, whatever
// is shown from outside meanwhile.
import { el } from './dom.js';
import { label } from './words.js';
import { numberBox } from './number_box.js';
import { stands } from './stands.js';

/**
 * @typedef {object} Dial
 * @property {HTMLElement} node
 * @property {(value: number) => void} show
 * @property {(on: boolean) => void} enable
 * @property {(lower: number, upper: number) => void} range
 */

/**
 * @param {object} options
 * @param {string} options.name
 * @param {string} options.test
 * @param {number} options.lower  of the slider
 * @param {number} options.upper
 * @param {number} options.step   of the arrow keys in the field
 * @param {number} options.digits
 * @param {string} [options.unit]
 * @param {boolean} [options.endless]  the field takes numbers beyond the slider's ends
 * @param {string} options.valueName  of the field
 * @param {(value: number) => void} options.onValue
 * @returns {Dial}
 */
export function dial(options) {
  const { name, test, digits, unit, onValue } = options;
  const state = stands((value) => draw(value));
  const slider = el('input', {
    type: 'range', class: 'track', test: `${test}-slider`, step: 'any', min: options.lower, max: options.upper,
    on: {
      input: () => use(Number(slider.value), true),
      pointerdown: state.hold,
      pointerup: state.release,
      pointercancel: state.release,
      keydown: stepByKey,
    },
  });
  label(slider, name);
  const box = numberBox({
    test: `${test}-value`, step: options.step, digits,
    lower: options.endless ? null : options.lower, upper: options.endless ? null : options.upper,
    onValue: (value) => use(value, false),
  });
  label(box.node, options.valueName);
  const node = el('div', { class: unit === undefined ? 'dial plain' : 'dial', test });
  node.append(el('span', { class: 'name', title: name }, name), box.node);
  if (unit !== undefined) node.append(el('span', { class: 'unit' }, unit));
  node.append(slider);

  function use(value, bySlider) {
    state.touch();
    draw(value, bySlider);
    onValue(value);
  }

  function draw(value, bySlider = false) {
    if (!bySlider) slider.value = String(value);
    box.show(value);
    const [low, high] = [Number(slider.min), Number(slider.max)];
    const share = Math.max(0, Math.min(1, (value - low) / (high - low || 1)));
    slider.style.setProperty('--filled', `${(100 * share).toFixed(2)}%`);
    slider.setAttribute('aria-valuetext', `${value.toFixed(digits)} ${unit ?? ''}`.trim());
  }

  // The browser's own steps of a slider without steps are too coarse.
  function stepByKey(event) {
    const way = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (way === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const value = Number(slider.value) + way * (event.shiftKey ? 10 : 1) * options.step;
    use(Math.min(Number(slider.max), Math.max(Number(slider.min), value)), false);
  }

  return {
    node,
    show: state.show,
    enable(on) {
      slider.disabled = !on;
      box.enable(on);
    },
    range(lower, upper) {
      slider.min = String(lower);
      slider.max = String(upper);
    },
  };
}
