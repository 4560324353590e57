// Sliders of what may change while the ribbon moves.
import { byId, element, number } from '../../shared/format';
import type { SceneInfo, Settings } from './simulator';

interface Slider {
  name: string; label: string; unit: string; low: number; high: number; logarithmic?: boolean; step?: number;
  get(settings: Settings): number;
  put(settings: Settings, value: number): void;
}

const degree = Math.PI / 180;

const size = (v: [number, number, number]) => Math.hypot(...v);

/** The direction that gravity has or had. */
function downwards(given: Settings): [number, number, number] {
  const g = size(given.gravity);
  return g > 0 ? given.gravity.map((c) => c / g) as [number, number, number] : [0, 0, -1];
}

function slidersFor(given: Settings): Slider[] {
  const down = downwards(given);
  return [
    { name: 'width', label: 'Width', unit: 'm', low: given.width / 5, high: 2.5 * given.width, logarithmic: true,
      get: (s) => s.width, put: (s, value) => { s.width = value; } },
    { name: 'length', label: 'Length', unit: 'm', low: 0.5 * given.length, high: 1.5 * given.length,
      get: (s) => s.length, put: (s, value) => { s.length = value; } },
    { name: 'stiffness', label: 'Bending stiffness', unit: 'N m', low: given.stiffness / 30, high: 30 * given.stiffness, logarithmic: true,
      get: (s) => s.stiffness, put: (s, value) => { s.stiffness = value; } },
    { name: 'gravity', label: 'Gravity', unit: 'm/s²', low: 0, high: Math.max(20, 2 * size(given.gravity)),
      get: (s) => size(s.gravity), put: (s, value) => { s.gravity = down.map((c) => c * value) as [number, number, number]; } },
    { name: 'twist', label: 'Twist of the far end', unit: '°', low: -1080, high: 1080, step: 5,
      get: (s) => s.twist / degree, put: (s, value) => { s.twist = value * degree; } },
    { name: 'damping', label: 'Damping', unit: '1/s', low: 0, high: Math.max(8, 4 * given.damping),
      get: (s) => s.damping, put: (s, value) => { s.damping = value; } },
  ];
}

const steps = 400;   // of sliders that are not in whole steps

export class Sliders {
  private given!: Settings;
  private now!: Settings;
  private readonly inputs = new Map<string, { slider: Slider; input: HTMLInputElement; output: HTMLElement }>();

  /** `twisted`: the number of half twists of a loop has been chosen. */
  constructor(private readonly changed: (settings: Settings) => void, private readonly twisted: (halfTwists: number) => void) {}

  load(info: SceneInfo, given: Settings) {
    this.given = given;
    this.now = { ...given };
    this.inputs.clear();
    const host = byId('sliders');
    host.replaceChildren();
    const loop = info.strips.length === 1 && info.strips[0].loop;
    for (const slider of slidersFor(given)) {
      if (slider.name === 'twist' && info.strips[0].loop) continue;
      this.add(host, slider);
    }
    if (loop && info.on_path) this.addHalfTwists(host, info.strips[0].half_twists);
    this.show(given);
  }

