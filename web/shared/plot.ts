// How plots look.
import uPlot from 'uplot';
import { number } from './format';

export const style = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function axes(xLabel: string, yLabel: string, extra: Partial<uPlot.Axis> = {}): uPlot.Axis[] {
  const common: uPlot.Axis = {
    stroke: () => style('--quiet'),
    grid: { stroke: () => style('--line'), width: 1 },
    ticks: { stroke: () => style('--line'), width: 1, size: 4 },
    font: '12px system-ui, sans-serif',
    labelFont: '12px system-ui, sans-serif',
    labelSize: 18,
    labelGap: 2,
  };
  return [
    { ...common, label: xLabel, size: 30 },
    { ...common, label: yLabel, size: 58, space: 24, ...extra },
  ];
}

export function series(label: string, colour: string, options: Partial<uPlot.Series> = {}): uPlot.Series {
  return {
    label, stroke: () => style(colour), width: 1.8, points: { show: false },
    value: (_plot, value) => (value === null || value === undefined ? '–' : number(value, 4)), ...options,
  };
}

/** A plot that fills its box and is drawn again when the box or the theme changes. */
export function mount(box: HTMLElement, options: Omit<uPlot.Options, 'width' | 'height'>, data: uPlot.AlignedData, height: number) {
  const plot = new uPlot({ ...options, width: Math.max(200, box.clientWidth), height }, data, box);
  new ResizeObserver(() => plot.setSize({ width: Math.max(200, box.clientWidth), height })).observe(box);
  document.addEventListener('themechange', () => plot.redraw(false, true));
  return plot;
}
