// Pulling and twisting: by mouse, keyboard and touch; letting go; starting again.
import { apart, atRest, bad, check, choose, holds, listen, moved, nodes, numbers, open, place, rewrite, shot, twisted } from './driver.mjs';

export async function mouse(page) {
  await choose(page, 'cantilever');
  const before = await nodes(page), [x, y] = await place(page, 50);
  await page.mouse.move(x, y);
  await page.mouse.down();
  check(await holds(page), 'the mouse takes the free end');
  check((await page.textContent('#status')) === 'Holding node 50 of 50', 'and says so');
  await page.mouse.move(x - 60, y - 90, { steps: 6 });
  await moved(page, before, 0.1);
  check(true, 'the end follows the mouse');
  await page.mouse.up();
  check(!(await holds(page)) && (await page.textContent('#status')) === '', 'and is let go');
  const now = await nodes(page), error = (await numbers(page)).area_error;
  check(apart(now.slice(0, 3), before.slice(0, 3)) < 1e-9, 'the clamped end has stayed');
  check(error < 1e-9, `the surface is still that of the flat strip: area error ${error}`);
  await page.screenshot({ path: shot('cantilever') });
  await page.keyboard.press('Control+A');   // with text selected a browser would drag that
  const [u, v] = await place(page, 50), selected = await nodes(page);
  await page.mouse.move(u, v);
  await page.mouse.down();
  await page.mouse.move(u - 50, v - 60, { steps: 6 });
  check(await holds(page), 'the mouse holds where text is selected');
  await moved(page, selected, 0.05);
  await page.mouse.up();
  await page.evaluate(() => getSelection().removeAllRanges());
}

/** By the wheel, and sideways with Shift: a right-handed turn gives positive torsion. */
export async function twist(page) {
  const turn = async (name, key, forth, back) => {
    await choose(page, 'buckled-strip');
    const [x, y] = await place(page, (await nodes(page)).length / 3 - 1);
    await page.mouse.move(x, y);
    await page.mouse.down();
    if (key) await page.keyboard.down(key);
    for (let k = 1; k <= 6; ++k) await forth(k, x, y);
    await twisted(page, 0.2);
    for (let k = 1; k <= 6; ++k) await back(k, x, y);
    await twisted(page, -0.2);
    await page.mouse.up();
    if (key) await page.keyboard.up(key);
    check(!(await bad(page)), `${name} twists what is held, to both sides ${await page.textContent('#status')}`);
  };
  await turn('the wheel', null, () => page.mouse.wheel(0, 30), () => page.mouse.wheel(0, -60));
  await turn('the mouse with Shift', 'Shift', (k, x, y) => page.mouse.move(x + 6 * k, y), (k, x, y) => page.mouse.move(x + 36 - 12 * k, y));
}

export async function keyboard(page) {
  await choose(page, 'cantilever');
  const before = await nodes(page), press = async (key, times) => {
    for (let k = 0; k < times; ++k) await page.keyboard.press(key);
  };
  await page.focus('#view');
  await press('e', 1);
  check(await holds(page), 'E takes the far end');
  await press('ArrowUp', 8);
  await moved(page, before, 0.03);
  check(true, 'arrow keys pull it');
  await press('w', 6);
  await twisted(page, 0.2);
  await press('q', 12);
  await twisted(page, -0.2);
  check(true, 'W and Q twist it, to one side and the other');
  await press('Escape', 1);
  check(!(await holds(page)), 'Escape lets go');
  await press(' ', 1);
  check(!(await page.evaluate(() => window.wunderlich.playing())), 'Space pauses');
  const paused = (await numbers(page)).time;
  await press('s', 1);
  await page.waitForFunction((t) => window.wunderlich.numbers().time > t, paused, { timeout: 20000 });
  check(!(await page.evaluate(() => window.wunderlich.playing())), 'S is one step');
  await press(' ', 1);
}

/** The button and R bring back what the scene began with. */
export async function restart(page) {
  for (const [name, again] of [['the button', () => page.click('#restart')], ['R', () => page.press('#view', 'r')]]) {
    await choose(page, 'cantilever');
    const start = await nodes(page);
    await page.focus('#view');
    await page.keyboard.press('e');
    for (let k = 0; k < 12; ++k) await page.keyboard.press('ArrowUp');
    await moved(page, start, 0.1);
    await again();
    await atRest(page);
    const error = apart(await nodes(page), start), { time } = await numbers(page);
    check(error < 1e-4 && time < 5 && !(await holds(page)), `${name} starts again: ${error.toExponential(1)} m from the first start`);
  }
}

/** What cannot be reached: the simulator lets go and the page says why; a path that fails keeps its message. */
export async function refusals(page) {
  await choose(page, 'cantilever');
  await listen(page);
  await page.focus('#view');
  await page.keyboard.press('e');
  await page.evaluate(() => { window.given = window.wunderlich.settings(); window.wunderlich.set({ ...window.given, gravity: [0, 0, -1e300] }); });
  await page.waitForFunction(() => !window.wunderlich.holds(), undefined, { timeout: 60000 });
  const said = (await page.evaluate(() => window.said)).find((text) => /^Let go; .+: .+/.test(text));
  check(said && (await bad(page)), `when a step fails the hand lets go: ${said}`);
  await page.evaluate(() => window.wunderlich.set(window.given));
  await page.keyboard.press('e');
  check(!(await bad(page)) && (await holds(page)), 'and can take hold again');
  await page.keyboard.press('Escape');

  await choose(page, 'moebius');
  await rewrite(page, /aspect: 5pi\b/, 'aspect: 1.8');
  await page.waitForFunction(() => !window.wunderlich.playing(), undefined, { timeout: 60000 });
  const why = await page.textContent('#status');
  await page.waitForTimeout(500);
  check((await bad(page)) && /^No equilibrium: .+/.test(why) && (await page.textContent('#status')) === why,
    `a path that fails says why, and goes on saying it: ${why}`);
}

export async function touch(browser, address) {
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const page = await open(context, address);
  await choose(page, 'cantilever');
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  check(wide <= 390, `nothing sticks out at 390 pixels: ${wide}`);
  const before = await nodes(page), [x, y] = await place(page, 50);
  const client = await context.newCDPSession(page);
  const send = (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  await send('touchStart', [[x, y]]);
  for (let k = 1; k <= 8; ++k) await send('touchMove', [[x - 6 * k, y - 10 * k]]);
  await moved(page, before, 0.1);
  check(await holds(page), 'a finger pulls the end');
  const first = [x - 48, y - 80], about = (angle) => [first[0] + 80 * Math.cos(angle), first[1] + 80 * Math.sin(angle)];
  await send('touchStart', [first, about(0)]);
  for (let k = 1; k <= 6; ++k) await send('touchMove', [first, about(0.1 * k)]);
  await twisted(page, 0.2);
  for (let k = 1; k <= 12; ++k) await send('touchMove', [first, about(0.6 - 0.1 * k)]);
  await twisted(page, -0.2);
  check(true, 'a second one twists it, to both sides');
  await send('touchEnd', []);
  await page.waitForFunction(() => !window.wunderlich.holds());
  check(true, 'and lets go');
  await page.screenshot({ path: shot('phone'), fullPage: true });
  await context.close();
}
