// Starts the page.
import { byId } from '../../shared/format';
import { connectControls } from './controls';
import { connectKeep } from './keep';
import { Page } from './page';
import { probe } from './probe';
import { Simulator } from './simulator';

async function start() {
  const status = byId('status');
  try {
    const module = await WebAssembly.compileStreaming(fetch('wunderlich.wasm'));
    const simulator = await Simulator.start(module), scenes = simulator.scenes();
    const page = new Page(simulator, scenes);
    connectControls(page, scenes);
    connectKeep(simulator, () => page.name, () => page.current(), () => ({
      name: page.name, text: page.text, settings: simulator.settings(), colour: page.colour, rulings: page.rulings,
    }));
    await page.open();
    Object.assign(window, { wunderlich: probe(page) });
    requestAnimationFrame((now) => page.tick(now));
    document.documentElement.dataset.ready = String(Math.round(performance.now()));
  } catch (error) {
    status.textContent = `This page could not start: ${(error as Error).message}`;
    status.classList.add('bad');
    throw error;
  }
}

void start();
