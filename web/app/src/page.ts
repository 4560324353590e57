// The page: a scene, a hand, a clock, and a picture of them.
import { byId, quantity } from '../../shared/format';
import { Clock } from './clock';
import { Meter, showFigures, showLegend } from './figures';
import { Hand, type Held } from './hand';
import { LivePlots } from './plots';
import { drawsInSoftware, looks, Quality } from './quality';
import type { Colour } from './ribbon';
import { edited, pointAt } from './scene_text';
import { fromFragment, type Shared } from './share';
import { SimulatorError, type SceneInfo, type ShippedScene, type Simulator } from './simulator';
import { Sliders } from './sliders';
import { Stage } from './stage';

const plotsAfter = 20;    // drawings of the plots after the ribbon has come to rest: their ranges narrow
const first = 'moebius';

export class Page {
  info!: SceneInfo;
  name = '';
  text = '';
  rulings = false;
  colour: Colour = 'none';
  readonly quality: Quality;
  readonly stage: Stage;
  readonly clock: Clock;
  readonly hand: Hand;
  readonly sliders: Sliders;
  private readonly plots = new LivePlots();
  private meter = new Meter();
  private before = 0;       // when the last frame was
  private judged = false;   // was it drawn as what moves is
  private simulated = 0;    // milliseconds of it
  private look = looks[0];
  private lastPlot = 0;
  private plotsLeft = 0;
  private holding: Held | null = null;

  constructor(readonly simulator: Simulator, private readonly scenes: ShippedScene[]) {
    const software = drawsInSoftware();
    this.quality = new Quality(software);
    this.stage = new Stage(byId('view'), !software);
    this.clock = new Clock(simulator, {
      say: (text, bad) => this.say(text, bad), arrived: () => this.resetView(),
      remarked: () => this.sliders.show(simulator.settings()),
    });
    this.hand = new Hand(simulator, this.stage, () => this.info.strips, () => this.held());
    this.sliders = new Sliders((settings) => {
      simulator.set(settings);
      simulator.refresh();
      if (!simulator.onPath()) this.say('');
    }, (halfTwists) => this.edit([`ribbon.half_twists=${halfTwists}`]));
  }

  // ---- scenes

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
    Object.assign(this, { info, text, name });
    this.hand.forget();
    byId<HTMLTextAreaElement>('text').value = text;
    byId('subtitle').textContent = info.title || name;
    document.title = `${name} · Wunderlich`;
    this.simulator.refresh();
    this.sliders.load(info, this.simulator.settings());
    this.plots.reset();
    this.stage.load(info, this.simulator.view(), this.simulator.solids(), info.strips.map((s) => s.segments + 1));
    this.meter = new Meter();
    this.clock.load(info);
    this.say(info.failure, info.failure !== '');
    byId('kept').textContent = '';
  }
  restart() { this.load(this.text, this.name); }

  choose(name: string) {
    const scene = this.scenes.find((s) => s.name === name) ?? this.scenes[0];
    byId<HTMLSelectElement>('scene').value = scene.name;
    history.replaceState(null, '', location.pathname);
    this.load(scene.text, scene.name);
  }

  /** The scene as it is now: its text with what the sliders say. */
  current(): string { return this.withKeys(this.sliders.overrides(this.info)); }
  private withKeys(overrides: string[]): string { return edited(this.simulator, this.text, this.name, overrides); }
  /** The scene with other values of some keys. */
  private edit(overrides: string[]) {
    try {
      this.load(this.withKeys([...this.sliders.overrides(this.info), ...overrides]), this.name);
    } catch (error) {
      this.say((error as Error).message, true);
    }
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
    if (shared.settings) this.sliders.put(shared.settings);
    byId<HTMLSelectElement>('scene').value = shared.name;
    if (shared.colour) this.setColour(shared.colour);
    this.setRulings(shared.rulings === true);
    return true;
  }

  // ---- what is said and seen

  /** In the line that is read out: nothing that changes with every frame. */
  say(text: string, bad = false) {
    const status = byId('status');
    if (status.textContent === text) return;
    status.textContent = text;
    status.title = text;
    status.classList.toggle('bad', bad);
  }
  /** The hand has taken hold, let go, or moved. */
  private held() {
    const now = this.hand?.held ?? null;
    if (now === this.holding) return;
    this.holding = now;
    if (now) {
      byId('hint').classList.add('gone');
      this.say(`Holding node ${now.node} of ${this.info.strips[now.strip].segments}`);
    } else if (!byId('status').classList.contains('bad')) {
      this.say('');
    }
  }

  setColour(colour: Colour) {
    document.querySelector<HTMLInputElement>(`input[name=colour][value=${colour}]`)!.checked = true;
    this.stage.setColour(colour, this.simulator.view());
    this.colour = colour;
    showLegend(this.colour, this.stage.range);
  }
  setRulings(on: boolean) {
    byId('rulings').setAttribute('aria-pressed', String(on));
    this.rulings = on;
    this.stage.setRulings(on);
  }
  resetView() { this.stage.lookAt(this.simulator.view(), true); }

  // ---- frames

  /** A frame; one that fails pauses and says why, and the next one is asked for all the same. */
  tick(now: number) {
    requestAnimationFrame((time) => this.tick(time));
    try {
      this.frame(now);
    } catch (error) {
      this.clock.play(false);
      this.say(`Paused: ${(error as Error).message}`, true);
    }
  }
  private frame(now: number) {
    const gap = now - this.before, start = performance.now();
    this.before = now;
    if (this.judged) this.quality.took(gap - this.simulated);
    this.clock.run(gap / 1000);
    const middle = performance.now();
    const moves = this.draw();
    this.simulated = middle - start;
    this.meter.add(this.simulated, performance.now() - middle, gap);
    if (now - this.lastPlot < this.look.numbers) return;
    this.lastPlot = now;
    this.showNumbers(moves);
  }

  /** Draws what is new. Does anything move? */
  private draw(): boolean {
    const { stage, hand } = this, view = this.simulator.view();
    stage.show(view);
    if (!hand.held) stage.follow(view);
    hand.mark();
    const moves = stage.moves();
    this.look = this.quality.look(moves);
    stage.setLook(this.look);
    this.judged = stage.draw() && moves;
    if (moves) this.plotsLeft = plotsAfter;
    return moves;
  }

  private showNumbers(moves: boolean) {
    if (this.plotsLeft > 0) {
      --this.plotsLeft;
      const strip = this.hand.held?.strip ?? 0, counts = this.info.strips.map((s) => s.segments + 1);
      this.plots.show(this.simulator.view(), counts.slice(0, strip).reduce((sum, count) => sum + count, 0), counts[strip]);
      showLegend(this.colour, this.stage.range);
    }
    if (!this.clock.playing && !moves && this.plotsLeft === 0) return;
    const numbers = this.simulator.numbers(), { pace } = this.clock;
    byId('clock').textContent = pace === null ? `${Math.round(100 * numbers.share)}\u202f%`
      : quantity(Number(numbers.time.toPrecision(3)), 's', 3);
    showFigures(numbers, this.meter, pace);
  }
}
