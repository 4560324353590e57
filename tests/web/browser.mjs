// The page in a real browser: loads, is pulled by mouse, touch and keyboard, shares, saves, and answers bad scenes.
// usage: node browser.mjs NODE_MODULES [FOLDER for screenshots]
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { deflateRawSync, gzipSync } from 'node:zlib';
import {
  bad, check, choose, chromium, download, failures, folder, moved, nodes, numbers, open, pixels, rewrite, serve, setRange, settings,
  shot, twisted,
} from './driver.mjs';
import { keyboard, mouse, refusals, restart, touch, twist } from './hand.mjs';
import { asGiven, colours, falling, memory, plots, reachable, spoken } from './looks.mjs';

// Where there is no graphics processor Chromium draws in software, if it is allowed to.
const flags = ['--headless', '--no-sandbox', '--enable-unsafe-swiftshader', '--disable-background-networking', '--no-first-run'];

async function sizes() {
  const all = readdirSync(folder).map((name) => [name, gzipSync(readFileSync(path.join(folder, name)), { level: 9 }).length]);
  const whole = all.reduce((sum, [, size]) => sum + size, 0);
  check(whole < 1e6, `${(whole / 1e6).toFixed(3)} MB gzipped: ${all.map(([name, size]) => `${name} ${size}`).join(', ')}`);
}

async function sliders(page) {
  await choose(page, 'buckled-strip');
  const before = (await numbers(page)).elastic;
  await setRange(page, '#set-twist', 90);
  await page.waitForFunction((e) => window.wunderlich.numbers().elastic > 1.02 * e, before, { timeout: 60000 });
  check(!(await bad(page)), 'twist turns the far end');
  await choose(page, 'cantilever');
  const nodesBefore = await nodes(page);
  await setRange(page, '#set-gravity', 0);
  await moved(page, nodesBefore, 0.05);
  check(true, 'without gravity a cantilever rises');
  const { width } = await settings(page);
  await page.focus('#set-width');
  for (let k = 0; k < 20; ++k) await page.keyboard.press('ArrowRight');
  await page.waitForFunction((w) => window.wunderlich.settings().width > 1.02 * w, width);
  check(!(await bad(page)), 'width changes by keyboard');
  await setRange(page, '#set-stiffness', Math.log(3));
  await setRange(page, '#set-length', 1.2);
  await page.waitForFunction(() => {
    const all = window.wunderlich.nodes();
    let length = 0;
    for (let i = 3; i < all.length; i += 3) length += Math.hypot(all[i] - all[i - 3], all[i + 1] - all[i - 2], all[i + 2] - all[i - 1]);
    return Math.abs(length - 1.2) < 1e-4;
  }, undefined, { timeout: 60000 });
  check(!(await bad(page)), 'the strip grows to its new length');
}

async function shareLink(page, context) {
  await choose(page, 'cantilever');
  await setRange(page, '#set-stiffness', Math.log(2));
  await page.locator('label[title="torsion"]').click();
  await page.click('#rulings');
  await setRange(page, '#set-twist', 60);
  await page.click('#share');
  await page.waitForFunction(() => location.hash.startsWith('#s='));
  const link = page.url();
  check(link.length < 2000, `a link of ${link.length} characters`);
  const other = await open(context, link);
  await other.waitForFunction(() => !window.wunderlich.onPath(), undefined, { timeout: 60000 });
  const { stiffness, twist: turned } = await settings(other);
  check(Math.abs(turned - Math.PI / 3) < 1e-9, `and its twist: ${turned}`);
  await twisted(other, 0.2);
  check(Math.abs(stiffness - 2) < 0.02, `it brings the scene with its stiffness: ${stiffness}`);
  check(await other.locator('input[value=tau]').isChecked(), 'and the colours');
  check((await other.getAttribute('#rulings', 'aria-pressed')) === 'true', 'and the rulings');
  await other.screenshot({ path: shot('shared') });
  await other.close();
  const broken = await open(context, `${link.split('#')[0]}#s=AAAA`);
  check((await broken.textContent('#message')).length > 0 && (await nodes(broken)).length > 0, 'a broken link is said to be one');
  await broken.close();
}

