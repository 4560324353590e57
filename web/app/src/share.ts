// A scene as a link: its text and what the sliders say, compressed into the part of the address that no server sees.
import { colours, type Colour } from './ribbon';
import type { Settings } from './simulator';

const longest = 1e6;   // bytes of what a link unpacks to

export interface Shared { name: string; text: string; settings?: Settings; colour?: Colour; rulings?: boolean }

/** Settings that a link may hold; undefined where they are none. */
function settingsIn(found: unknown): Settings | undefined {
  const { length, width, stiffness, twist, damping, gravity } = (found ?? {}) as Settings;
  const numbers = [length, width, stiffness, twist, damping, ...(Array.isArray(gravity) && gravity.length === 3 ? gravity : [NaN])];
  if (!numbers.every(Number.isFinite) || Math.min(length, width, stiffness) <= 0 || damping < 0) return undefined;
  return { length, width, stiffness, twist, damping, gravity };
}

async function through(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader(), parts: Uint8Array<ArrayBuffer>[] = [];
  for (let size = 0, next = await reader.read(); !next.done; next = await reader.read()) {
    size += next.value.length;
    if (size > longest) throw new Error('it is longer than a link may be');
    parts.push(next.value as Uint8Array<ArrayBuffer>);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

export async function toFragment(shared: Shared): Promise<string> {
  const bytes = new TextEncoder().encode(JSON.stringify(shared)) as Uint8Array<ArrayBuffer>;
  const packed = await through(bytes, new CompressionStream('deflate-raw'));
  let binary = '';
  for (const byte of packed) binary += String.fromCharCode(byte);
  return `#s=${btoa(binary).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '')}`;
}

/** Null where the address holds no scene; throws where it holds a broken one. */
export async function fromFragment(fragment: string): Promise<Shared | null> {
  const packed = /^#s=([\w-]+)$/.exec(fragment)?.[1];
  if (!packed) return null;
  const binary = atob(packed.replace(/-/g, '+').replace(/_/g, '/'));
  const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
  const shared = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream('deflate-raw'))));
  if (typeof shared?.text !== 'string' || typeof shared?.name !== 'string') throw new Error('the link holds no scene');
  const colour = colours.find((known) => known === shared.colour);   // one that is not known is left out
  return { name: shared.name, text: shared.text, settings: settingsIn(shared.settings), colour, rulings: shared.rulings === true };
}
