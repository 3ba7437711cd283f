// What the page has to say: one notice that stays, and short ones that go by themselves.
import { byTest, el } from './dom.js';
import { onLanguage, t } from './words.js';

const STAYS = 4500; // [ms]

export class Notices {
  #notice = byTest('notice');
  #toasts = byTest('toasts');
  #now = null;

  constructor() {
    onLanguage(() => this.#now && this.show(this.#now));
  }

  /**
   * Stays until `hide`.
   * @param {{title: string, more?: string, text?: string, bad?: boolean, action?: {word: string, run: () => void}}}
   *     what  words of the page by key; `text` as it comes
   */
  show(what) {
    this.#now = what;
    const { title, more, text, bad, action } = what;
    const parts = [el('h2', {}, t(title, ...(what.values ?? [])))];
    if (text) parts.push(el('p', {}, text));
    if (more) parts.push(el('p', {}, t(more)));
    if (action) {
      const on = { click: action.run };
      parts.push(el('button', { type: 'button', test: 'notice-action', on }, t(action.word)));
    }
    this.#notice.replaceChildren(...parts);
    this.#notice.classList.toggle('bad', Boolean(bad));
    this.#notice.hidden = false;
  }

  hide() {
    this.#now = null;
    this.#notice.hidden = true;
  }

  /** Goes by itself. */
  say(text, bad = false) {
    const same = [...this.#toasts.children].find((toast) => toast.textContent === text);
    same?.remove();
    const toast = el('p', { class: bad ? 'toast bad' : 'toast', test: 'toast' }, text);
    this.#toasts.append(toast);
    while (this.#toasts.children.length > 3) this.#toasts.firstChild.remove();
    setTimeout(() => toast.remove(), STAYS);
  }
}
