// A part of the panels with a title, which is folded away and back.
import { el, icon } from './dom.js';
import { recall, remember } from './settings.js';

let count = 0;

/**
 * @param {object} options
 * @param {string} options.test
 * @param {string} [options.title]  as it comes
 * @param {string} [options.word]   or of the page's words
 * @param {boolean} options.open    at first; what the user did before counts more
 * @param {...Node} children
 * @returns {{node: HTMLElement, body: HTMLElement}}
 */
export function section({ test, title, word, open, children = [] }) {
  const memory = `section.${title ?? test}`;
  const id = `section-${++count}`;
  const name = el('span', { word });
  if (title !== undefined) name.textContent = title;
  const body = el('div', { class: 'section-body', id, test: `${test}-body` }, ...children);
  const head = el('button', {
    type: 'button', test: `${test}-head`, 'aria-controls': id, on: { click: () => set(body.hidden, true) },
  }, icon('fold'), name);

  function set(shown, byUser) {
    body.hidden = !shown;
    head.setAttribute('aria-expanded', String(shown));
    if (byUser) remember(memory, shown ? 'open' : 'closed');
  }
  const before = recall(memory);
  set(before === null ? open : before === 'open', false);
  return { node: el('section', { class: 'section', test }, el('h2', {}, head), body), body };
}
