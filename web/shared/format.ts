// Numbers and elements as the page writes them.

const superscripts: Record<string, string> = {
  '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹',
};

/** `digits` significant ones; powers of ten where that is easier to read. */
export function number(value: number, digits = 5): string {
  if (value === 0) return '0';
  if (!Number.isFinite(value)) return Number.isNaN(value) ? '–' : value > 0 ? '∞' : '−∞';
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits))).replace('-', '−');
  const [mantissa, exponent] = value.toExponential(Math.max(0, Math.min(digits, 3) - 1)).split('e');
  const power = [...exponent.replace('+', '')].map((c) => superscripts[c]).join('');
  if (digits === 1 && mantissa === '1') return `10${power}`;
  return `${mantissa.replace('-', '−')}\u2009×\u200910${power}`;
}

export function quantity(value: number, unit: string, digits = 5): string {
  return unit ? `${number(value, digits)}\u202f${unit}` : number(value, digits);
}

export function seconds(value: number): string {
  if (value === 0) return '0\u202fs';
  if (value < 1e-3) return quantity(value * 1e6, 'µs', 3);
  if (value < 1) return quantity(value * 1e3, 'ms', 3);
  return quantity(value, 's', 3);
}

type Child = Node | string;

/** An element; `spec` is `tag.class.class`. */
export function element(spec: string, attributes: Record<string, string> = {}, ...children: Child[]): HTMLElement {
  const [tag, ...classes] = spec.split('.');
  const out = document.createElement(tag);
  if (classes.length) out.className = classes.join(' ');
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, value);
  out.append(...children);
  return out;
}

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}
