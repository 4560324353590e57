// The page of a sweep: every result over the axes, as heat maps, lines or points, each linked to its run.
import { byId, element, number } from '../../shared/format';
import { heatMap, lineChart, type Mark } from './sweep_charts';

interface Axis { columns: string[]; log: boolean; values: (number | null)[][]; words: string[][] }
interface Sweep {
  name: string; title: string; scene: string; text: string; program: string; version: string; kept: boolean;
  axes: Axis[]; status: string[]; keys: string[]; results: Record<string, (number | null)[]>; reasons: Record<string, string>;
}

/** One column of numbers in order: its points can be joined. */
const isPlain = (axis: Axis) => axis.columns.length === 1 &&
  axis.values.every(([v], i) => v !== null && (i === 0 || v >= (axis.values[i - 1][0] as number)));

function strides(sweep: Sweep): number[] {
  const out = new Array<number>(sweep.axes.length);
  let step = 1;
  for (let a = sweep.axes.length - 1; a >= 0; --a) {
    out[a] = step;
    step *= sweep.axes[a].words.length;
  }
  return out;
}

/** A column of an axis as numbers: its values, or where they are words their places. */
const positions = (axis: Axis, column: number) => axis.values.map((value, i) => value[column] ?? i);

function linkOf(sweep: Sweep, run: number): string | null {
  if (sweep.status[run] === 'open') return null;
  const has = sweep.kept && (sweep.status[run] === 'done' || sweep.status[run] === 'not-converged');
  return has ? `runs/${sweep.keys[run]}/report.html` : `runs.html#${sweep.keys[run]}`;
}

function markOf(sweep: Sweep, name: string, run: number): Mark {
  const step = strides(sweep);
  const where = sweep.axes.map((axis, a) => {
    const i = Math.floor(run / step[a]) % axis.words.length;
    return axis.columns.map((column, c) => `${column} ${axis.words[i][c]}`).join(', ');
  });
  const value = sweep.results[name][run];
  return {
    value, link: linkOf(sweep, run),
    text: `${where.join(', ')}: ${value === null ? sweep.status[run] : `${name} ${number(value, 5)}`}`,
  };
}

/** What is drawn: along which axis, down which, by which column, and where the others stand. */
interface View { x: number; y: number | null; column: number; fixed: number[] }

function chart(sweep: Sweep, view: View, name: string): Element {
  const step = strides(sweep);
  const base = view.fixed.reduce((sum, i, a) => sum + (a === view.x || a === view.y ? 0 : i * step[a]), 0);
  const across = sweep.axes[view.x];
  const xs = positions(across, view.column);
  const run = (i: number, j: number) => base + i * step[view.x] + (view.y === null ? 0 : j * step[view.y]);
  const label = across.columns[view.column];
  if (view.y === null) {
    const marks = xs.map((x, i) => ({ x, ...markOf(sweep, name, run(i, 0)) }));
    return lineChart({ xLabel: label, log: across.log, joined: isPlain(across), series: [{ name: '', marks }] });
  }
  const down = sweep.axes[view.y];
  const ys = positions(down, 0);
  const cells = ys.map((_, j) => xs.map((_x, i) => markOf(sweep, name, run(i, j))));
  return heatMap({ xLabel: label, yLabel: down.columns[0], xs, ys, cells });
}

function slices(sweep: Sweep, view: View, name: string): Element | null {
  if (view.y === null) return null;
  const step = strides(sweep);
  const base = view.fixed.reduce((sum, i, a) => sum + (a === view.x || a === view.y ? 0 : i * step[a]), 0);
  const across = sweep.axes[view.x], down = sweep.axes[view.y];
  const xs = positions(across, view.column);
  const most = 7;
  const rows = [...new Set(Array.from({ length: Math.min(most, down.words.length) }, (_, k, n = Math.min(most, down.words.length)) =>
    Math.round((k * (down.words.length - 1)) / Math.max(1, n - 1))))];
  return lineChart({
    xLabel: across.columns[view.column], log: across.log, joined: true,
    series: rows.map((j) => ({
      name: `${down.columns[0]} ${number(Number(down.values[j][0] ?? j), 3)}`,
      marks: xs.map((x, i) => ({ x, ...markOf(sweep, name, base + i * step[view.x] + j * step[view.y as number]) })),
    })),
  });
}

