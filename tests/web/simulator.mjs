// The page's simulator under node: equilibria beside the program's, energies agree to 1e-9; a bad scene is answered in the
// same words; every scene runs; hands that pull too fast do no harm.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { root, runNative, startSimulator } from './node_simulator.mjs';

const tolerance = 1e-9;
const cases = [
  ['cantilever', []], ['buckled-strip', []], ['moebius', []], ['figure-eight', []], ['twist-clamped', []], ['helix', []],
  ['moebius', ['ribbon.aspect=5pi/4', 'ribbon.segments=100']],
];

const simulator = await startSimulator();
const scenes = new Map(simulator.scenes().map((scene) => [scene.name, scene.text]));
let failed = 0;
const check = (ok, text) => {
  console.log(`${ok ? 'ok    ' : 'FAILED'} ${text}`);
  if (!ok) ++failed;
};

for (const [scene, overrides] of cases) {
  simulator.load(scenes.get(scene), scene, overrides);
  while (simulator.follow(1000));
  const ours = simulator.summary(), native = runNative(scene, overrides);
  const difference = Math.abs(ours.energy.elastic - native.energy.elastic) / Math.abs(native.energy.elastic);
  check(ours.converged && native.converged && difference <= tolerance,
    `${scene} ${overrides.join(' ')}: ${ours.energy.elastic} J, relative difference ${difference.toExponential(1)}`);
}

// The last good scene goes on after one that cannot be read.
const broken = scenes.get('cantilever').replace('segments: ', 'segmens: ');
let message = '';
try {
  simulator.load(broken, 'broken.yaml');
} catch (error) {
  message = error.message;
}
const folder = mkdtempSync(path.join(os.tmpdir(), 'wunderlich-'));
writeFileSync(path.join(folder, 'broken.yaml'), broken);
let native = '';
try {
  execFileSync(process.env.WUNDERLICH_PROGRAM ?? path.join(root, 'build/release/wunderlich'), ['check', 'broken.yaml'], { cwd: folder, stdio: 'pipe' });
} catch (error) {
  native = error.stderr.toString();
} finally {
  rmSync(folder, { recursive: true });
}
check(message !== '' && native.includes(message), `a misspelt key: ${message}`);
check(simulator.step(1e-3) === 'done', 'the scene before goes on');

// Every scene starts, runs or moves.
for (const [name, text] of scenes) {
  simulator.load(text, name);
  const end = performance.now() + 1500;
  let failure = simulator.failure();
  while (!failure && simulator.onPath() && performance.now() < end) simulator.follow(100), failure = simulator.failure();
  for (let k = 0; k < 10 && !failure && !simulator.onPath() && performance.now() < end; ++k) {
    if (simulator.step(2e-3) === 'failed') failure = simulator.failure();
  }
  if (failure) check(false, `${name}: ${failure}`);
}
check(scenes.size > 20, `${scenes.size} scenes start`);

// A hand that jumps about faster than any strip can follow, here and there on it: steps may fail, the strip never does.
function random(seed) {
  let state = seed;
  return () => (state = (1103515245 * state + 12345) % 2147483648) / 2147483648;
}
for (const name of ['cantilever', 'twist-clamped', 'moebius', 'swing']) {
  const info = simulator.load(scenes.get(name), name), next = random(7);
  while (simulator.follow(1000));
  const { segments, length } = info.strips[0];
  let letGo = 0, taken = 0;
  for (let k = 0; k < 120; ++k) {
    if (!simulator.holds()) simulator.grab(0, Math.floor(next() * (segments + 1)));
    simulator.drag(...[0, 1, 2].map(() => 3 * length * (next() - 0.5)));
    simulator.turn(4 * (next() - 0.5));
    for (let i = 0; i < 3; ++i) simulator.step(info.step) === 'failed' ? ++letGo : ++taken;
    if (k % 9 === 8) simulator.letGo();
  }
  simulator.refresh();
  const { area_error: area, torsion_error: torsion, ruling_ratio: ratio } = simulator.numbers();
  check(area < 1e-9 && torsion * length < 1e-6 && ratio < 1 && taken > 300,
    `${name} pulled about: ${taken} steps, let go ${letGo} times, area error ${area.toExponential(1)}`);
}

process.exit(failed ? 1 : 0);
