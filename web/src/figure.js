// One plot: title, key of its series, chart.
import { el, svg } from './dom.js';
import { makeChart } from './chart.js';
import { theme } from './theme.js';

export class Figure {
  node;
  #caption = el('figcaption');
  #place = el('div', { class: 'chart' });
  #chart = null;
  #shape = '';
  #plot = null;
  #tip = el('div', { class: 'tip', hidden: true });
  #values = [];
  #hidden = new Set();
  #time = null;

  /** @param {string} test */
  constructor(test) {
    this.node = el('figure', { class: 'figure', test }, this.#caption, this.#place);
    new ResizeObserver(() => this.#fit()).observe(this.#place);
  }

  /** @param {object} plot  see `plots` of the protocol */
  show(plot) {
    this.#plot = plot;
    const shape = JSON.stringify([theme.name, plot.title, plot.x_label, plot.equal_aspect, plot.y_from_zero,
      plot.series.map(({ name, rgba, style }) => [name, rgba, style])]);
    if (shape !== this.#shape || !this.#chart) {
      this.#shape = shape;
      this.#build();
    } else {
      this.#chart.setSeries(plot.series);
    }
  }

  /** @param {number} time  [s] of what the scene shows */
  setTime(time) {
    this.#time = time;
    this.#chart?.setTime(time);
  }

  dispose() {
    this.#chart?.dispose();
    this.node.remove();
  }

  #build() {
    this.#chart?.dispose();
    const { title, series } = this.#plot;
    this.#values = series.map(() => el('span', { class: 'value' }));
    this.#tip.replaceChildren(...series.map(
      (one, index) => el('div', {}, swatch(one), el('span', {}, one.name), this.#values[index])));
    const keys = series.map((one, index) => (one.name === '' ? null : this.#key(one, index)));
    this.#caption.replaceChildren(el('strong', {}, title), ...keys.filter(Boolean));
    const { clientWidth: width, clientHeight: height } = this.#place;
    if (width < 20 || height < 20) {
      this.#chart = null; // it comes with its first size
      return;
    }
    this.#chart = makeChart(this.#place, this.#plot, { width, height }, (values, share) => this.#read(values, share));
    this.#place.append(this.#tip);
    for (const index of this.#hidden) this.#chart.setShown(index, false);
    if (this.#time !== null) this.#chart.setTime(this.#time);
  }

  #fit() {
    const { clientWidth: width, clientHeight: height } = this.#place;
    if (!this.#plot || width < 20 || height < 20) return;
    if (!this.#chart) this.#build();
    this.#chart?.setSize({ width, height });
    if (this.#time !== null) this.#chart?.setTime(this.#time);
  }

  /** Name of a series, which switches it on and off. */
  #key(series, index) {
    const { name } = series;
    const button = el('button', {
      type: 'button', class: 'key', test: `series-${name}`, 'aria-pressed': String(!this.#hidden.has(index)),
      on: {
        click: () => {
          const shown = this.#hidden.has(index);
          if (shown) this.#hidden.delete(index);
          else this.#hidden.add(index);
          button.setAttribute('aria-pressed', String(shown));
          this.#chart?.setShown(index, shown);
        },
      },
    }, swatch(series), el('span', {}, name));
    return button;
  }

  /**
   * Values under the mouse.
   * @param {(number|null)[]|null} values
   * @param {number} share  where the mouse is, from left to right: the values stand on the other side
   */
  #read(values, share) {
    this.#tip.hidden = values === null;
    this.#tip.classList.toggle('left', share > 0.5);
    this.#values.forEach((node, index) => {
      const value = values?.[index];
      const text = value === null || value === undefined ? '' : shortNumber(value);
      if (node.textContent !== text) node.textContent = text;
      node.parentElement.hidden = text === '' || this.#hidden.has(index);
    });
  }
}

/** A piece of the line of a series. */
function swatch({ rgba, style }) {
  const dots = style === 'points';
  const line = svg('line', {
    x1: 1, y1: 4, x2: 15, y2: 4, stroke: inkOf(rgba), 'stroke-width': dots ? 4 : 2,
    'stroke-dasharray': { dashed: '4 3', points: '0.1 5' }[style] ?? 'none', 'stroke-linecap': dots ? 'round' : 'butt',
  });
  return svg('svg', { class: 'swatch', viewBox: '0 0 16 8', 'aria-hidden': 'true' }, line);
}

function shortNumber(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}

/** A colour that can be told from the paper. @param {number[]} rgba @returns {string} */
export function inkOf([r, g, b, a = 1]) {
  const bright = 0.299 * r + 0.587 * g + 0.114 * b;
  const dark = theme.name === 'dark';
  let mix = (x) => x;
  if (!dark && bright > 0.6) mix = (x) => (x * 0.55) / bright;
  if (dark && bright < 0.35) mix = (x) => x + (1 - x) * (0.35 - bright) * 1.3;
  const part = (x) => Math.round(255 * Math.max(0, Math.min(1, mix(x))));
  return `rgba(${part(r)}, ${part(g)}, ${part(b)}, ${a})`;
}