function choice(label: string, options: string[], chosen: number, change: (value: number) => void): HTMLElement {
  const select = element('select', { 'aria-label': label }) as HTMLSelectElement;
  options.forEach((text, i) => select.append(element('option', { value: String(i) }, text)));
  select.value = String(chosen);
  select.addEventListener('change', () => change(Number(select.value)));
  return element('label.choice', {}, `${label} `, select);
}

function start() {
  const sweep = JSON.parse(byId('run').textContent ?? '') as Sweep;
  byId('title').textContent = sweep.name;
  byId('subtitle').textContent = sweep.title;
  document.title = `${sweep.name} · sweep · Wunderlich`;
  byId('sweep-text').textContent = sweep.text;
  byId('footer').textContent = `${sweep.program} ${sweep.version} · scene ${sweep.scene} · ${sweep.keys.length} runs`;
  for (const status of ['done', 'not-converged', 'refused', 'failed', 'timed-out', 'open']) {
    const count = sweep.status.filter((s) => s === status).length;
    if (count > 0) byId('verdicts').append(element(`li.${status === 'done' ? 'good' : 'bad'}`, {}, `${count} ${status}`));
  }
  const longest = sweep.axes.map((axis, a) => ({ a, n: axis.words.length })).filter(({ n }) => n > 1).sort((p, q) => q.n - p.n);
  const view: View = {
    x: longest[0]?.a ?? 0, y: null, column: 0, fixed: sweep.axes.map(() => 0),
  };
  const second = longest.slice(1).find(({ a }) => isPlain(sweep.axes[a]));
  if (second && isPlain(sweep.axes[view.x])) view.y = second.a;

  const draw = () => {
    const tools = byId('axes'), charts = byId('charts');
    tools.replaceChildren();
    charts.replaceChildren();
    const names = sweep.axes.map((axis) => axis.columns.join(' + '));
    tools.append(choice('along', names, view.x, (a) => {
      if (view.y === a) view.y = view.x;
      view.x = a; view.column = 0; draw();
    }));
    const axis = sweep.axes[view.x];
    if (axis.columns.length > 1) tools.append(choice('by', axis.columns, view.column, (c) => { view.column = c; draw(); }));
    if (sweep.axes.length > 1) {
      tools.append(choice('down', ['none', ...names], view.y === null ? 0 : view.y + 1, (a) => {
        view.y = a === 0 || a - 1 === view.x ? null : a - 1; draw();
      }));
    }
    sweep.axes.forEach((other, a) => {
      if (a === view.x || a === view.y || other.words.length < 2) return;
      tools.append(choice(names[a], other.words.map((words) => words.join(', ')), view.fixed[a], (i) => { view.fixed[a] = i; draw(); }));
    });
    for (const name of Object.keys(sweep.results)) {
      const card = element('figure.model', {}, element('figcaption', {}, name));
      card.append(chart(sweep, view, name));
      const lines = slices(sweep, view, name);
      if (lines) card.append(lines);
      charts.append(card);
    }
  };
  draw();

  const trouble = sweep.status.map((status, run) => ({ status, run })).filter(({ status }) => status !== 'done' && status !== 'open');
  const shown = trouble.slice(0, 200).map(({ status, run }) => {
    const link = linkOf(sweep, run);
    const what = link ? element('a', { href: link }, sweep.keys[run]) : sweep.keys[run];
    return element('tr', {}, element('td', {}, String(run)), element('td', {}, what), element('td', {}, status),
      element('td.reason', {}, sweep.reasons[sweep.keys[run]] ?? ''));
  });
  byId('trouble').append(trouble.length === 0 ? 'None.' : element('table', {}, element('tbody', {}, ...shown)));
}

start();
