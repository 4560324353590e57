// Values of keys put into the text of a scene, whose comments and layout stay.
import { byId } from '../../shared/format';
import type { Simulator } from './simulator';

const value = '(?:\\[[^\\]]*\\]|[^#\\s][^#\\n]*?)';   // a list in brackets, or up to a comment

/** `section.key=value` or `key=value`, one after the other; deeper ones are left to the reader. */
function put(text: string, override: string): string {
  const [path, to] = override.split(/=(.*)/s), [section, key, deeper] = path.split('.');
  if (deeper) return text;
  if (!key) {
    const line = new RegExp(`^(${section}:[ \\t]*)${value}([ \\t]*(?:#.*)?)$`, 'm');
    return line.test(text) ? text.replace(line, (_, before, after) => `${before}${to}${after}`) : `${text.trimEnd()}\n\n${section}: ${to}\n`;
  }
  const start = new RegExp(`^${section}:[ \\t]*(?:#.*)?\\n`, 'm').exec(text);
  if (!start) return text;
  const from = start.index + start[0].length;
  const length = /^(?:[ \t]+.*\n?|[ \t]*\n|[ \t]*#.*\n)*/.exec(text.slice(from))![0].length;
  const block = text.slice(from, from + length);
  const line = new RegExp(`^([ \\t]+${key}:[ \\t]*)${value}([ \\t]*(?:#.*)?)$`, 'm');
  const indent = /^[ \t]+/.exec(block)?.[0] ?? '  ';
  const edited = line.test(block) ? block.replace(line, (_, before, after) => `${before}${to}${after}`) : `${indent}${key}: ${to}\n${block}`;
  return text.slice(0, from) + edited + text.slice(from + length);
}

/** The text with other values; where it is written in a way that this does not know, the reader's own rendering. */
export function edited(simulator: Simulator, text: string, name: string, overrides: string[]): string {
  if (overrides.length === 0) return text;
  const out = overrides.reduce(put, text);
  try {
    if (simulator.resolve(out, name, []) === simulator.resolve(out, name, overrides)) return out;
  } catch {
    // The reader's own, then.
  }
  return simulator.resolve(text, name, overrides);
}

/** Puts the cursor where the message says. */
export function pointAt(message: string) {
  const place = /:(\d+):(\d+):/.exec(message);
  if (!place) return;
  const area = byId<HTMLTextAreaElement>('text');
  const lines = area.value.split('\n'), line = Number(place[1]) - 1;
  const start = lines.slice(0, line).reduce((sum, l) => sum + l.length + 1, 0) + Number(place[2]) - 1;
  const end = lines.slice(0, line + 1).reduce((sum, l) => sum + l.length + 1, 0) - 1;
  area.focus();
  area.setSelectionRange(Math.min(start, area.value.length), Math.max(start, end));
}
