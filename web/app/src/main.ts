// The page: a scene, a hand, a clock.
import { byId, element, quantity } from '../../shared/format';
import { Meter, showFigures, showLegend } from './figures';
import { Hand } from './hand';
import { connectKeep } from './keep';
import { LivePlots } from './plots';
import { edited, pointAt } from './scene_text';
import { fromFragment, type Shared } from './share';
import { Simulator, SimulatorError, type SceneInfo, type ShippedScene } from './simulator';
import { Sliders } from './sliders';
import { Stage, type Colour } from './stage';

const budget = 11;        // milliseconds of a frame for the simulation
const longest = 0.05;     // seconds that a frame may be late
const slow = 45;          // milliseconds for drawing, frame after frame: then without shadows
const patience = 4;       // such frames
const plotEvery = 70;     // milliseconds between two drawings of the plots
const first = 'moebius';

const icons = {
  play: '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M6 3.8v12.4L16.5 10z" fill="currentColor"/></svg>',
  pause: '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 4h3.6v12H5zm6.4 0H15v12h-3.6z" fill="currentColor"/></svg>',
};

class Page {
  private info!: SceneInfo;
  private text = '';
  private name = '';
  private playing = true;
  private owed = 0;   // seconds of the motion that are still to be shown
  private before = 0;
  private lastPlot = 0;
  private meter = new Meter();
  private colour: Colour = 'none';
  private slowFrames = 0;
  private behind = 1;   // share of the asked pace that is reached
  private readonly stage: Stage;
  private readonly hand: Hand;
  private readonly plots = new LivePlots();
  private readonly sliders: Sliders;

  constructor(private readonly simulator: Simulator, private readonly scenes: ShippedScene[]) {
    this.stage = new Stage(byId('view'), () => {});
    this.hand = new Hand(simulator, this.stage, () => this.info.strips, () => this.held());
    this.sliders = new Sliders((settings) => this.simulator.set(settings), (halfTwists) =>
      this.edit([`ribbon.half_twists=${halfTwists}`]));
  }

  /** Starts a scene; false, and the message where the text is, if it cannot be read. */
  load(text: string, name: string): boolean {
    const message = byId('message');
    try {
      this.begin(this.simulator.load(text, name), text, name);
    } catch (error) {
      message.hidden = false;
      message.textContent = (error as Error).message;
      if (error instanceof SimulatorError) pointAt(error.message);
      return false;
    }
    message.hidden = true;
    return true;
  }
  private begin(info: SceneInfo, text: string, name: string) {
    this.info = info;
    [this.text, this.name] = [text, name];
    this.hand.forget();
    byId<HTMLTextAreaElement>('text').value = text;
    byId('subtitle').textContent = this.info.title || name;
    document.title = `${name} · Wunderlich`;
    this.simulator.refresh();
    const settings = this.simulator.settings();
    this.sliders.load(this.info, settings);
    this.plots.reset();
    this.stage.load(this.info, this.simulator.view(), this.simulator.solids(), this.info.strips.map((s) => s.segments + 1));
    this.owed = 0;
    this.meter = new Meter();
    this.setPlaying(true);
    this.say(this.info.failure, this.info.failure !== '');
    byId('kept').textContent = '';
  }

  /** The scene with other values of some keys. */
  private edit(overrides: string[]) {
    try {
      this.load(edited(this.simulator, this.text, this.name, [...this.sliders.overrides(this.info), ...overrides]), this.name);
    } catch (error) {
      this.say((error as Error).message, true);
    }
  }

  private say(text: string, bad = false) {
    const status = byId('status');
    if (status.textContent === text) return;
    status.textContent = text;
    status.title = text;
    status.classList.toggle('bad', bad);
  }
  private held() {
    if (!this.hand?.held) return;
    byId('hint').classList.add('gone');
  }

  // ---- time

  private setPlaying(on: boolean) {
    this.playing = on;
    const button = byId('play');
    button.innerHTML = on ? icons.pause : icons.play;
    button.setAttribute('aria-label', on ? 'Pause' : 'Play');
  }
  private toggle() { this.setPlaying(!this.playing); }

