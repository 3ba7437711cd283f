// What the page remembers from visit to visit; nothing where the browser forbids it.

const PREFIX = 'mjarm.';

function openStore() {
  try {
    const store = window.localStorage;
    store.getItem(PREFIX);
    return store;
  } catch {
    return null;
  }
}
const store = openStore();

/** @returns {string|null} what was remembered under this name */
export function recall(name) {
  try {
    return store?.getItem(PREFIX + name) ?? null;
  } catch {
    return null;
  }
}

/** @param {string} name @param {string} value */
export function remember(name, value) {
  try {
    store?.setItem(PREFIX + name, value);
  } catch {
    // Storage is full or forbidden: then it is forgotten.
  }
}
