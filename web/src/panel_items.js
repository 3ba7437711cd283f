// The controls of the server's panels, one maker a kind. Each gives {node, show(item)}.
import { dial } from './dial.js';
import { el } from './dom.js';
import { stands } from './stands.js';
import { label, t } from './words.js';

const DIGITS = 4; // that count

/** @typedef {{node: HTMLElement, show: (item: object) => void}} Control */

/** @type {Object<string, (item: object, test: string, use: (value: number) => void) => Control>} */
export const MAKERS = {
  button(item, test, use) {
    const node = el('button', { type: 'button', class: 'half', test, on: { click: () => use(1) } }, item.name);
    return { node, show: ({ enabled }) => { node.disabled = !enabled; } };
  },

  checkbox(item, test, use) {
    const state = stands((on) => { box.checked = on; });
    const box = el('input', {
      type: 'checkbox', test,
      on: {
        change() {
          state.touch();
          use(box.checked ? 1 : 0);
        },
      },
    });
    const node = el('label', { class: 'switch half', title: item.name }, box, el('span', {}, item.name));
    return {
      node,
      show({ on, enabled }) {
        state.show(on);
        box.disabled = !enabled;
      },
    };
  },

  slider(item, test, use) {
    const range = item.upper - item.lower;
    const own = dial({
      name: item.name, test, lower: item.lower, upper: item.upper, step: niceStep(range / 100),
      digits: digitsOf(range), valueName: t('joint_value', item.name), onValue: use,
    });
    return {
      node: own.node,
      show({ value, lower, upper, enabled }) {
        own.range(lower, upper);
        own.show(value);
        own.enable(enabled);
      },
    };
  },

  text(item, test) {
    const value = el('span', { class: 'value', test });
    const node = el('div', { class: 'row' }, el('span', { class: 'name', title: item.name }, item.name), value);
    return {
      node,
      show(now) {
        if (value.textContent !== now.value) value.textContent = now.value;
        node.classList.toggle('off', !now.enabled);
      },
    };
  },

  choice(item, test, use) {
    const state = stands((current) => { menu.selectedIndex = current; });
    const menu = el('select', {
      class: 'pick', test,
      on: {
        change() {
          state.touch();
          use(menu.selectedIndex);
        },
      },
    });
    label(menu, item.name);
    const node = el('div', { class: 'row pick-row' }, el('span', { class: 'name', title: item.name }, item.name), menu);
    let words = '';
    return {
      node,
      show(now) {
        if (words !== now.words.join('\n')) {
          words = now.words.join('\n');
          menu.replaceChildren(...now.words.map((word) => el('option', {}, word)));
        }
        state.show(now.current);
        menu.disabled = !now.enabled;
      },
    };
  },

  list(item, test, use) {
    const node = el('div', { class: 'list', role: 'group', test });
    label(node, item.name);
    let lines = null;
    let current = -1;
    return {
      node,
      show(now) {
        if (lines !== now.lines.join('\n')) {
          lines = now.lines.join('\n');
          current = -1;
          node.replaceChildren(...now.lines.map((line, index) => el('button', {
            type: 'button', test: `${test}-${index}`, on: { click: () => use(index) },
          }, line)));
        }
        for (const button of node.children) button.disabled = !now.enabled;
        if (current === now.current) return;
        current = now.current;
        [...node.children].forEach((button, index) => button.setAttribute('aria-current', String(index === current)));
        scrollTo(node, node.children[current]);
      },
    };
  },

  timeline(item, test, use) {
    const state = stands(({ time, end }) => {
      slider.max = String(end);
      slider.value = String(time);
      draw(time);
    });
    const value = el('span', { class: 'value', test: `${test}-value` });
    const slider = el('input', {
      type: 'range', class: 'track', test, min: 0, step: 'any',
      on: {
        input() {
          state.touch();
          draw(Number(slider.value));
          use(Number(slider.value));
        },
        pointerdown: state.hold,
        pointerup: state.release,
        pointercancel: state.release,
        keydown: step,
      },
    });
    label(slider, item.name || t('time'));
    function draw(time) {
      const end = Number(slider.max);
      value.textContent = t('of_end', time.toFixed(2), end.toFixed(2));
      slider.style.setProperty('--filled', `${((100 * time) / (end || 1)).toFixed(2)}%`);
      slider.setAttribute('aria-valuetext', value.textContent);
    }
    function step(event) {
      const way = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 }[event.key];
      if (way === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      slider.value = String(Number(slider.value) + (way * (event.shiftKey ? 10 : 1) * Number(slider.max)) / 200);
      slider.dispatchEvent(new Event('input'));
    }
    const head = el('div', { class: 'row' }, el('span', { class: 'name' }, item.name), value);
    return {
      node: el('div', { class: 'timeline' }, head, slider),
      show(now) {
        slider.disabled = !now.enabled;
        state.show(now);
      },
    };
  },
};

/** 1, 2 or 5 times a power of ten, about so large. */
function niceStep(about) {
  if (!(about > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(about));
  return power * ([1, 2, 5].find((f) => f * power >= 0.999 * about) ?? 10);
}

function digitsOf(range) {
  if (!(range > 0)) return 2;
  return Math.max(0, Math.min(6, DIGITS - 1 - Math.floor(Math.log10(range))));
}

/** Scrolls the list alone, not what is round it. */
function scrollTo(list, line) {
  if (!line) return;
  const top = line.offsetTop - list.offsetTop;
  if (top < list.scrollTop || top + line.offsetHeight > list.scrollTop + list.clientHeight) {
    list.scrollTop = top - list.clientHeight / 2;
  }
}