  /** One step of the motion, or of the path. */
  private oneStep() {
    this.setPlaying(false);
    if (this.simulator.onPath()) this.follow(1);
    else this.advance(this.info.step);
  }

  private follow(milliseconds: number) {
    const more = this.simulator.follow(milliseconds);
    this.simulator.refresh();
    if (more) {
      this.say(`On the way to rest: ${this.simulator.phase()}, ${Math.round(100 * this.simulator.numbers().share)} %`);
      return;
    }
    const failure = this.simulator.failure();
    if (this.simulator.onPath()) this.setPlaying(false);
    this.say(failure ? `No equilibrium: ${failure}` : 'At rest. Pull it.', failure !== '');
    this.stage.lookAt(this.simulator.view(), true);
  }

  /** Steps of the motion for so many seconds of it, as far as a frame allows. */
  private advance(seconds: number) {
    const { step } = this.info, start = performance.now();
    let left = seconds;
    while (left > 1e-9 * step) {
      const h = left < 1.5 * step ? left : step;
      const pulled = this.simulator.holds();
      const result = this.simulator.step(h);
      if (result === 'remark') {
        this.say(this.simulator.failure(), true);
        this.simulator.refresh();
        this.sliders.show(this.simulator.settings());
      } else if (result === 'failed') {
        const failure = this.simulator.failure();
        this.say(pulled ? `Let go: ${failure}` : failure, true);
        if (!pulled) this.setPlaying(false);
        break;
      }
      left -= h;
      if (performance.now() - start > budget) break;
    }
    this.behind += 0.05 * ((seconds - Math.max(0, left)) / seconds - this.behind);
  }

  /** A frame; one that fails pauses and says why, and the next one is asked for all the same. */
  tick(now: number) {
    requestAnimationFrame((time) => this.tick(time));
    try {
      this.frame(now);
    } catch (error) {
      this.setPlaying(false);
      this.say(`Paused: ${(error as Error).message}`, true);
    }
  }
  private frame(now: number) {
    const passed = Math.min(longest, (now - this.before) / 1000);
    const gap = now - this.before;
    this.before = now;
    const start = performance.now();
    if (this.playing) {
      if (this.simulator.onPath()) {
        this.follow(budget);
      } else {
        this.owed = passed * this.info.pace * this.speed();
        if (this.owed > 0) this.advance(this.owed);
      }
    }
    this.simulator.refresh();
    const middle = performance.now();
    this.show(now);
    const drawing = performance.now() - middle;
    this.meter.add(middle - start, drawing, gap);
    this.slowFrames = Math.max(drawing, gap - (middle - start)) > slow ? this.slowFrames + 1 : 0;
    if (this.slowFrames === patience) this.stage.plainly();
  }

  private show(now: number) {
    const view = this.simulator.view();
    this.stage.show(view);
    if (!this.hand.held) this.stage.follow(view);
    this.hand.mark();
    this.stage.draw();
    if (now - this.lastPlot < plotEvery) return;
    this.lastPlot = now;
    const strip = this.hand.held?.strip ?? 0;
    const before = this.info.strips.slice(0, strip).reduce((sum, s) => sum + s.segments + 1, 0);
    this.plots.show(view, before, this.info.strips[strip].segments + 1);
    showLegend(this.colour, this.stage.range);
    this.showFigures();
  }

  private showFigures() {
    const numbers = this.simulator.numbers(), path = this.simulator.onPath();
    byId('clock').textContent = path ? '' : quantity(Number(numbers.time.toPrecision(3)), 's', 3);
    showFigures(numbers, this.meter, path ? null : this.info.pace * this.speed() * this.behind);
    if (this.hand.held && !byId('status').classList.contains('bad')) {
      const { strip, node } = this.hand.held;
      this.say(`Holding node ${node} of ${this.info.strips[strip].segments}`);
    }
  }
  private speed(): number { return Number(byId<HTMLSelectElement>('speed').value); }

  // ---- controls

