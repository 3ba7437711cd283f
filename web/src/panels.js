// The sections that the server wants shown. The elements stay as long as the shape of the panels is
// the same, so that what is held or typed is not lost when values change.
import { el } from './dom.js';
import { MAKERS } from './panel_items.js';
import { section } from './section.js';

export class Panels {
  node = el('div', { test: 'panels' });
  #outbox;
  #shape = '';
  #controls = [];
  #sections = [];
  #enabled = true;

  /** @param {import('./outbox.js').Outbox} outbox */
  constructor(outbox) {
    this.#outbox = outbox;
  }

  /** @param {object[]} sections  see `panels` of the protocol */
  take(sections) {
    this.#sections = sections;
    const shape = JSON.stringify(sections.map(({ title, items }) => [title, items.map((i) => [i.id, i.kind, i.name])]));
    if (shape !== this.#shape) {
      this.#shape = shape;
      this.#build(sections);
    }
    let next = 0;
    for (const { items } of sections) {
      for (const item of items) {
        this.#controls[next++]?.show({ ...item, enabled: item.enabled && this.#enabled });
      }
    }
  }

  /** As the server told them last. */
  get sections() {
    return this.#sections;
  }

  enable(on) {
    this.#enabled = on;
    this.take(this.#sections);
  }

  /** The words of the page in it, after a change of the language. */
  refresh() {
    this.#shape = '';
    this.take(this.#sections);
  }

  #build(sections) {
    const held = document.activeElement?.dataset?.test;
    this.#controls = [];
    this.node.replaceChildren(...sections.map(({ title, open, items }, index) => {
      const controls = items.map((item) => this.#make(item));
      this.#controls.push(...controls);
      const nodes = controls.filter(Boolean).map((control) => control.node);
      pairUp(nodes);
      return section({ test: `section-${index}`, title, open, children: nodes }).node;
    }));
    if (held) this.node.querySelector(`[data-test="${CSS.escape(held)}"]`)?.focus({ preventScroll: true });
  }

  #make(item) {
    const flows = item.kind === 'slider' || item.kind === 'timeline';
    const use = (value) => {
      const message = { type: 'panel', id: item.id, value };
      if (flows) this.#outbox.sendLatest(`panel ${item.id}`, message);
      else this.#outbox.send(message);
    };
    return MAKERS[item.kind]?.(item, `panel-${item.id}`, use) ?? null;
  }
}

/** Halves stand in twos; one that is left alone is as wide as the panel. */
function pairUp(nodes) {
  let open = null;
  for (const node of [...nodes, null]) {
    const half = node?.classList.contains('half');
    if (half && open && open.tagName === node.tagName) {
      open = null;
    } else {
      open?.classList.remove('half');
      open = half ? node : null;
    }
  }
}
