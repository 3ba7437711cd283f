// What a user did stands for a moment, whatever is shown from outside meanwhile: what was on its way
// when he did it would put it back and forth again.

const STANDS = 350; // [ms] after the last touch

/**
 * @template T
 * @param {(value: T) => void} draw
 * @returns {{hold: () => void, release: () => void, touch: () => void, show: (value: T) => void}}
 *     `show` draws the value, or the latest one when the moment is over
 */
export function stands(draw) {
  let held = false;
  let until = 0;
  let latest;
  let timer = 0;
  const show = (value) => {
    latest = value;
    const left = until - performance.now();
    if (!held && left <= 0) draw(value);
    else if (!timer) {
      timer = setTimeout(() => {
        timer = 0;
        show(latest);
      }, held ? STANDS : left);
    }
  };
  const touch = () => { until = performance.now() + STANDS; };
  return {
    touch,
    show,
    hold: () => { held = true; },
    release() {
      held = false;
      touch();
    },
  };
}
