// The look that a machine keeps up with, frame by frame, under node.
import path from 'node:path';
import { root } from './node_simulator.mjs';

const { looks, Quality } = await import(path.join(root, 'build', 'web', 'quality.mjs'));
let failed = 0;
const check = (ok, text) => {
  console.log(`${ok ? 'ok    ' : 'FAILED'} ${text}`);
  if (!ok) ++failed;
};
/** The levels after each of so many frames. */
const frames = (quality, count, milliseconds) => Array.from({ length: count }, (_, k) => {
  quality.took(typeof milliseconds === 'function' ? milliseconds(k) : milliseconds);
  return quality.level;
});
const last = looks.length - 1;

check(frames(new Quality(false), 200, 8).every((level) => level === 0), 'a quick machine draws by the finest look');
check(frames(new Quality(false), 200, (k) => (k % 8 === 3 ? 400 : 10)).every((level) => level === 0), 'one late frame in eight changes nothing');
const slow = frames(new Quality(false), 100, 50);
check(slow.at(-1) === last && slow.every((level, k) => k === 0 || level - slow[k - 1] <= 1), `a slow one goes down step by step: ${[...new Set(slow)]}`);
check(frames(new Quality(false), 200, 19).every((level) => level === 0), 'what is nearly in time stays as it is');

// A machine that keeps up with all but the two finest looks.
const quality = new Quality(true), tries = [];
for (let k = 0, before = quality.level; k < 20000; ++k, before = quality.level) {
  quality.took(quality.level < 2 ? 40 : 10);
  if (before === 2 && quality.level === 1) tries.push(k);
}
const gaps = tries.slice(1).map((k, i) => k - tries[i]);
check(tries.length > 2 && gaps.every((gap, i) => i === 0 || gap > 3 * gaps[i - 1]), `finer looks that fail are tried ever later: after ${gaps} frames`);

const rest = new Quality(false);
rest.level = last;
check(rest.look(true) === looks[last], 'what moves is drawn by the look reached');
let look;
for (let k = 0; k < 60; ++k) look = rest.look(false);
check(look === looks[0] && rest.look(true) === looks[last], 'what stands still by the finest, until it moves');

process.exit(failed ? 1 : 0);
