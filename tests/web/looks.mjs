// What is seen and what is read out: colours, rulings, plots, still pictures, memory, names of controls.
import { atRest, check, choose, listen, pixels, setRange, settings, shot } from './driver.mjs';

const drawn = (page) => page.evaluate(() => window.wunderlich.drawn());

/** The picture once it stands still. */
async function still(page) {
  await page.evaluate(() => { window.drawnBefore = undefined; });
  await page.waitForFunction(() => {
    const now = window.wunderlich.drawn(), still = now === window.drawnBefore;
    window.drawnBefore = now;
    return still;
  }, undefined, { polling: 800, timeout: 60000 });
  return page.locator('#view').screenshot();
}

/** Each choice of colours has its own pixels; rulings are there or not; nothing is drawn that stands still. */
export async function colours(page) {
  await choose(page, 'moebius');
  await page.click('#play');
  await page.evaluate(() => window.wunderlich.fix(window.wunderlich.levels() - 1));
  const pictures = [];
  for (const title of ['Paper', 'curvature', 'torsion', 'ruling slope', 'energy a length']) {
    await page.locator(`label[title="${title}"]`).click();
    pictures.push([title, await still(page)]);
  }
  for (let i = 0; i < pictures.length; ++i) {
    for (let j = 0; j < i; ++j) {
      const share = await pixels(page, pictures[i][1], pictures[j][1]);
      check(share > 0.01, `${pictures[i][0]} is not ${pictures[j][0]}: ${(100 * share).toFixed(1)} % of the pixels`);
    }
  }
  await page.locator('label[title="Paper"]').click();
  const without = await still(page);
  await page.click('#rulings');
  const withRulings = await still(page);
  await page.screenshot({ path: shot('rulings') });
  await page.click('#rulings');
  const share = await pixels(page, withRulings, without), again = await pixels(page, await still(page), without);
  check(share > 0.002 && share < 0.1 && again < share / 20, `rulings are ${(100 * share).toFixed(2)} % of the pixels, and go again`);

  await page.evaluate(() => window.wunderlich.fix(null));
  await page.locator('label[title="torsion"]').click();   // the picture of docs/browser.md
  await still(page);
  await page.screenshot({ path: shot('still') });
  const before = await drawn(page);
  await page.waitForTimeout(600);
  check((await drawn(page)) === before, 'what stands still is not drawn again');
  await page.press('#view', 'ArrowLeft');
  await page.waitForFunction((n) => window.wunderlich.drawn() > n, before, { timeout: 20000 });
  check(true, 'until the view turns');
  await page.locator('label[title="Paper"]').click();
}

/** Each of the three curves is another one when the ribbon has been pulled and twisted. */
export async function plots(page) {
  const curves = () => page.evaluate(() => [...document.querySelectorAll('#plots canvas')].map((canvas) => canvas.toDataURL()));
  await choose(page, 'cantilever');
  await page.waitForTimeout(600);
  const before = await curves();
  await page.focus('#view');
  await page.keyboard.press('e');
  for (let k = 0; k < 8; ++k) await page.keyboard.press(k % 2 ? 'ArrowUp' : 'w');
  await page.waitForFunction((old) => [...document.querySelectorAll('#plots canvas')].every((canvas, i) => canvas.toDataURL() !== old[i]),
    before, { timeout: 20000 });
  check(before.length === 3, 'three plots follow the ribbon');
  await page.keyboard.press('Escape');
}

export async function asGiven(page) {
  await choose(page, 'cantilever');
  const given = await settings(page);
  await setRange(page, '#set-damping', 4);
  await setRange(page, '#set-stiffness', Math.log(2));
  const changed = await settings(page);
  check(Math.abs(changed.damping - 4) < 0.1 && Math.abs(changed.stiffness - 2) < 0.1, 'damping and stiffness change');
  await page.click('#as-given');
  const now = await settings(page);
  check(JSON.stringify(now) === JSON.stringify(given), `one button brings back what the scene says: damping ${now.damping}`);
  check(Math.abs(Number(await page.inputValue('#set-damping')) - given.damping) < 0.05, 'and the sliders are there');
}

