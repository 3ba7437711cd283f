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
    node.style.transform = `translate(${Math.round(pointer.x + 14)}px, ${Math.round(pointer.y - above)}px)`;
  }

  hide() {
    this.#node.hidden = true;
  }
}
