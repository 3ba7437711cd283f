// A field for a number: typed, or changed by the arrow keys.
import { el } from './dom.js';

/**
 * @typedef {object} NumberBox
 * @property {HTMLInputElement} node
 * @property {(value: number) => void} show  as long as nobody types in it
 * @property {(on: boolean) => void} enable
 */

/**
 * @param {object} options
 * @param {string} options.test
 * @param {number} options.step  of an arrow key
 * @param {number} options.digits
 * @param {number|null} options.lower
 * @param {number|null} options.upper
 * @param {(value: number) => void} options.onValue
 * @returns {NumberBox}
 */
export function numberBox({ test, step, digits, lower, upper, onValue }) {
  let shown = NaN; // nothing yet
  let typing = false;
  const node = el('input', {
    class: 'number', test, type: 'text', inputmode: 'decimal', role: 'spinbutton', autocomplete: 'off',
    spellcheck: 'false', 'aria-valuemin': lower, 'aria-valuemax': upper,
    on: { input: () => { typing = true; }, blur: take, focus: () => node.select(), keydown: press },
  });

  function within(value) {
    return Math.min(upper ?? Infinity, Math.max(lower ?? -Infinity, value));
  }

  function read() {
    const text = node.value.trim().replace(',', '.').replace('−', '-');
    const value = Number(text);
    return text !== '' && Number.isFinite(value) ? within(value) : null;
  }

  function write(value) {
    shown = value;
    const text = value.toFixed(digits);
    node.value = Number(text) === 0 ? (0).toFixed(digits) : text;
    node.setAttribute('aria-valuenow', node.value);
    node.removeAttribute('aria-invalid');
  }

  function take() {
    if (!typing) return true;
    const value = read();
    if (value === null) {
      node.setAttribute('aria-invalid', 'true');
      if (document.activeElement === node) return false;
      typing = false;
      write(shown);
      return false;
    }
    typing = false;
    write(value);
    onValue(value);
    return true;
  }

  function press(event) {
    if (event.key === 'Enter') {
      if (take()) node.select();
    } else if (event.key === 'Escape') {
      typing = false;
      write(shown);
      node.select();
    } else if (event.key === 'ArrowUp' || event.key === 'ArrowDown') {
      event.preventDefault();
      const way = (event.key === 'ArrowUp' ? 1 : -1) * (event.shiftKey ? 10 : 1) * step;
      const value = within((typing ? read() ?? shown : shown) + way);
      if (!Number.isFinite(value)) return;
      typing = false;
      write(value);
      onValue(value);
    } else {
      return;
    }
    event.stopPropagation();
  }

  return {
    node,
    show(value) {
      if (!typing && value !== shown) write(value);
    },
    enable(on) {
      node.disabled = !on;
    },
  };
}
