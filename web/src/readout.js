// A small text beside the pointer: how far something was dragged, how hard something is pulled.

export class Readout {
  #node;

  /** @param {HTMLElement} node */
  constructor(node) {
    this.#node = node;
  }

  /** @param {{x: number, y: number, type?: string}} pointer  in the canvas */
  show(pointer, text) {
    const node = this.#node;
    node.hidden = false;
    node.textContent = text;
    const above = pointer.type === 'touch' ? 76 : 34; // a finger hides what is below it
    const x = Math.min(pointer.x + 14, node.parentElement.clientWidth - 10 * text.length - 16);
    const y = Math.max(pointer.y - above, 4);
    node.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
  }

  hide() {
    this.#node.hidden = true;
  }
}
