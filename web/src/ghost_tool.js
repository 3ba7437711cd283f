// Ghosts that can be chosen: seen under the mouse, told to the server by a click.

const BRIGHT = 2.6; // glow under the mouse

export class GhostTool {
  enabled = true;
  #picker;
  #overlay;
  #outbox;
  #stage;
  #bright = null;

  constructor({ picker, overlay, outbox, stage }) {
    this.#picker = picker;
    this.#overlay = overlay;
    this.#outbox = outbox;
    this.#stage = stage;
  }

  // A tool of the pointer that never takes hold: a drag over a ghost turns the view.

  begin() {
    return false;
  }

  hover(pointer) {
    const hit = this.#find(pointer);
    const bright = hit?.object ?? null;
    if (bright?.material !== this.#bright) this.#light(bright?.material ?? null);
    return hit ? 'pointer' : null;
  }

  /** @returns {boolean} whether there was one */
  click(pointer) {
    const ghost = this.#find(pointer)?.object.userData.ghost;
    if (!ghost) return false;
    this.#outbox.send({ type: 'panel', id: ghost.item, value: ghost.value });
    return true;
  }

  #find({ x, y }) {
    const meshes = this.enabled ? this.#overlay.clickable() : [];
    return meshes.length > 0 ? this.#picker.firstOf(meshes, x, y) : null;
  }

  #light(material) {
    if (this.#bright) this.#bright.emissiveIntensity = 1;
    this.#bright = material;
    if (material) material.emissiveIntensity = BRIGHT;
    this.#stage.changed();
  }
}