  connect() {
    this.connectScenes();
    this.connectTools();
    this.connectKeys();
    connectKeep(this.simulator, () => this.name, () => ({
      name: this.name, text: this.current(), colour: this.colour,
      rulings: byId('rulings').getAttribute('aria-pressed') === 'true',
    }));
    byId('play').addEventListener('click', () => this.toggle());
    byId('step').addEventListener('click', () => this.oneStep());
    byId('restart').addEventListener('click', () => this.load(this.text, this.name));
    byId('as-given').addEventListener('click', () => this.sliders.asGiven());
    const run = () => { this.load(byId<HTMLTextAreaElement>('text').value, this.name); };
    byId('run').addEventListener('click', run);
    addEventListener('hashchange', () => void this.open());
    byId('text').addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && (event.ctrlKey || event.metaKey)) run();
    });
  }

  private connectScenes() {
    const select = byId<HTMLSelectElement>('scene');
    const group = (label: string, wanted: boolean) => {
      const options = this.scenes.filter(({ text }) => /method:\s*equilibrium/.test(text) === wanted)
        .map(({ name }) => element('option', { value: name }, name));
      select.append(element('optgroup', { label }, ...options));
    };
    group('Equilibria', true);
    group('Motions', false);
    select.addEventListener('change', () => this.choose(select.value));
  }
  choose(name: string) {
    const scene = this.scenes.find((s) => s.name === name) ?? this.scenes[0];
    byId<HTMLSelectElement>('scene').value = scene.name;
    history.replaceState(null, '', location.pathname);
    this.load(scene.text, scene.name);
  }

  private connectTools() {
    const options: [Colour, string, string][] = [['none', 'paper', 'Paper'], ['kappa', 'κ', 'curvature'],
      ['tau', 'τ', 'torsion'], ['eta', 'η', 'ruling slope'], ['energy', 'energy', 'energy a length']];
    for (const [value, text, title] of options) {
      const input = element('input', { type: 'radio', name: 'colour', value, 'aria-label': title }) as HTMLInputElement;
      input.checked = value === 'none';
      input.addEventListener('change', () => this.setColour(value));
      byId('colours').append(element('label', { title }, input, element('span', {}, text)));
    }
    byId('rulings').addEventListener('click', () => this.setRulings(byId('rulings').getAttribute('aria-pressed') !== 'true'));
    byId('reset-view').addEventListener('click', () => this.stage.lookAt(this.simulator.view(), true));
    const dark = () => (document.documentElement.dataset.theme ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light')) === 'dark';
    const apply = () => {
      this.stage.setTheme(dark());
      document.dispatchEvent(new Event('themechange'));
    };
    byId('theme').addEventListener('click', () => {
      document.documentElement.dataset.theme = dark() ? 'light' : 'dark';
      apply();
    });
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', apply);
    apply();
  }
  private setColour(colour: Colour) {
    document.querySelector<HTMLInputElement>(`input[name=colour][value=${colour}]`)!.checked = true;
    this.stage.setColour(colour, this.simulator.view());
    this.colour = colour;
    showLegend(this.colour, this.stage.range);
  }
  private setRulings(on: boolean) {
    byId('rulings').setAttribute('aria-pressed', String(on));
    this.stage.setRulings(on);
  }

  private connectKeys() {
    const turn = Math.PI / 24, { hand, stage } = this;
    const pull = (right: number, up: number, towards: number, otherwise: () => void) => () => {
      if (hand.held) hand.moveBy(right * hand.step, up * hand.step, towards * hand.step);
      else otherwise();
    };
    const actions: Record<string, () => void> = {
      ArrowLeft: pull(-1, 0, 0, () => stage.turn(-turn, 0)), ArrowRight: pull(1, 0, 0, () => stage.turn(turn, 0)),
      ArrowUp: pull(0, 1, 0, () => stage.turn(0, turn)), ArrowDown: pull(0, -1, 0, () => stage.turn(0, -turn)),
      PageUp: pull(0, 0, -1, () => {}), PageDown: pull(0, 0, 1, () => {}),
      e: () => hand.choose(false), E: () => hand.choose(true), ',': () => hand.shift(-1), '.': () => hand.shift(1),
      Escape: () => hand.letGo(), q: () => hand.turn(-hand.keyTurn), w: () => hand.turn(hand.keyTurn),
      ' ': () => this.toggle(), s: () => this.oneStep(), r: () => this.load(this.text, this.name),
      '+': () => stage.zoom(0.9), '=': () => stage.zoom(0.9), '-': () => stage.zoom(1 / 0.9),
      Home: () => stage.lookAt(this.simulator.view(), true),
    };
    byId('view').addEventListener('keydown', (event) => {
      const action = actions[event.key];
      if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      byId('status').classList.remove('bad');
      action();
    });
  }

  /** The scene as it is now: its text with what the sliders say. */
  private current(): string {
    return edited(this.simulator, this.text, this.name, this.sliders.overrides(this.info));
  }

  /** The scene that the address holds, else the first; what is wrong with a link stands where the text is. */
  async open() {
    const link = location.hash;
    let wrong = '';
    const shared = await fromFragment(link).catch((error: Error) => {
      wrong = `The link holds no scene: ${error.message}`;
      return null;
    });
    if (shared && this.openShared(shared)) return;
    if (!this.info) this.choose(first);
    if (shared) {   // its text is kept, to be mended
      history.replaceState(null, '', link);
      byId<HTMLTextAreaElement>('text').value = shared.text;
      this.load(shared.text, shared.name);
    } else if (wrong) {
      Object.assign(byId('message'), { hidden: false, textContent: wrong });
    }
  }
  private openShared(shared: Shared): boolean {
    if (!this.load(shared.text, shared.name)) return false;
    byId<HTMLSelectElement>('scene').value = shared.name;
    if (shared.colour) this.setColour(shared.colour);
    this.setRulings(shared.rulings === true);
    return true;
  }

  /** Milliseconds a frame of 1/60 s while the far end is pulled to and fro: of the simulation, and until it is drawn. */
  private measure(frames: number): { simulate: number; draw: number } {
    const last = this.info.strips[0].segments, at = this.hand.position({ strip: 0, node: last });
    const reach = 0.1 * this.info.strips[0].length, sum = { simulate: 0, draw: 0 };
    this.simulator.grab(0, last);
    for (let k = 0; k < frames; ++k) {
      const start = performance.now();
      this.simulator.drag(at.x, at.y, at.z + reach * Math.sin(k / 8));
      this.advance(this.info.pace / 60);
      this.simulator.refresh();
      const middle = performance.now();
      this.stage.show(this.simulator.view());
      this.stage.draw();
      this.stage.finish();
      sum.simulate += middle - start;
      sum.draw += performance.now() - middle;
    }
    this.simulator.letGo();
    return { simulate: sum.simulate / frames, draw: sum.draw / frames };
  }

  /** For tests and the curious. */
  console() {
    return {
      nodes: () => Array.from(this.simulator.view().nodes),
      numbers: () => this.simulator.numbers(),
      settings: () => this.simulator.settings(),
      onPath: () => this.simulator.onPath(),
      holds: () => this.simulator.holds(),
      playing: () => this.playing,
      place: (strip: number, node: number) => this.stage.project(this.hand.position({ strip, node })),
      measure: (frames: number) => this.measure(frames),
      scene: () => ({ name: this.name, text: this.text }),
    };
  }
}

async function start() {
  const status = byId('status');
  try {
    const module = await WebAssembly.compileStreaming(fetch('wunderlich.wasm'));
    const simulator = await Simulator.start(module);
    const page = new Page(simulator, simulator.scenes());
    page.connect();
    await page.open();
    Object.assign(window, { wunderlich: page.console() });
    requestAnimationFrame((now) => page.tick(now));
    document.documentElement.dataset.ready = String(Math.round(performance.now()));
  } catch (error) {
    status.textContent = `This page could not start: ${(error as Error).message}`;
    status.classList.add('bad');
    throw error;
  }
}

void start();
