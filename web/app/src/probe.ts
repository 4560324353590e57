// What the page tells tests and the curious, as `wunderlich` in the browser's console.
import { looks } from './quality';
import type { Page } from './page';
import type { Settings } from './simulator';

const frameTime = 1 / 60;   // seconds

/** Pulls the far end to and fro, a bit further with each call. */
function puller({ simulator, hand, info }: Page): () => void {
  const last = info.strips[0].segments, at = hand.position({ strip: 0, node: last });
  const reach = 0.1 * info.strips[0].length;
  let k = 0;
  simulator.grab(0, last);
  return () => simulator.drag(at.x, at.y, at.z + reach * Math.sin(k++ / 8));
}

/** Milliseconds a frame: of the simulation, of the page's own work for the picture, and until that is drawn. */
function measure(page: Page, frames: number) {
  const { simulator, stage, clock } = page, sum = { simulate: 0, script: 0, draw: 0 }, pull = puller(page);
  stage.setLook(page.quality.look(true));
  for (let k = 0; k < frames; ++k) {
    const start = performance.now();
    pull();
    clock.advance(page.info.pace * frameTime);
    const middle = performance.now();
    stage.show(simulator.view());
    stage.moves();
    stage.draw();
    const asked = performance.now();
    stage.finish();
    sum.simulate += (middle - start) / frames;
    sum.script += (asked - middle) / frames;
    sum.draw += (performance.now() - middle) / frames;
  }
  simulator.letGo();
  return sum;
}

/** Frames a second that the browser asks for while the far end is pulled. */
function rate(page: Page, seconds: number): Promise<number> {
  const pull = puller(page), start = performance.now();
  let frames = 0;
  return new Promise((resolve) => {
    const frame = () => {
      const passed = (performance.now() - start) / 1000;
      if (passed < seconds) {
        pull();
        ++frames;
        requestAnimationFrame(frame);
      } else {
        page.simulator.letGo();
        resolve(frames / passed);
      }
    };
    requestAnimationFrame(frame);
  });
}

export function probe(page: Page) {
  const { simulator, stage, hand, clock, quality } = page;
  return {
    nodes: () => Array.from(simulator.view().nodes),
    field: (name: 'kappa' | 'tau' | 'eta' | 'energy') => Array.from(simulator.view().fields[name]),
    numbers: () => simulator.numbers(),
    settings: () => simulator.settings(),
    set: (settings: Settings) => simulator.set(settings),
    onPath: () => simulator.onPath(),
    holds: () => simulator.holds(),
    playing: () => clock.playing,
    place: (strip: number, node: number) => stage.project(hand.position({ strip, node })),
    scene: () => ({ name: page.name, text: page.text }),
    memory: () => stage.memory(),
    drawn: () => stage.drawn,
    level: () => quality.level,
    levels: () => looks.length,
    /** Draws by this look alone; null: by what the machine reaches. */
    fix: (level: number | null) => { quality.fixed = level === null ? null : looks[level]; },
    measure: (frames: number) => measure(page, frames),
    rate: (seconds: number) => rate(page, seconds),
  };
}
