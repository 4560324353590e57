// Charts of a sweep as SVG, so that every mark can be a link.
import { number } from '../../shared/format';

export interface Mark { value: number | null; text: string; link: string | null }

const space = 'http://www.w3.org/2000/svg';
const size = { width: 460, height: 260, left: 66, right: 14, top: 12, bottom: 42 };
const inner = { width: size.width - size.left - size.right, height: size.height - size.top - size.bottom };

function svg(tag: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const out = document.createElementNS(space, tag);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, String(value));
  out.append(...children);
  return out;
}

function linked(mark: Mark, shape: SVGElement): SVGElement {
  shape.append(svg('title', {}, mark.text));
  return mark.link ? svg('a', { href: mark.link, target: '_blank' }, shape) : shape;
}

/** Dark to bright, even to the eye: close to "viridis". */
const stops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
function sequential(t: number): string {
  const position = Math.max(0, Math.min(1, t)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(position));
  const c = [0, 1, 2].map((i) => Math.round(stops[k][i] + (stops[k + 1][i] - stops[k][i]) * (position - k)));
  return `rgb(${c.join(',')})`;
}

function range(values: (number | null)[]): [number, number] {
  const given = values.filter((v): v is number => v !== null);
  const low = Math.min(...given), high = Math.max(...given);
  if (given.length === 0) return [0, 1];
  return low === high ? [low - 0.5 * (Math.abs(low) || 1), high + 0.5 * (Math.abs(high) || 1)] : [low, high];
}

function frame(xLabel: string, yLabel: string): SVGElement {
  return svg('svg', { viewBox: `0 0 ${size.width} ${size.height}`, role: 'img', 'aria-label': `${yLabel} over ${xLabel}`, class: 'chart' },
    svg('text', { x: size.left + inner.width / 2, y: size.height - 6, 'text-anchor': 'middle' }, xLabel));
}

/** Round numbers between two bounds. */
function ticks(low: number, high: number, log: boolean): number[] {
  if (log && low > 0) {
    const out: number[] = [];
    for (let e = Math.ceil(Math.log10(low) - 1e-9); e <= Math.log10(high) + 1e-9; ++e) out.push(10 ** e);
    if (out.length >= 2) return out;
  }
  const rough = (high - low) / 4;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough) ?? rough;
  const out: number[] = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-12 * step ? 0 : v);
  return out;
}

export interface LineChart {
  xLabel: string;
  log: boolean;
  joined: boolean;
  series: { name: string; marks: (Mark & { x: number })[] }[];
}

export function lineChart({ xLabel, log, joined, series }: LineChart): Element {
  const out = frame(xLabel, 'result');
  const keyed = series.some(({ name }) => name !== '');
  const room = inner.width - (keyed ? 78 : 0);   // beside the lines stands what they are
  const [x0, x1] = range(series.flatMap((s) => s.marks.map((m) => m.x)));
  const [y0, y1] = range(series.flatMap((s) => s.marks.map((m) => m.value)));
  const scale = (x: number) => (log && x0 > 0 ? Math.log(x / x0) / Math.log(x1 / x0) : (x - x0) / (x1 - x0));
  const px = (x: number) => size.left + room * scale(x);
  const py = (y: number) => size.top + inner.height * (1 - (y - y0) / (y1 - y0));
  for (const y of ticks(y0, y1, false)) {
    out.append(svg('line', { x1: size.left, x2: size.left + room, y1: py(y), y2: py(y), class: 'grid' }),
      svg('text', { x: size.left - 6, y: py(y) + 4, 'text-anchor': 'end' }, number(y, 3)));
  }
  for (const x of ticks(x0, x1, log)) {
    out.append(svg('text', { x: px(x), y: size.top + inner.height + 16, 'text-anchor': 'middle' }, number(x, 3)));
  }
  series.forEach(({ name, marks }, k) => {
    const colour = sequential(series.length === 1 ? 0.25 : (0.9 * k) / (series.length - 1));
    const there = marks.filter((m) => m.value !== null);
    if (joined) {
      const path = there.map((m, i) => `${i === 0 ? 'M' : 'L'}${px(m.x).toFixed(1)} ${py(m.value as number).toFixed(1)}`).join('');
      out.append(svg('path', { d: path, fill: 'none', stroke: colour, 'stroke-width': 1.5 }));
    }
    for (const m of there) {
      out.append(linked(m, svg('circle', { cx: px(m.x).toFixed(1), cy: py(m.value as number).toFixed(1), r: joined ? 2.4 : 2, fill: colour })));
    }
    if (name) out.append(svg('text', { x: size.left + room + 8, y: size.top + 12 + 14 * k, style: `fill: ${colour}`, class: 'key' }, name));
  });
  return out;
}

export interface HeatMap { xLabel: string; yLabel: string; xs: number[]; ys: number[]; cells: Mark[][] }

export function heatMap({ xLabel, yLabel, xs, ys, cells }: HeatMap): Element {
  const out = frame(xLabel, yLabel);
  const [low, high] = range(cells.flat().map((m) => m.value));
  const bar = 54;   // room for the scale of colours
  const w = (inner.width - bar) / xs.length, h = inner.height / ys.length;
  cells.forEach((row, j) => row.forEach((mark, i) => {
    const fill = mark.value === null ? 'var(--line)' : sequential((mark.value - low) / (high - low));
    out.append(linked(mark, svg('rect', {
      x: (size.left + i * w).toFixed(2), y: (size.top + (ys.length - 1 - j) * h).toFixed(2),
      width: (w + 0.3).toFixed(2), height: (h + 0.3).toFixed(2), fill,
    })));
  }));
  const some = (n: number) => [...new Set([0, 0.25, 0.5, 0.75, 1].map((t) => Math.round(t * (n - 1))))];
  for (const i of some(xs.length)) {
    out.append(svg('text', { x: size.left + (i + 0.5) * w, y: size.top + inner.height + 16, 'text-anchor': 'middle' }, number(xs[i], 3)));
  }
  for (const j of some(ys.length)) {
    out.append(svg('text', { x: size.left - 6, y: size.top + (ys.length - j - 0.5) * h + 4, 'text-anchor': 'end' }, number(ys[j], 3)));
  }
  out.append(svg('text', { x: 12, y: size.top + inner.height / 2, transform: `rotate(-90 12 ${size.top + inner.height / 2})`, 'text-anchor': 'middle' }, yLabel));
  const left = size.left + inner.width - bar + 14, steps = 40;
  for (let k = 0; k < steps; ++k) {
    out.append(svg('rect', { x: left, y: size.top + (1 - (k + 1) / steps) * inner.height, width: 10, height: inner.height / steps + 0.4, fill: sequential((k + 0.5) / steps) }));
  }
  for (const t of [0, 1]) {
    out.append(svg('text', { x: left + 13, y: size.top + (1 - t) * (inner.height - 9) + 9 }, number(low + t * (high - low), 3)));
  }
  return out;
}