/** Scenes that go leave nothing in the graphics memory. */
export async function memory(page) {
  const visit = async (scene) => {
    await page.selectOption('#scene', scene);   // it stands there at once; the frame after it is drawn
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  };
  const round = async () => {
    for (const scene of ['drape-cylinder', 'paper-chain', 'moebius', 'belt', 'cantilever']) await visit(scene);
    return JSON.stringify(await page.evaluate(() => window.wunderlich.memory()));
  };
  await page.evaluate(() => window.wunderlich.fix(window.wunderlich.levels() - 1));
  const first = await round(), after = [await round(), await round()];
  await page.evaluate(() => window.wunderlich.fix(null));
  check(after.every((now) => now === first), `ten more scenes need no more graphics memory: ${first}, then ${after.at(-1)}`);
}

/** A ribbon that nothing holds falls, and the view with it. */
export async function falling(page) {
  await choose(page, 'moebius');
  await setRange(page, '#set-gravity', 20);
  const lowest = () => page.evaluate(() => Math.min(...window.wunderlich.nodes().filter((_, i) => i % 3 === 2)));
  await page.waitForFunction(() => Math.max(...window.wunderlich.nodes().filter((_, i) => i % 3 === 2)) < -100, undefined, { timeout: 60000 });
  const share = await pixels(page, await page.locator('#view').screenshot());
  check(share > 0.02, `${-Math.round(await lowest())} m below it still covers ${(100 * share).toFixed(1)} % of the picture`);
}

/** The line that is read out names each part of a path once, without counting. */
export async function spoken(page) {
  await listen(page);
  await choose(page, 'loop-2pi');
  await page.waitForFunction(() => window.said.some((text) => /^At rest/.test(text)));
  const said = await page.evaluate(() => window.said), path = said.filter((text) => /^On the way/.test(text));
  check(path.length > 1 && new Set(path).size === path.length && !said.some((text) => /%/.test(text)), `read out on a path: ${said.join(' | ')}`);
  const live = await page.evaluate(() => [...document.querySelectorAll('output, [role=status], [role=alert], [aria-live]')].map((e) => e.id));
  check(live.sort().join() === 'kept,message,status', `read out by themselves: ${live.join(', ')}`);
}

/** Tab comes to every control, and each has a name. */
export async function reachable(page) {
  await page.reload();
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  await atRest(page);
  const wanted = await page.evaluate(() => {
    const all = [...document.querySelectorAll('a[href], button, select, textarea, input, [tabindex="0"]')];
    all.forEach((control, i) => { control.dataset.control = String(i); });
    return all.filter((control) => control.type !== 'radio' || control.checked)   // one stop for the group
      .map((control) => [control.dataset.control, control.id || control.className || control.name]);
  });
  await page.evaluate(() => { document.activeElement?.blur(); scrollTo(0, 0); });
  const reached = new Set();
  for (let k = 0; k < wanted.length + 3; ++k) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement?.dataset.control));
  }
  const missed = wanted.filter(([control]) => !reached.has(control)).map(([, name]) => name);
  check(wanted.length > 20 && missed.length === 0, `Tab reaches ${wanted.length} controls${missed.length ? `, but not ${missed.join(', ')}` : ''}`);

  const client = await page.context().newCDPSession(page);
  const { nodes: tree } = await client.send('Accessibility.getFullAXTree');
  const focusable = tree.filter(({ ignored, properties }) =>
    !ignored && properties?.some(({ name, value }) => name === 'focusable' && value.value) );
  const controls = focusable.filter(({ role }) => !['RootWebArea', 'MenuListPopup', 'generic'].includes(role.value));
  const nameless = controls.filter(({ name }) => !name?.value.trim()).map(({ role }) => role.value);
  check(controls.length >= wanted.length && nameless.length === 0,
    `${controls.length} have names${nameless.length ? `, but not ${nameless.join(', ')}` : ''}`);
}
