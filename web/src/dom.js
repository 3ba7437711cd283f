// Making elements.

const SVG = 'http://www.w3.org/2000/svg';

/**
 * @param {string} tag
 * @param {object} [props]  `class`, `test` (its data-test), `word` and `wordLabel` (see words.js),
 *     `on` with listeners by event; everything else is an attribute, true an empty one
 * @param {...(Node|string)} children
 */
export function el(tag, props = {}, ...children) {
  return make(document.createElement(tag), props, children);
}

/** The same for SVG. */
export function svg(tag, props = {}, ...children) {
  return make(document.createElementNS(SVG, tag), props, children);
}

/** An icon of the page's set (index.html). @param {string} name */
export function icon(name) {
  return svg('svg', { class: 'icon', 'aria-hidden': 'true' }, svg('use', { href: `#i-${name}` }));
}

function make(node, props, children) {
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'on') {
      for (const [event, listener] of Object.entries(value)) node.addEventListener(event, listener);
    } else if (name === 'test') {
      node.dataset.test = value;
    } else if (name === 'word') {
      node.dataset.word = value;
    } else if (name === 'wordLabel') {
      node.dataset.wordLabel = value;
    } else {
      node.setAttribute(name, value === true ? '' : String(value));
    }
  }
  node.append(...children);
  return node;
}

/** The element of the page with this data-test. @param {string} test */
export function byTest(test) {
  return document.querySelector(`[data-test="${test}"]`);
}

/** A name that can stand in a data-test. @param {string} text */
export function slug(text) {
  return text.trim().replace(/\s+/g, '-');
}
