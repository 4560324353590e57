// Steps of a motion in WebAssembly beside the same steps by the program, taken in turns on the same machine: medians.
// usage: node bench/compare_wasm.mjs [PROGRAM]; build/web and build/release must be there.
if (process.argv[2]) process.env.WUNDERLICH_PROGRAM = process.argv[2];
const { runNative, startSimulator } = await import('../tests/web/node_simulator.mjs');

const rounds = 5, steps = 200;
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const simulator = await startSimulator();
const text = simulator.scenes().find(({ name }) => name === 'swing').text;

function wasm(overrides) {
  const { step } = simulator.load(text, 'swing', overrides);
  const times = [];
  for (let i = 0; i < steps; ++i) {
    if (simulator.step(step) !== 'done') throw new Error(simulator.failure());
    simulator.refresh();
    times.push(simulator.numbers().step_us);
  }
  return median(times);
}

// The engine compiles what runs often a second time, in the background: not before that is it measured.
for (const end = performance.now() + 5000; performance.now() < end;) {
  wasm(['solver.method=implicit', 'ribbon.segments=100', 'solver.time_step=0.005', 'solver.duration=1']);
}
console.log('segments   wasm us   native us   ratio');
for (const segments of [50, 100, 200]) {
  const overrides = ['solver.method=implicit', `ribbon.segments=${segments}`, 'solver.time_step=0.005', 'solver.duration=1'];
  const times = Array.from({ length: rounds }, () => [wasm(overrides), runNative('swing', overrides).timing.step_us_median]);
  const [ours, native] = [0, 1].map((k) => median(times.map((pair) => pair[k])));
  const ratio = median(times.map(([a, b]) => a / b));
  console.log(`${String(segments).padStart(8)} ${ours.toFixed(1).padStart(9)} ${native.toFixed(1).padStart(11)} ${ratio.toFixed(2).padStart(7)}`);
}
