// Series as uPlot wants them.
import uPlot from 'uplot';

/** @param {number[]} x */
export function isOrdered(x) {
  for (let i = 1; i < x.length; ++i) if (!(x[i] >= x[i - 1])) return false;
  return true;
}

/** Series over one common axis; where one has no place of its own there, it is undefined. */
export function joined(series) {
  if (series.length === 0) return [[]];
  const first = series[0].x;
  const same = series.every(({ x }) => x.length === first.length && x.every((value, i) => value === first[i]));
  if (same && isStrict(first)) return [first, ...series.map(({ y }) => y)];
  const tables = series.map(({ x, y }) => withoutTwins(x, y));
  return uPlot.join(tables, tables.map(() => [0, 2])); // gaps stay gaps
}

function isStrict(x) {
  for (let i = 1; i < x.length; ++i) if (!(x[i] > x[i - 1])) return false;
  return true;
}

/** Of several values at one place the last stays. */
function withoutTwins(x, y) {
  if (isStrict(x)) return [x, y];
  const [places, values] = [[], []];
  x.forEach((place, i) => {
    if (places.length > 0 && places[places.length - 1] === place) {
      values[values.length - 1] = y[i];
    } else {
      places.push(place);
      values.push(y[i]);
    }
  });
  return [places, values];
}
