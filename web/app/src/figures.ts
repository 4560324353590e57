// Numbers beside the picture.
import { fieldLabels, gradient } from '../../shared/colour';
import { byId, element, number, quantity } from '../../shared/format';
import type { Numbers } from './simulator';
import type { Colour } from './ribbon';

/** Running means of what a frame takes [ms]. */
export class Meter {
  simulate = 0; draw = 0; frame = 0;
  add(simulate: number, draw: number, frame: number) {
    const mix = (old: number, now: number) => (old === 0 ? now : old + 0.05 * (now - old));
    [this.simulate, this.draw, this.frame] = [mix(this.simulate, simulate), mix(this.draw, draw), mix(this.frame, frame)];
  }
}

/** `pace`: seconds of the motion in a second; null on the path to an equilibrium. */
export function showFigures(n: Numbers, meter: Meter, pace: number | null) {
  const rows: [string, string][] = [
    ['elastic energy', quantity(n.elastic, 'J', 5)],
    ['V·l / (D·w)', number(n.normalized, 5)],
    ['kinetic energy', quantity(n.kinetic, 'J', 3)],
    ['energy of gravity', quantity(n.gravity, 'J', 3)],
    ['relative area error', number(n.area_error, 2)],
    ['torsion less κη, largest', number(n.torsion_error, 2)],
    ['|w η′/2|, largest', number(n.ruling_ratio, 3)],
    ['pace', pace === null ? '–' : `${number(pace, 2)} s per second`],
    ['simulation, drawing', `${number(meter.simulate, 2)}, ${number(meter.draw, 2)}\u202fms`],
  ];
  const host = byId('figures');
  if (host.children.length !== rows.length) {
    host.replaceChildren(...rows.map(([name]) => element('div', {}, element('dt', {}, name), element('dd', {}))));
  }
  rows.forEach(([, value], i) => { host.children[i].lastElementChild!.textContent = value; });
}

export function showLegend(colour: Colour, range: number) {
  const legend = byId('legend');
  legend.hidden = colour === 'none';
  if (colour === 'none') return;
  const energy = colour === 'energy';
  const { symbol, text, unit } = energy ? { symbol: '', text: 'energy a length', unit: 'J/m' } : fieldLabels[colour];
  byId('legend-name').textContent = `${symbol ? `${symbol}, ` : ''}${text}${unit ? ` [${unit}]` : ''}`;
  byId('legend-low').textContent = energy ? '0' : number(-range, 2);
  byId('legend-high').textContent = number(range, 2);
  byId('legend-bar').style.background = gradient(energy ? 'upper' : 'whole');
}
