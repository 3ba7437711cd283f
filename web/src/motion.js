// Whether things may glide on the screen, as the user set it in the system.

const still = window.matchMedia('(prefers-reduced-motion: reduce)');

/** @returns {boolean} */
export function mayGlide() {
  return !still.matches;
}
