// Keys of the page, where no control has them.

const TURN = 0.08; // [rad] a key
const MOVE = 26; // [pixels]
const ZOOM = 1.12;

/** @param {{transport: object, eye: object, viewBar: object, help: object, layout: object, act: object}} page */
export function listenToKeys({ transport, eye, viewBar, help, layout, act }) {
  const keys = {
    ' ': () => transport.togglePause(),
    ArrowRight: () => transport.step(1),
    ArrowLeft: () => transport.step(-1),
    '+': () => transport.changeSpeed(1),
    '=': () => transport.changeSpeed(1),
    '-': () => transport.changeSpeed(-1),
    Backspace: () => transport.reset(),
    t: () => act.target(),
    w: () => eye.move(0, MOVE),
    s: () => eye.move(0, -MOVE),
    a: () => eye.move(MOVE, 0),
    d: () => eye.move(-MOVE, 0),
    PageUp: () => eye.zoom(1 / ZOOM),
    PageDown: () => eye.zoom(ZOOM),
    Home: () => viewBar.firstView(),
    1: () => viewBar.preset('front'),
    2: () => viewBar.preset('side'),
    3: () => viewBar.preset('top'),
    f: () => viewBar.fit(),
    '[': () => viewBar.nextCamera(-1),
    ']': () => viewBar.nextCamera(1),
    c: () => viewBar.toggleCollision(),
    b: () => layout.toggleSide(),
    p: () => act.screenshot(),
    '?': () => help.toggle(),
    F1: () => help.toggle(),
    Escape: () => act.deselect(),
  };
  const shifted = {
    ArrowRight: () => eye.turn(-TURN, 0),
    ArrowLeft: () => eye.turn(TURN, 0),
    ArrowUp: () => eye.turn(0, -TURN),
    ArrowDown: () => eye.turn(0, TURN),
  };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (help.open && event.key !== '?' && event.key !== 'F1') return;
    if (usesKey(event.target, event.key)) return;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const run = (event.shiftKey && shifted[name]) || keys[name];
    if (!run) return;
    event.preventDefault();
    run();
  });
}

/** Whether the control that has the focus needs the key itself. */
function usesKey(node, key) {
  if (node.closest('input:not([type=checkbox]):not([type=range]), textarea')) return true;
  if (node.closest('select')) return key.length > 1 || key === ' ' || /^[a-z0-9]$/i.test(key);
  if (node.closest('button, a, [role=button], input[type=checkbox]')) return key === ' ' || key === 'Enter';
  return false;
}
