// Charts of places in a plane: a metre is as long both ways, lines may turn back.
import { inkOf } from './figure.js';

const ROOM = 1.1; // of what there is

/** @param {object} plot @param {{series: object[]}} state  whose series are drawn */
export function planeOptions(plot, state) {
  const range = (axis) => (chart) => rangesOf(state.series, chart.bbox, plot.equal_aspect)[axis];
  return {
    mode: 2,
    scales: { x: { time: false, range: range(0) }, y: { range: range(1) } },
    cursor: { drag: { x: false, y: false }, points: { show: false } },
    series: [null, ...plot.series.map(({ name, rgba, style }) => ({
      label: name,
      facets: [{ scale: 'x', auto: true }, { scale: 'y', auto: true }],
      points: { show: false },
      paths: (chart, index) => drawSeries(chart, index, inkOf(rgba), style),
    }))],
  };
}

export function planeData(series) {
  return [null, ...series.map(({ x, y }) => [x, y])];
}

function drawSeries(chart, index, color, style) {
  const { ctx: pen, bbox } = chart;
  const [xs, ys] = chart.data[index];
  const ratio = window.devicePixelRatio || 1;
  pen.save();
  pen.beginPath();
  pen.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  pen.clip();
  pen.strokeStyle = pen.fillStyle = color;
  pen.lineWidth = 1.6 * ratio;
  pen.lineJoin = 'round';
  pen.setLineDash(style === 'dashed' ? [5 * ratio, 4 * ratio] : []);
  pen.beginPath();
  let gap = true;
  for (let i = 0; i < xs.length; ++i) {
    if (xs[i] === null || ys[i] === null) {
      gap = true;
      continue;
    }
    const [x, y] = [chart.valToPos(xs[i], 'x', true), chart.valToPos(ys[i], 'y', true)];
    if (style === 'points') {
      pen.moveTo(x + 2 * ratio, y);
      pen.arc(x, y, 2 * ratio, 0, 7);
    } else if (gap) {
      pen.moveTo(x, y);
    } else {
      pen.lineTo(x, y);
    }
    gap = false;
  }
  if (style === 'points') pen.fill();
  else pen.stroke();
  pen.restore();
  return null;
}

/** Ranges of both axes with all of the series in them. */
function rangesOf(series, bbox, equal) {
  const [x, y] = [extent(series, 'x'), extent(series, 'y')];
  let [wide, tall] = [ROOM * (x.high - x.low), ROOM * (y.high - y.low)];
  if (equal) {
    const width = bbox?.width > 1 ? bbox.width : 4;
    const height = bbox?.height > 1 ? bbox.height : 3;
    const unit = Math.max(wide / width, tall / height, 1e-9); // a pixel
    [wide, tall] = [unit * width, unit * height];
  }
  return [[x.middle - wide / 2, x.middle + wide / 2], [y.middle - tall / 2, y.middle + tall / 2]];
}

function extent(series, axis) {
  let [low, high] = [Infinity, -Infinity];
  for (const one of series) {
    for (const value of one[axis]) {
      if (value === null) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(low <= high)) [low, high] = [-0.5, 0.5];
  if (high - low < 1e-9) [low, high] = [low - 0.005, high + 0.005];
  return { low, high, middle: (low + high) / 2 };
}