const fragment = (shared) => `#s=${deflateRawSync(JSON.stringify(shared)).toString('base64url')}`;

/** Links made by others: a colour that is not known, one that unpacks to far more than it is. */
async function strangeLinks(page, context) {
  const text = await page.inputValue('#text'), start = address.split('#')[0];
  const odd = await open(context, start + fragment({ name: 'odd', text, colour: 'x"]', rulings: true }));
  check((await odd.evaluate(() => window.wunderlich.scene())).name === 'odd', 'a link with an unknown colour opens');
  check(await odd.locator('input[value=none]').isChecked(), 'as paper');
  await odd.close();
  const long = await open(context, start + fragment({ name: 'long', text: ' '.repeat(2e6) }));
  const said = await long.textContent('#message');
  check(/longer than a link/.test(said) && (await nodes(long)).length > 0, `one that unpacks to two megabytes is refused: ${said}`);
  await long.close();
  const hash = fragment({ name: 'bad', text: text.replace('segments:', 'segmens:') });
  const unread = await open(context, start + hash);
  check(/segmens/.test(await unread.textContent('#message')) && /segmens/.test(await unread.inputValue('#text')) &&
    (await nodes(unread)).length > 0 && unread.url().endsWith(hash), 'a scene in a link that cannot be read is kept, with the message');
  await unread.evaluate((to) => { location.hash = to; }, fragment({ name: 'next', text }));
  await unread.waitForFunction(() => window.wunderlich.scene().name === 'next', undefined, { timeout: 20000 });
  check(await unread.locator('#message').isHidden(), 'another link in the same page opens');
  await unread.close();
}