  private row(host: HTMLElement, name: string, label: string): { input: HTMLInputElement; output: HTMLElement } {
    const input = element('input', { type: 'range', id: `set-${name}` }) as HTMLInputElement;
    const output = element('span.value', { 'aria-hidden': 'true' });   // the slider itself says it
    host.append(element('label.slider', {}, element('span', {}, label), output, input));
    return { input, output };
  }
  private add(host: HTMLElement, slider: Slider) {
    const { input, output } = this.row(host, slider.name, slider.label);
    const [low, high] = slider.logarithmic ? [Math.log(slider.low), Math.log(slider.high)] : [slider.low, slider.high];
    Object.assign(input, { min: String(low), max: String(high), step: String(slider.step ?? (high - low) / steps) });
    input.addEventListener('input', () => {
      const raw = Number(input.value);
      slider.put(this.now, slider.logarithmic ? Math.exp(raw) : raw);
      this.write(slider, input, output);
      this.changed(this.now);
    });
    this.inputs.set(slider.name, { slider, input, output });
  }
  private addHalfTwists(host: HTMLElement, halfTwists: number) {
    const { input, output } = this.row(host, 'half-twists', 'Half twists');
    Object.assign(input, { min: '-2', max: '2', step: '1', value: String(halfTwists) });
    output.textContent = String(halfTwists).replace('-', '−');
    input.addEventListener('input', () => { output.textContent = input.value.replace('-', '−'); });
    input.addEventListener('change', () => this.twisted(Number(input.value)));
  }
  private write(slider: Slider, input: HTMLInputElement, output: HTMLElement) {
    const value = slider.get(this.now);
    const text = `${number(value, 3)}${slider.unit === '°' ? '' : '\u202f'}${slider.unit}`;
    output.textContent = text;
    input.setAttribute('aria-valuetext', text);
  }
  /** What the simulator says; a slider under the hand is left alone. */
  show(settings: Settings) {
    this.now = { ...settings };
    for (const { slider, input, output } of this.inputs.values()) {
      const value = slider.get(settings);
      input.value = String(slider.logarithmic ? Math.log(value) : value);
      this.write(slider, input, output);
    }
  }
  /** As if all had been moved there by hand. */
  put(settings: Settings) {
    this.show(settings);
    this.changed(this.now);
  }
  asGiven() { this.put(this.given); }

  /** Keys of the scene that give what the sliders say; throws where they cannot be written. */
  overrides(info: SceneInfo): string[] {
    const { given, now } = this;
    const out: string[] = [];
    const written = (value: number) => String(Number(value.toPrecision(7)));
    const length = now.length / given.length, width = now.width / given.width, stiffness = now.stiffness / given.stiffness;
    for (const [i, { path, has, value }] of ribbonsOf(info.resolved).entries()) {
      const strip = info.strips[i];
      if (length !== 1) out.push(`${path}.length=${written(strip.length * length)}`);
      if (has('aspect') && width !== length) out.push(`${path}.aspect=${written((strip.length * length) / (strip.width * width))}`);
      if (!has('aspect') && width !== 1) out.push(`${path}.width=${written(strip.width * width)}`);
      if (stiffness === 1) continue;
      const key = has('young_modulus') ? 'young_modulus' : 'bending_stiffness';   // D is proportional to E
      out.push(`${path}.${key}=${written(i === 0 && key === 'bending_stiffness' ? now.stiffness : value(key) * stiffness)}`);
    }
    if (String(now.gravity) !== String(given.gravity)) out.push(`gravity=[${now.gravity.map(written).join(', ')}]`);
    return out;
  }
}

/** The ribbons of a scene as the reader writes it: one line a section, keys in quotes, and where in it each stands. */
function ribbonsOf(resolved: string) {
  const one = /^"ribbon": (.*)$/m.exec(resolved), several = /^"ribbons": \[(.*)\]$/m.exec(resolved);
  const texts = one ? [one[1]] : items(several?.[1] ?? '');
  return texts.map((text, i) => ({
    path: one ? 'ribbon' : `ribbons.${i}`,
    has: (key: string) => text.includes(`"${key}": `),
    value: (key: string) => {
      const value = Number(new RegExp(`"${key}": ([^,}]*)`).exec(text)?.[1]);
      if (!Number.isFinite(value)) throw new Error(`${key} is no plain number in the scene; change it in its text`);
      return value;
    },
  }));
}

/** The maps of a list, which may hold others. */
function items(list: string): string[] {
  const out: string[] = [];
  for (let at = 0, depth = 0, start = 0; at < list.length; ++at) {
    if (list[at] === '{' && depth++ === 0) start = at;
    if (list[at] === '}' && --depth === 0) out.push(list.slice(start, at + 1));
  }
  return out;
}
