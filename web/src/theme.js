// Light and dark: the switch, the system's wish, and the colours of what is drawn in 3D.
import { Emitter } from './emitter.js';
import { recall, remember } from './settings.js';

/** Of texts that are drawn. */
export const FONTS =
  'system-ui, -apple-system, "Segoe UI", "PingFang SC", "Microsoft YaHei", "Noto Sans CJK SC", sans-serif';

const PALETTES = {
  light: {
    skyTop: '#a9bfd6', skyBottom: '#f1f4f7', floor: '#c6cfd9', line: '#97a3b1',
    ambient: 1.25, sun: 2.1, fill: 0.55, label: '#10151c', labelBack: 'rgba(255,255,255,0.82)',
    plotInk: '#39424e', plotGrid: 'rgba(40,52,66,0.13)',
  },
  dark: {
    skyTop: '#151b24', skyBottom: '#3a4452', floor: '#262d37', line: '#566374',
    ambient: 0.95, sun: 2.0, fill: 0.5, label: '#f2f5f8', labelBack: 'rgba(16,20,26,0.78)',
    plotInk: '#aab4c0', plotGrid: 'rgba(200,215,230,0.12)',
  },
};

class Theme extends Emitter {
  #system = window.matchMedia('(prefers-color-scheme: dark)');
  /** @type {'auto'|'light'|'dark'} */
  choice = 'auto';

  constructor() {
    super();
    const before = recall('theme');
    if (before === 'light' || before === 'dark') this.choice = before;
    this.#system.addEventListener('change', () => this.#apply());
  }

  /** @returns {'light'|'dark'} */
  get name() {
    if (this.choice !== 'auto') return this.choice;
    return this.#system.matches ? 'dark' : 'light';
  }

  get palette() {
    return PALETTES[this.name];
  }

  /** @param {'auto'|'light'|'dark'} choice */
  choose(choice) {
    this.choice = choice;
    remember('theme', choice);
    this.#apply();
  }

  #apply() {
    document.documentElement.dataset.theme = this.name;
    this.emit('change', this.palette);
  }

  /** Sets the look of the page the first time. */
  start() {
    this.#apply();
  }
}

export const theme = new Theme();
