// The page's simulator under node, and the native program, both from their build folders.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..', '..');
const program = process.env.WUNDERLICH_PROGRAM ?? path.join(root, 'build', 'release', 'wunderlich');

export async function startSimulator() {
  const { Simulator } = await import(path.join(root, 'build', 'web', 'simulator.mjs'));
  const bytes = readFileSync(path.join(root, 'build', 'web', 'page', 'wunderlich.wasm'));
  return Simulator.start(await WebAssembly.compile(bytes));
}

/** summary.json of a scene run by the program. */
export function runNative(scene, overrides) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'wunderlich-'));
  try {
    const out = path.join(folder, 'run');
    const sets = overrides.flatMap((override) => ['--set', override]);
    execFileSync(program, ['run', scene, ...sets, '--out', out, '--formats', 'none'], { stdio: 'ignore' });
    return JSON.parse(readFileSync(path.join(out, 'summary.json'), 'utf8'));
  } finally {
    rmSync(folder, { recursive: true });
  }
}
