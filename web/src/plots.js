// The plots that the server has on, below the scene.
import { el } from './dom.js';
import { Figure } from './figure.js';
import { fill } from './words.js';

export class Plots {
  #place;
  #figures = [];
  #plots = [];
  #empty = el('p', { class: 'empty', word: 'no_plots' });
  #waits = null;

  /** @param {HTMLElement} section @param {HTMLElement} place  of the figures */
  constructor(section, place) {
    this.section = section;
    this.#place = place;
    this.#show();
  }

  /** Kept until the next picture. @param {object[]} plots */
  take(plots) {
    this.#waits = plots;
  }

  /** Before each picture. */
  update() {
    if (!this.#waits || document.hidden) return;
    this.#plots = this.#waits;
    this.#waits = null;
    this.#show();
  }

  /** @param {number} time  [s] of what the scene shows */
  setTime(time) {
    for (const figure of this.#figures) figure.setTime(time);
  }

  /** Anew, in the colours of the page. */
  refresh() {
    this.#show();
  }

  #show() {
    this.section.classList.toggle('empty', this.#plots.length === 0);
    while (this.#figures.length > this.#plots.length) this.#figures.pop().dispose();
    while (this.#figures.length < this.#plots.length) {
      const figure = new Figure(`plot-${this.#figures.length}`);
      this.#figures.push(figure);
      this.#place.append(figure.node);
    }
    if (this.#plots.length > 0) {
      this.#empty.remove();
    } else {
      this.#place.append(this.#empty);
      fill(this.#place);
    }
    this.#plots.forEach((plot, index) => this.#figures[index].show(plot));
  }
}
