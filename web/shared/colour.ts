// Diverging colours for signed fields, and what the fields are called.

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

/** As CSS; `upper`: from 0 on. */
export function gradient(part: 'whole' | 'upper' = 'whole'): string {
  const shown = part === 'whole' ? stops : stops.slice((stops.length - 1) / 2);
  return `linear-gradient(90deg, ${shown.map((s) => `rgb(${s.join(' ')})`).join(', ')})`;
}

export type FieldName = 'kappa' | 'tau' | 'eta';

export const fieldLabels: Record<FieldName, { symbol: string; text: string; unit: string }> = {
  kappa: { symbol: 'κ', text: 'curvature', unit: '1/m' },
  tau: { symbol: 'τ', text: 'torsion', unit: '1/m' },
  eta: { symbol: 'η', text: 'ruling slope', unit: '' },
};
