// Curves along the ribbon as it moves.
import uPlot from 'uplot';
import { fieldLabels, type FieldName } from '../../shared/colour';
import { byId, element, number } from '../../shared/format';
import { axes, mount, series } from '../../shared/plot';
import type { View } from './simulator';

const names: FieldName[] = ['kappa', 'tau', 'eta'];

export class LivePlots {
  private readonly plots: uPlot[];
  private readonly ranges: [number, number][] = names.map(() => [-1e-6, 1e-6]);

  constructor() {
    this.plots = names.map((name, i) => {
      const { symbol, text, unit } = fieldLabels[name];
      const box = element('div.plot', { role: 'img', 'aria-label': `${text} along the ribbon` });
      byId('plots').append(box);
      return mount(box, {
        cursor: { sync: { key: 'live' }, y: false, points: { size: 7 } },
        legend: { live: true },
        scales: { x: { time: false, range: [0, 1] }, y: { range: () => this.ranges[i] } },
        axes: axes('u / l', unit ? `${symbol}  [${unit}]` : symbol),
        series: [{ label: 'u/l', value: (_p, v) => (v === null ? '–' : number(v, 3)) },
          series(`${symbol}, ${text}`, `--${name}`)],
      }, [[0, 1], [0, 0]], 170);
    });
  }

  /** Another scene: ranges anew. */
  reset() { this.ranges.forEach((range) => { range[0] = -1e-6; range[1] = 1e-6; }); }

  /** Of the strip whose nodes are `first` and `count - 1` more. */
  show(view: View, first: number, count: number) {
    const all = view.fields.u, length = all[first + count - 1];
    const u = Array.from(all.subarray(first, first + count), (value) => value / length);
    names.forEach((name, i) => {
      const values = Array.from(view.fields[name].subarray(first, first + count));
      this.ranges[i] = widened(this.ranges[i], values);
      this.plots[i].setData([u, values]);
    });
  }
}

/** Wide enough at once, narrower again little by little. */
function widened([low, high]: [number, number], values: number[]): [number, number] {
  let least = 0, most = 0;
  for (const value of values) [least, most] = [Math.min(least, value), Math.max(most, value)];
  const margin = 0.08 * (most - least) || 1e-6;
  const to = (now: number, wanted: number, beyond: boolean) => (beyond ? wanted : now + 0.1 * (wanted - now));
  return [to(low, least - margin, least - margin < low), to(high, most + margin, most + margin > high)];
}