async function downloads(page) {
  const [glbName, glb] = await download(page, '#save-glb');
  check(glbName === 'cantilever.glb' && glb.toString('latin1', 0, 4) === 'glTF' && glb.readUInt32LE(8) === glb.length, `${glbName}, ${glb.length} bytes`);
  const [svgName, svg] = await download(page, '#save-pattern');
  check(/pattern/.test(svgName) && svg.toString().includes('<svg'), `${svgName}, ${svg.length} bytes`);
  const [sceneName, scene] = await download(page, '#save-scene');
  check(sceneName === 'cantilever.yaml' && /^# .*\n(.*\n)*  bending_stiffness: 2\.0\d* +# N m$/m.test(scene.toString()), `${sceneName} with the stiffness of the slider`);
}

/** What the sliders say, in the scene file: of several ribbons, and of one given by its modulus. */
async function slidersKept(page) {
  for (const [scene, slider, factor, key, is, count] of [
    ['paper-chain', 'length', 1.1, 'length', 0.33, 3], ['twist-and-shorten', 'stiffness', 2, 'young_modulus', 2e9, 1],
  ]) {
    await choose(page, scene);
    const given = (await settings(page))[slider];
    await setRange(page, `#set-${slider}`, slider === 'length' ? factor * given : Math.log(factor * given));
    const [name, bytes] = await download(page, '#save-scene');
    const found = [...bytes.toString().matchAll(new RegExp(`\\b${key}"?: ([^\\s,}]+)`, 'g'))].map((m) => Number(m[1]));
    check(name === `${scene}.yaml` && found.length === count && found.every((value) => Math.abs(value / is - 1) < 0.02),
      `${scene} is saved with what its slider says: ${key} ${found.join(', ')}`);
  }
}

async function badScene(page) {
  const good = await page.inputValue('#text');
  await page.fill('#text', good.replace('segments:', 'segmens:'));
  await page.click('#run');
  const message = await page.textContent('#message');
  check(/:\d+:\d+: .*segmens/.test(message) && /segments/.test(message), `the reader's words: ${message}`);
  const selected = await page.locator('#text').evaluate((area) => area.value.slice(area.selectionStart, area.selectionEnd));
  check(selected.startsWith('segmens'), `and its place is marked: ${selected}`);
  const { time } = await numbers(page);
  await page.waitForFunction((t) => window.wunderlich.numbers().time > t, time);
  check(true, 'the scene before goes on');
  await page.fill('#text', good.replace(/segments: \d+/, 'segments: 30'));
  await page.locator('#text').press('Control+Enter');
  await page.waitForFunction(() => window.wunderlich.nodes().length === 93);
  check(await page.locator('#message').isHidden(), 'an edited scene runs');
}

/** What should not happen: a frame fails. */
async function badFrame(page) {
  await choose(page, 'cantilever');
  await page.evaluate(() => {
    const find = document.getElementById;
    document.getElementById = () => {
      document.getElementById = find;
      throw new Error('for a test');
    };
  });
  await page.waitForFunction(() => !window.wunderlich.playing(), undefined, { timeout: 20000 });
  const said = await page.textContent('#status');
  check((await bad(page)) && /for a test/.test(said), `a frame that fails pauses and says why: ${said}`);
  const { time } = await numbers(page);
  await page.click('#play');
  await page.waitForFunction((t) => window.wunderlich.numbers().time > t, time, { timeout: 20000 });
  check(true, 'and Play goes on');
}

/** Times of frames, printed. The picture is drawn in software here: by the finest look, and by the one that is reached. */
async function times(page) {
  console.log('milliseconds a frame of 1/60 s: segments, look, simulation, the page\'s own work for the picture, until it is drawn; frames a second');
  await choose(page, 'cantilever');
  for (const segments of [50, 100, 200]) {
    for (const look of [0, null]) {
      await rewrite(page, /segments: \d+/, `segments: ${segments}`);
      await page.waitForFunction(() => !window.wunderlich.onPath(), undefined, { timeout: 60000 });
      await page.evaluate((level) => { scrollTo(0, 0); window.wunderlich.fix(level); }, look);
      const frames = look === 0 ? 8 : 40;
      await page.evaluate((n) => window.wunderlich.measure(n), frames);   // what runs often is compiled a second time
      const { simulate, script, draw } = await page.evaluate((n) => window.wunderlich.measure(n), frames);
      const rate = await page.evaluate(() => window.wunderlich.rate(4));
      const name = look === 0 ? 'finest' : `reached (${await page.evaluate(() => window.wunderlich.level())})`;
      console.log(`${segments}  ${name}  ${simulate.toFixed(2)}  ${script.toFixed(2)}  ${draw.toFixed(1)}  ${rate.toFixed(1)}`);
    }
  }
}

const { server, address } = await serve();
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: flags });
try {
  await sizes();
  const context = await browser.newContext({ viewport: { width: 1360, height: 900 }, acceptDownloads: true });
  const page = await open(context, address);
  const ready = [];
  for (let k = 0; k < 3; ++k) {   // the first time the browser itself is not ready
    if (k > 0) await page.reload();
    ready.push(Number(await (await page.waitForFunction(() => document.documentElement.dataset.ready)).jsonValue()));
  }
  // A time is no test on a machine that does other things: asserted where READY_WITHIN is given.
  check(Math.min(...ready) <= Number(process.env.READY_WITHIN ?? Infinity), `ready after ${ready.join(', ')} ms`);
  await page.waitForFunction(() => !window.wunderlich.onPath(), undefined, { timeout: 60000 });
  await page.waitForTimeout(300);
  const png = await page.locator('#view').screenshot({ path: shot('moebius') });
  const share = await pixels(page, png);
  check(share > 0.02, `the ribbon covers ${(100 * share).toFixed(1)} % of its picture`);
  await page.screenshot({ path: shot('desktop'), fullPage: true });
  const parts = {
    mouse, twist, keyboard, restart, refusals, sliders, asGiven, colours, plots, shareLink, strangeLinks, downloads, slidersKept, badScene,
    badFrame, falling, memory, spoken, reachable,
  };
  const measurements = { times };   // no tests: only when asked for
  const wanted = process.env.ONLY?.split(',') ?? Object.keys(parts);
  Object.assign(parts, measurements);
  for (const name of wanted) {
    if (!parts[name]) continue;
    const start = Date.now();
    await parts[name](page, context).catch((error) => check(false, `${name}: ${error.message}`));
    console.log(`       ${name}: ${((Date.now() - start) / 1000).toFixed(1)} s`);
  }
  if (!process.env.ONLY || wanted.includes('touch')) await touch(browser, address).catch((error) => check(false, `touch: ${error.message}`));
} finally {
  await browser.close();
  server.kill();
}
process.exit(failures() ? 1 : 0);
