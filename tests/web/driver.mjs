// What the tests of the page share: a server, a page whose errors count, the hand's places, pictures.
import { spawn } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { root } from './node_simulator.mjs';

export const { chromium } = createRequire(path.resolve(process.argv[2], 'x.js'))('playwright-core');
export const folder = path.join(root, 'build', 'web', 'page');
const shots = path.resolve(process.argv[3] ?? path.join(root, 'build', 'web', 'shots'));
mkdirSync(shots, { recursive: true });
export const shot = (name) => path.join(shots, `${name}.png`);

let failed = 0;
export const failures = () => failed;
export const check = (ok, text) => {
  console.log(`${ok ? 'ok    ' : 'FAILED'} ${text}`);
  if (!ok) ++failed;
};

export async function serve() {
  const script = path.join(root, 'web', 'app', 'serve.py');
  const server = spawn('python3', [script, folder, '0'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const address = await new Promise((resolve, reject) => {
    server.stdout.once('data', (line) => resolve(String(line).trim()));
    server.once('error', (error) => reject(new Error(`python3 cannot be started: ${error.message}`)));
    server.once('exit', (code) => reject(new Error(`${script} ended with code ${code} before it gave its address`)));
  });
  return { server, address };
}

/** A page whose errors are counted. */
export async function open(context, address) {
  const page = await context.newPage();
  page.on('console', (message) => {
    if (message.type() === 'error') check(false, `the console says: ${message.text()}`);
  });
  page.on('pageerror', (error) => check(false, `an error: ${error.message}`));
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.ready, undefined, { timeout: 60000 });
  return page;
}

export const atRest = (page) => page.waitForFunction(() => !window.wunderlich.onPath(), undefined, { timeout: 120000 });
export const choose = async (page, scene) => {
  await page.selectOption('#scene', scene);
  await atRest(page);
};
/** Starts the scene with something else in its text. */
export async function rewrite(page, pattern, by) {
  await page.fill('#text', (await page.inputValue('#text')).replace(pattern, by));
  await page.click('#run');
}
export const nodes = (page) => page.evaluate(() => window.wunderlich.nodes());
export const numbers = (page) => page.evaluate(() => window.wunderlich.numbers());
export const settings = (page) => page.evaluate(() => window.wunderlich.settings());
export const holds = (page) => page.evaluate(() => window.wunderlich.holds());
export const bad = (page) => page.evaluate(() => document.getElementById('status').classList.contains('bad'));

/** Where a node is on the screen. */
export async function place(page, node) {
  await page.locator('#view').scrollIntoViewIfNeeded();
  return page.evaluate((n) => {
    const box = document.querySelector('#view canvas').getBoundingClientRect();
    const [x, y] = window.wunderlich.place(0, n);
    return [box.left + x, box.top + y];
  }, node);
}
/** Waits until the last node is farther from where it was. */
export const moved = (page, before, least) => page.waitForFunction(([start, far]) => {
  const now = window.wunderlich.nodes();
  return Math.hypot(...[0, 1, 2].map((c) => now[now.length - 3 + c] - start[start.length - 3 + c])) > far;
}, [before, least], { timeout: 60000 });
/** How far apart two shapes are, at most. */
export const apart = (a, b) => Math.max(...a.map((value, i) => Math.abs(value - b[i])));

/** Waits until the mean torsion [1/m] has gone beyond a value, on its side of zero. */
export const twisted = (page, beyond) => page.waitForFunction((limit) => {
  const tau = window.wunderlich.field('tau'), mean = tau.reduce((sum, value) => sum + value) / tau.length;
  return limit > 0 ? mean > limit : mean < limit;
}, beyond, { timeout: 60000 });

/** From now on `said` has every text of the line that is read out. */
export const listen = (page) => page.evaluate(() => {
  const status = document.getElementById('status');
  window.said = [];
  window.listener?.disconnect();
  window.listener = new MutationObserver(() => window.said.push(status.textContent));
  window.listener.observe(status, { childList: true, characterData: true, subtree: true });
});

export async function setRange(page, id, value) {
  await page.locator(id).evaluate((input, to) => {
    input.value = to;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }, String(value));
}

export async function download(page, button) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  return [file.suggestedFilename(), readFileSync(await file.path())];
}

/** The share of the second picture's pixels that are not those of the first; of one alone: that are as red as the ribbon. */
export function pixels(page, first, second = null) {
  return page.evaluate(async (pictures) => {
    const [one, other] = await Promise.all(pictures.map(async (data) => {
      const bytes = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      return new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    }));
    const chosen = (p, i) => (other ? p !== other[i] : (p & 255) > ((p >> 16) & 255) + 50);
    return one.filter(chosen).length / one.length;
  }, [first, ...(second ? [second] : [])].map((png) => png.toString('base64')));
}
