// Curves along the ribbon at the shown instant, and through the run.
import uPlot from 'uplot';
import { fieldLabels } from '../../shared/colour';
import type { FieldName, Run } from './data';
import { byId, element, number } from '../../shared/format';
import { axes, mount, series, style } from '../../shared/plot';

/** Vertical lines over a plot, at x values asked for at each drawing. */
function verticals(at: () => number[], colour: string, dash: number[] = []): uPlot.Plugin {
  return {
    hooks: {
      draw: (plot) => {
        const { ctx, bbox } = plot;
        ctx.save();
        ctx.strokeStyle = style(colour);
        ctx.lineWidth = 1.2 * devicePixelRatio;
        ctx.setLineDash(dash.map((d) => d * devicePixelRatio));
        for (const x of at()) {
          const px = plot.valToPos(x, 'x', true);
          if (px < bbox.left - 1 || px > bbox.left + bbox.width + 1) continue;
          ctx.beginPath();
          ctx.moveTo(px, bbox.top);
          ctx.lineTo(px, bbox.top + bbox.height);
          ctx.stroke();
        }
        ctx.restore();
      },
    },
  };
}

/** The range of a field over all frames, so that the axes stand still while the run plays. */
function steadyRange(run: Run, name: FieldName): [number, number] {
  let low = 0, high = 0;
  for (const frame of run.frames) for (const v of frame.fields[name]) [low, high] = [Math.min(low, v), Math.max(high, v)];
  const margin = 0.06 * (high - low) || 1;
  return [low - margin, high + margin];
}

export interface ProfilePlots { show(position: number): void }

export function createProfiles(run: Run, onHover: (node: number | null) => void): ProfilePlots {
  const host = byId('plots');
  const names: FieldName[] = ['kappa', 'tau', 'eta'];
  const u = Array.from(run.u, (value) => value / run.length);
  let atEnd = true;
  const plots = names.map((name) => {
    const { symbol, text, unit } = fieldLabels[name];
    const box = element('div.plot', { role: 'img', 'aria-label': `${text} along the ribbon` });
    host.append(box);
    const range = steadyRange(run, name);
    return mount(box, {
      cursor: { sync: { key: 'profile' }, y: false, points: { size: 7 } },
      legend: { live: true },
      scales: { x: { time: false, range: [0, 1] }, y: { range: () => range } },
      axes: axes('u / l', unit ? `${symbol}  [${unit}]` : symbol),
      series: [{ label: 'u/l', value: (_p, v) => (v === null ? '–' : number(v, 3)) },
        series(`${symbol}, ${text}`, `--${name}`)],
      plugins: name === 'kappa' ? [verticals(() => (atEnd ? run.summary.kappa_zeros : []), '--quiet', [3, 4])] : [],
      hooks: { setCursor: [(plot) => onHover(plot.cursor.idx ?? null)] },
    }, [u, Array.from(run.frames[run.frames.length - 1].fields[name])], 190);
  });
  return {
    show(position) {
      const k = Math.floor(position), next = Math.min(run.frames.length - 1, k + 1), t = position - k;
      atEnd = position >= run.frames.length - 1;
      plots.forEach((plot, i) => {
        const [a, b] = [run.frames[k].fields[names[i]], run.frames[next].fields[names[i]]];
        plot.setData([u, Array.from(a, (value, node) => value + (b[node] - value) * t)], false);
        plot.redraw();
      });
    },
  };
}

const positive = (values: number[]) => values.map((value) => (value > 0 ? value : null));

export interface HistoryPlots { show(time: number): void }

export function createHistory(run: Run, timeLabel: string, onPick: (time: number) => void): HistoryPlots {
  const host = byId('history');
  const history = run.history;
  let now = run.summary.time;
  const cursorLine = verticals(() => [now], '--accent');
  const plots: uPlot[] = [];
  const add = (label: string, options: Omit<uPlot.Options, 'width' | 'height'>, data: (number | null)[][]) => {
    const box = element('div.plot', { role: 'img', 'aria-label': label });
    host.append(box);
    const plot = mount(box, {
      ...options, plugins: [cursorLine], legend: { live: true },
      cursor: { sync: { key: 'history' }, y: false, points: { size: 7 }, drag: { x: false, y: false } },
    }, [history.time, ...data] as uPlot.AlignedData, 210);
    plot.over.addEventListener('click', () => {
      const index = plot.cursor.idx;
      if (index !== null && index !== undefined) onPick(history.time[index]);
    });
    plots.push(plot);
  };
  const time: uPlot.Series = { label: timeLabel, value: (_p, v) => (v === null ? '–' : number(v, 4)) };
  const energies = ([['elastic', '--kappa'], ['kinetic', '--tau'], ['gravity', '--eta'], ['total', '--ink']] as const)
    .filter(([key]) => history[key].some((value) => value !== 0));
  const parts = energies.length === 2 ? energies.slice(0, 1) : energies;   // a total of one part says nothing new
  add('energies in time', {
    scales: { x: { time: false } }, axes: axes(timeLabel, 'energy  [J]'),
    series: [time, ...parts.map(([key, colour]) => series(key, colour, key === 'total' ? { dash: [5, 4] } : {}))],
  }, parts.map(([key]) => history[key]));
  const errors = ([['length', '--kappa'], ['torsion', '--tau'], ['area', '--eta']] as const)
    .filter(([key]) => history[key].some((value) => value > 0));
  if (errors.length) {
    add('constraint errors in time', {
      scales: { x: { time: false }, y: { distr: 3 } },
      axes: axes(timeLabel, 'error', { values: (_p, splits) => splits.map((v) => power(v)) }),
      series: [time, ...errors.map(([key, colour]) => series(key, colour))],
    }, errors.map(([key]) => positive(history[key])));
  }
  return { show(value) { now = value; plots.forEach((plot) => plot.redraw(false)); } };
}

function power(value: number | null): string {
  if (value === null) return '';
  const exponent = Math.log10(value);
  return Math.abs(exponent - Math.round(exponent)) < 1e-6 ? `1e${Math.round(exponent)}` : '';
}
