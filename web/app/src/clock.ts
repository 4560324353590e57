// Time: the path to rest, then the motion, as far as a frame allows.
import { byId } from '../../shared/format';
import type { SceneInfo, Simulator } from './simulator';

const budget = 11;        // milliseconds of a frame for the simulation
const longest = 0.05;     // seconds that a frame may be late

const icons = {
  play: '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M6 3.8v12.4L16.5 10z" fill="currentColor"/></svg>',
  pause: '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 4h3.6v12H5zm6.4 0H15v12h-3.6z" fill="currentColor"/></svg>',
};

/** What a clock tells: a line for the user, that the path has ended, that something was left undone. */
interface Listener { say(text: string, bad?: boolean): void; arrived(): void; remarked(): void }

export class Clock {
  playing = true;
  private behind = 1;   // share of the asked pace that is reached
  private info!: SceneInfo;

  constructor(private readonly simulator: Simulator, private readonly listener: Listener) {}

  load(info: SceneInfo) {
    this.info = info;
    this.play(true);
  }
  play(on: boolean) {
    this.playing = on;
    const button = byId('play');
    button.innerHTML = on ? icons.pause : icons.play;
    button.setAttribute('aria-label', on ? 'Pause' : 'Play');
  }
  toggle() { this.play(!this.playing); }

  private get speed(): number { return this.info.pace * Number(byId<HTMLSelectElement>('speed').value); }
  /** Seconds of the motion in a second; null on the path. */
  get pace(): number | null { return this.simulator.onPath() ? null : this.speed * this.behind; }

  /** What of `seconds` a frame allows. */
  run(seconds: number) {
    if (!this.playing) return;
    if (this.simulator.onPath()) this.follow(budget);
    else this.advance(Math.min(longest, seconds) * this.speed);
  }
  /** One step of the motion, or of the path. */
  step() {
    this.play(false);
    if (this.simulator.onPath()) this.follow(1);
    else this.advance(this.info.step);
  }

  private follow(milliseconds: number) {
    const { simulator, listener } = this, more = simulator.follow(milliseconds);
    simulator.refresh();
    if (more) {
      listener.say(`On the way to rest: ${simulator.phase()}`);
      return;
    }
    const failure = simulator.failure();
    if (simulator.onPath()) this.play(false);
    listener.say(failure ? `No equilibrium: ${failure}` : 'At rest. Pull it.', failure !== '');
    listener.arrived();
  }

  /** Steps of the motion for so many seconds of it. */
  advance(seconds: number) {
    if (!(seconds > 0)) return;
    const { simulator } = this, { step } = this.info, start = performance.now();
    let left = seconds;
    while (left > 1e-9 * step && performance.now() - start < budget) {
      const h = left < 1.5 * step ? left : step;
      if (!this.stepped(h)) break;
      left -= h;
    }
    simulator.refresh();
    this.behind += 0.05 * ((seconds - Math.max(0, left)) / seconds - this.behind);
  }
  private stepped(h: number): boolean {
    const { simulator, listener } = this, pulled = simulator.holds(), result = simulator.step(h);
    if (result === 'failed') {
      const failure = simulator.failure();
      listener.say(pulled ? `Let go; pulled faster than the strip follows: ${failure}` : failure, true);
      if (!pulled) this.play(false);
    } else if (result === 'remark') {
      listener.say(simulator.failure(), true);
    }
    if (result !== 'done') {
      simulator.refresh();
      listener.remarked();
    }
    return result !== 'failed';
  }
}
