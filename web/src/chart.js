// Charts by uPlot: values over one common axis, or places in a plane.
import uPlot from 'uplot';
import { el } from './dom.js';
import { inkOf } from './figure.js';
import { FONTS, theme } from './theme.js';
import { isOrdered, joined } from './chart_data.js';
import { planeOptions, planeData } from './plane_chart.js';

const FONT = `11px ${FONTS}`;

/**
 * @param {HTMLElement} place
 * @param {object} plot  see `plots` of the protocol
 * @param {{width: number, height: number}} size
 * @param {(values: (number|null)[]|null, share: number) => void} onRead  values under the mouse, by series
 */
export function makeChart(place, plot, size, onRead) {
  const plane = plot.equal_aspect || !plot.series.every(({ x }) => isOrdered(x));
  const state = { series: plot.series };
  const options = plane ? planeOptions(plot, state) : overOptions(plot, onRead);
  const data = () => (plane ? planeData(state.series) : joined(state.series));
  const now = el('div', { class: 'now', test: 'now', hidden: true });
  const chart = new uPlot({ ...options, ...size, legend: { show: false }, axes: axesOf(plot) }, data(), place);
  chart.over.append(now);
  if (plane) chart.setData(data()); // now that the size of the plane is known
  return {
    setSeries(series) {
      state.series = series;
      chart.setData(data());
    },
    setSize(wanted) {
      chart.setSize(wanted);
      if (plane) chart.setData(data());
    },
    /** What is shown in the scene, in plots over its time. */
    setTime(time) {
      if (!plot.over_time || plane) return;
      const left = chart.valToPos(time, 'x');
      now.hidden = !(left >= 0 && left <= chart.over.clientWidth);
      now.style.left = `${left}px`;
    },
    setShown: (index, shown) => chart.setSeries(index + 1, { show: shown }),
    dispose: () => chart.destroy(),
  };
}

function overOptions(plot, onRead) {
  const read = (chart) => {
    const at = chart.cursor.idx;
    const inside = chart.cursor.left >= 0 && at !== null && at !== undefined;
    const share = chart.cursor.left / (chart.over.clientWidth || 1);
    onRead(inside ? plot.series.map((_, index) => nearestValue(chart.data, index + 1, at)) : null, share);
  };
  return {
    scales: { x: { time: false }, y: { range: plot.y_from_zero ? fromZero : around } },
    cursor: { drag: { x: false, y: false }, y: false },
    series: [{}, ...plot.series.map(seriesOf)],
    hooks: { setCursor: [read] },
  };
}

function seriesOf({ name, rgba, style }) {
  const color = inkOf(rgba);
  const dots = style === 'points';
  return {
    label: name, stroke: color, width: 1.6, dash: style === 'dashed' ? [5, 4] : undefined, spanGaps: false,
    paths: dots ? () => null : undefined, points: { show: dots, size: 4, fill: color, stroke: color },
  };
}

/** Series with other places on the axis have nothing here: the next one that has something counts. */
function nearestValue(data, index, at) {
  for (let way = 0; way < 12; ++way) {
    for (const place of [at - way, at + way]) {
      const value = data[index][place];
      if (value !== undefined) return value;
    }
  }
  return null;
}

export function axesOf(plot) {
  const { plotInk, plotGrid } = theme.palette;
  const common = {
    stroke: plotInk, font: FONT, grid: { stroke: plotGrid, width: 1 }, ticks: { show: false }, gap: 4,
  };
  return [
    { ...common, size: 20, label: plot.x_label, labelFont: FONT, labelSize: 15, labelGap: 0, space: 44 },
    { ...common, size: sizeOfValues, space: 26, values: (_, splits) => splits.map(tickText) },
  ];
}

function tickText(value) {
  if (value === null || value === 0) return value === 0 ? '0' : '';
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-4 ? value.toExponential(0) : String(Number(value.toPrecision(6)));
}

function sizeOfValues(chart, values, axis, cycle) {
  if (cycle > 1) return chart.axes[axis]._size; // else it may go to and fro
  const longest = Math.max(1, ...(values ?? []).map((text) => text.length));
  return Math.ceil(6.4 * longest) + 10;
}

function around(_, low, high) {
  if (low === null) return [0, 1];
  const tall = Math.max(high - low, 1e-9, 1e-4 * Math.max(Math.abs(low), Math.abs(high)));
  const middle = (low + high) / 2;
  return [middle - 0.56 * tall, middle + 0.56 * tall];
}

function fromZero(_, __, high) {
  return [0, high > 0 ? 1.08 * high : 1];
}
