// Panels on and off, height of the plots, and the sheet of a phone.
import { byTest } from './dom.js';
import { recall, remember } from './settings.js';

const LEVELS = [0, 0.42, 0.72]; // of the height of the window: how far the sheet is drawn up
const TAP_WAY = 6; // [pixels]
const LOWEST = 120; // [pixels] of the plots

export class Layout {
  #page = byTest('page');
  #plots = byTest('plots');
  #level = 1;

  constructor() {
    byTest('hide-side').addEventListener('click', () => this.toggleSide());
    this.#setSide(recall('side') !== 'off');
    for (const tab of ['side', 'plots']) this.#wireTab(byTest(`tab-${tab}`), tab);
    this.#wireSheet(byTest('sheet-head'), byTest('sheet-grip'));
    this.#wireSplitter(byTest('plots-splitter'));
    this.#setPlots(Number(recall('plots')) || 232);
    this.#setSheet(LEVELS[this.#level]);
  }

  toggleSide() {
    const on = this.#page.classList.contains('no-side');
    this.#setSide(on);
    remember('side', on ? 'on' : 'off');
  }

  #setSide(on) {
    this.#page.classList.toggle('no-side', !on);
    byTest('hide-side').setAttribute('aria-pressed', String(on));
  }

  #wireTab(button, tab) {
    button.addEventListener('click', () => {
      const again = (this.#page.dataset.tab ?? 'side') === tab;
      this.#page.dataset.tab = tab;
      for (const name of ['side', 'plots']) byTest(`tab-${name}`).setAttribute('aria-selected', String(name === tab));
      if (this.#level === 0) this.#go(1);
      else if (again) this.#go(0);
    });
    button.addEventListener('keydown', (event) => {
      if (event.key !== 'ArrowLeft' && event.key !== 'ArrowRight') return;
      event.preventDefault();
      event.stopPropagation();
      const other = byTest(tab === 'side' ? 'tab-plots' : 'tab-side');
      other.focus();
      other.click();
    });
  }

  /** The head of the sheet follows the finger and ends at the nearest level. */
  #wireSheet(head, grip) {
    let start = null;
    head.addEventListener('pointerdown', (event) => {
      start = { y: event.clientY, share: this.#share, moved: false };
    });
    head.addEventListener('pointermove', (event) => {
      if (!start) return;
      if (!start.moved && Math.abs(event.clientY - start.y) < TAP_WAY) return;
      if (!start.moved) head.setPointerCapture(event.pointerId);
      start.moved = true;
      this.#page.classList.add('sheet-moving');
      this.#setSheet(start.share + (start.y - event.clientY) / window.innerHeight);
    });
    const stop = () => {
      if (start?.moved) {
        const way = (level) => Math.abs(LEVELS[level] - this.#share);
        this.#go([0, 1, 2].sort((a, b) => way(a) - way(b))[0]);
      }
      this.#page.classList.remove('sheet-moving');
      start = null;
    };
    head.addEventListener('pointerup', stop);
    head.addEventListener('pointercancel', stop);
    grip.addEventListener('click', () => this.#go((this.#level + 1) % LEVELS.length));
  }

  #share = 0;
  #go(level) {
    this.#level = level;
    this.#setSheet(LEVELS[level]);
  }

  #setSheet(share) {
    this.#share = Math.max(0, Math.min(0.8, share));
    this.#page.style.setProperty('--sheet', `${(100 * this.#share).toFixed(1)}dvh`);
  }

  #wireSplitter(splitter) {
    let start = null;
    splitter.addEventListener('pointerdown', (event) => {
      splitter.setPointerCapture(event.pointerId);
      start = { y: event.clientY, height: this.#plots.offsetHeight };
    });
    splitter.addEventListener('pointermove', (event) => {
      if (start) this.#setPlots(start.height + start.y - event.clientY);
    });
    const stop = () => {
      start = null;
      remember('plots', String(this.#height));
    };
    splitter.addEventListener('pointerup', stop);
    splitter.addEventListener('pointercancel', stop);
    splitter.addEventListener('keydown', (event) => {
      const way = { ArrowUp: 20, ArrowDown: -20 }[event.key];
      if (way === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      this.#setPlots(this.#height + way);
      stop();
    });
  }

  #height = 0;
  #setPlots(height) {
    this.#height = Math.round(Math.max(LOWEST, Math.min(0.7 * window.innerHeight, height)));
    this.#page.style.setProperty('--plots', `${this.#height}px`);
    byTest('plots-splitter').setAttribute('aria-valuenow', String(this.#height));
  }
}
