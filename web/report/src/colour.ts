// Diverging colours for signed fields, and the range they cover.
import type { FieldName, Frame } from './data';

/** sRGB stops from negative to positive, close to "RdBu" of ColorBrewer. */
const stops = [
  [5, 72, 143], [67, 147, 195], [170, 208, 228], [243, 240, 235], [247, 187, 150], [214, 96, 77], [150, 12, 38],
];

/** `t` in [-1, 1]; sRGB components in [0, 1]. */
export function diverging(t: number): [number, number, number] {
  const position = ((Math.max(-1, Math.min(1, t)) + 1) / 2) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(position));
  const mix = position - k;
  const at = (c: number) => (stops[k][c] + (stops[k + 1][c] - stops[k][c]) * mix) / 255;
  return [at(0), at(1), at(2)];
}

export function gradient(): string {
  return `linear-gradient(90deg, ${stops.map((s) => `rgb(${s.join(' ')})`).join(', ')})`;
}

/** A value that all but two per cent of the field stay below, so that a spike does not wash out the rest. */
export function fieldRange(frames: Frame[], name: FieldName): number {
  const sizes: number[] = [];
  for (const frame of frames) for (const value of frame.fields[name]) sizes.push(Math.abs(value));
  sizes.sort((a, b) => a - b);
  return sizes[Math.floor(0.98 * (sizes.length - 1))] || sizes[sizes.length - 1] || 1;
}

export const fieldLabels: Record<FieldName, { symbol: string; text: string; unit: string }> = {
  kappa: { symbol: 'κ', text: 'curvature', unit: '1/m' },
  tau: { symbol: 'τ', text: 'torsion', unit: '1/m' },
  eta: { symbol: 'η', text: 'ruling slope', unit: '' },
};
