// Mouse, touch and pen over the scene. A tool takes hold of the pointer, else the view does.

const CLICK_WAY = 5; // [pixels] a click may move
const DOUBLE = 380; // [ms] between two clicks
const DOUBLE_WAY = 24; // [pixels]
const LONG = 480; // [ms] until a press is a long one
const TURN = 0.0065; // [rad] a pixel

/**
 * @typedef {object} Pointer
 * @property {number} x  [CSS pixels] in the canvas
 * @property {number} y
 * @property {number} button  0 left
 * @property {string} type  mouse, touch or pen
 * @property {boolean} ctrl
 * @property {boolean} long  after a long press
 */

/**
 * @typedef {object} Tool
 * @property {(pointer: Pointer) => boolean} begin  whether it takes hold
 * @property {(pointer: Pointer) => void} move
 * @property {() => void} end
 * @property {(pointer: Pointer) => string|null} hover  the cursor over it, null where it is not
 */

export class PointerHub {
  #canvas;
  #eye;
  #tools;
  #down = new Map(); // pointers that are pressed, by id
  #tool = null;
  #lastClick = null;
  #longTimer = 0;
  #hover = null;
  /** @type {(pointer: Pointer) => void} */
  onClick = () => {};
  /** @type {(pointer: Pointer) => void} */
  onDouble = () => {};

  /** @param {HTMLCanvasElement} canvas @param {import('./eye.js').Eye} eye @param {Tool[]} tools */
  constructor(canvas, eye, tools) {
    this.#canvas = canvas;
    this.#eye = eye;
    this.#tools = tools;
    canvas.addEventListener('pointerdown', (event) => this.#press(event));
    canvas.addEventListener('pointermove', (event) => this.#moveTo(event));
    canvas.addEventListener('pointerup', (event) => this.#lift(event, true));
    canvas.addEventListener('pointercancel', (event) => this.#lift(event, false));
    canvas.addEventListener('lostpointercapture', (event) => this.#lift(event, false));
    canvas.addEventListener('pointerleave', () => { this.#hover = null; });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    window.addEventListener('blur', () => this.#letGo());
    canvas.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
  }

  /** Once a picture: what the mouse is over. */
  update() {
    if (!this.#hover || this.#down.size > 0) return;
    const pointer = this.#hover;
    this.#hover = null;
    let cursor = null;
    for (const tool of this.#tools) {
      const own = tool.hover(pointer); // each of them is asked, so that none stays bright
      cursor ??= own;
    }
    this.#canvas.style.cursor = cursor ?? '';
  }

  #read(event, long = false) {
    const box = this.#canvas.getBoundingClientRect();
    return {
      x: event.clientX - box.left, y: event.clientY - box.top, button: Math.max(event.button, 0),
      type: event.pointerType || 'mouse', ctrl: event.ctrlKey || event.metaKey, shift: event.shiftKey, long,
    };
  }

  #press(event) {
    event.preventDefault();
    this.#canvas.focus({ preventScroll: true, focusVisible: false });
    this.#canvas.setPointerCapture(event.pointerId);
    const pointer = this.#read(event);
    this.#down.set(event.pointerId, { ...pointer, startX: pointer.x, startY: pointer.y, moved: false });
    clearTimeout(this.#longTimer);
    if (this.#down.size > 1) {
      this.#endTool(); // a second finger moves the view
      for (const other of this.#down.values()) other.moved = true;
      return;
    }
    this.#tool = this.#tools.find((tool) => tool.begin(pointer)) ?? null;
    if (!this.#tool && pointer.type !== 'mouse') {
      this.#longTimer = setTimeout(() => this.#pressLong(event), LONG);
    }
  }

  #pressLong(event) {
    const held = this.#down.get(event.pointerId);
    if (!held || held.moved || this.#down.size !== 1) return;
    const pointer = { ...held, long: true };
    this.#tool = this.#tools.find((tool) => tool.begin(pointer)) ?? null;
    if (!this.#tool) return;
    held.moved = true;
    navigator.vibrate?.(15);
  }

  #moveTo(event) {
    const held = this.#down.get(event.pointerId);
    const pointer = this.#read(event);
    if (!held) {
      if (pointer.type !== 'touch') this.#hover = pointer;
      return;
    }
    const [dx, dy] = [pointer.x - held.x, pointer.y - held.y];
    const before = this.#spread();
    held.x = pointer.x;
    held.y = pointer.y;
    if (Math.hypot(held.x - held.startX, held.y - held.startY) > CLICK_WAY) held.moved = true;
    if (this.#tool) {
      this.#tool.move({ ...pointer, button: held.button });
    } else if (this.#down.size === 2) {
      this.#pinch(before, this.#spread());
    } else if (this.#down.size === 1 && held.moved) {
      if (held.button === 0 && !event.shiftKey) this.#eye.turn(dx * TURN, -dy * TURN);
      else this.#eye.move(dx, dy);
    }
  }

  #lift(event, click) {
    const held = this.#down.get(event.pointerId);
    if (!held) return;
    clearTimeout(this.#longTimer);
    this.#down.delete(event.pointerId);
    const used = this.#tool !== null;
    this.#endTool();
    if (click && !used && !held.moved && held.button === 0 && this.#down.size === 0) this.#click(held);
  }

  #click(pointer) {
    const now = performance.now();
    const last = this.#lastClick;
    const near = last && Math.hypot(pointer.x - last.x, pointer.y - last.y) < DOUBLE_WAY;
    if (near && now - last.at < DOUBLE) {
      this.#lastClick = null;
      this.onDouble(pointer);
    } else {
      this.#lastClick = { x: pointer.x, y: pointer.y, at: now };
      this.onClick(pointer);
    }
  }

  #endTool() {
    this.#tool?.end();
    this.#tool = null;
  }

  #letGo() {
    clearTimeout(this.#longTimer);
    this.#down.clear();
    this.#endTool();
  }

  /** Middle and distance of two fingers. */
  #spread() {
    const [a, b] = [...this.#down.values()];
    if (!b) return null;
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, way: Math.hypot(a.x - b.x, a.y - b.y) };
  }

  #pinch(before, now) {
    this.#eye.move(now.x - before.x, now.y - before.y);
    if (now.way > 10 && before.way > 10) this.#eye.zoom(before.way / now.way);
  }

  #wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    const way = Math.max(-240, Math.min(240, event.deltaY * lines));
    this.#eye.zoom(Math.exp(0.0014 * way));
  }
}
