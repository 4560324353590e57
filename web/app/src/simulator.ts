// The simulator: WebAssembly with plain functions, and arrays that are read where they lie in its memory.

export interface Strip {
  segments: number; length: number; width: number; loop: boolean; half_twists: number; name: string;
  supports: number[];   // nodes
}

export interface SceneInfo {
  name: string; title: string; text: string; resolved: string; on_path: boolean; pace: number; step: number;
  failure: string; strips: Strip[];
}

export interface ShippedScene { name: string; title: string; text: string }

export interface Settings {
  length: number; width: number; stiffness: number; twist: number; damping: number;
  gravity: [number, number, number];
}

export interface Numbers {
  time: number; elastic: number; kinetic: number; gravity: number; normalized: number;
  area_error: number; torsion_error: number; ruling_ratio: number; iterations: number; step_us: number; share: number;
}

/** Arrays of the last refresh; valid until the next call. */
export interface View {
  points: Float32Array; normals: Float32Array; u: Float32Array; rulings: Float32Array; triangles: Uint32Array;
  nodes: Float32Array;
  fields: { u: Float32Array; kappa: Float32Array; tau: Float32Array; eta: Float32Array; energy: Float32Array };
  poses: Float32Array;
}

export interface Solid { points: Float32Array; normals: Float32Array; triangles: Uint32Array; poses: Float32Array }

/** The reader's message, or another failure of a call. */
export class SimulatorError extends Error {}

type Call = (...values: number[]) => number;

const notThere = 52;   // WASI's ENOSYS

/** What the module asks of its host: a clock. It opens no files and prints nothing. */
function host(module: WebAssembly.Module, memory: () => DataView): WebAssembly.Imports {
  const known: Record<string, (...values: never[]) => unknown> = {
    clock_time_get: (_id: number, _precision: bigint, where: number) => {
      memory().setBigUint64(where, BigInt(Math.round(1e6 * performance.now())), true);
      return 0;
    },
    environ_sizes_get: (count: number, size: number) => {
      memory().setUint32(count, 0, true);
      memory().setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
    emscripten_notify_memory_growth: () => {},
    proc_exit: () => { throw new SimulatorError('the simulator has stopped'); },
  };
  const imports: Record<string, Record<string, WebAssembly.ImportValue>> = {};
  for (const { module: group, name, kind } of WebAssembly.Module.imports(module)) {
    if (kind === 'function') (imports[group] ??= {})[name] = (known[name] ?? (() => notThere)) as WebAssembly.ImportValue;
  }
  return imports;
}

export class Simulator {
  private readonly call: Record<string, Call>;
  private readonly memory: WebAssembly.Memory;

  private constructor(instance: WebAssembly.Instance) {
    this.call = instance.exports as unknown as Record<string, Call>;
    this.memory = instance.exports.memory as WebAssembly.Memory;
    this.call._initialize();
  }

  static async start(module: WebAssembly.Module): Promise<Simulator> {
    let instance: WebAssembly.Instance | null = null;
    const memory = () => new DataView((instance!.exports.memory as WebAssembly.Memory).buffer);
    instance = await WebAssembly.instantiate(module, host(module, memory));
    return new Simulator(instance);
  }

  private give(text: string) {
    const bytes = new TextEncoder().encode(text);
    const where = this.call.wl_input(bytes.length);
    new Uint8Array(this.memory.buffer, where, bytes.length).set(bytes);
  }
  private answerBytes(): Uint8Array<ArrayBuffer> {
    const where = this.call.wl_answer();
    return new Uint8Array(this.memory.buffer.slice(where, where + this.call.wl_answer_size()) as ArrayBuffer);
  }
  private answer(): string { return new TextDecoder().decode(this.answerBytes()); }
  private done(done: number) {
    if (!done) throw new SimulatorError(this.answer());
  }
  private asked(done: number): string {
    this.done(done);
    return this.answer();
  }

  scenes(): ShippedScene[] { this.call.wl_scenes(); return JSON.parse(this.answer()); }

  /** Starts a scene; throws the reader's message, and then the scene before goes on. */
  load(text: string, name: string, overrides: string[] = []): SceneInfo {
    this.give(JSON.stringify({ text, name, overrides }));
    return JSON.parse(this.asked(this.call.wl_load()));
  }
  /** The scene with its overrides written out. */
  resolve(text: string, name: string, overrides: string[]): string {
    this.give(JSON.stringify({ text, name, overrides }));
    return this.asked(this.call.wl_resolve());
  }

  onPath(): boolean { return this.call.wl_on_path() === 1; }
  follow(milliseconds: number): boolean { return this.call.wl_follow(milliseconds) === 1; }
  /** `remark`: something else could not be done, see `failure`. */
  step(seconds: number): 'failed' | 'done' | 'remark' {
    return (['failed', 'done', 'remark'] as const)[this.call.wl_step(seconds)];
  }
  failure(): string { this.call.wl_failure(); return this.answer(); }
  phase(): string { this.call.wl_phase(); return this.answer(); }
  /** What the program writes as summary.json; of the path when it is over. */
  // eslint-disable-next-line @typescript-eslint/no-explicit-any
  summary(): any { return JSON.parse(this.asked(this.call.wl_summary())); }
  refresh() { this.done(this.call.wl_refresh()); }

  set(s: Settings) { this.done(this.call.wl_set(s.length, s.width, s.stiffness, s.twist, s.damping, ...s.gravity)); }
  grab(strip: number, node: number) { this.call.wl_grab(strip, node); }
  drag(x: number, y: number, z: number) { this.call.wl_drag(x, y, z); }
  turn(angle: number) { this.call.wl_turn(angle); }
  letGo() { this.call.wl_let_go(); }
  holds(): boolean { return this.call.wl_holds() === 1; }

  private array<T>(which: number, of: new (buffer: ArrayBuffer, offset: number, size: number) => T): T {
    return new of(this.memory.buffer as ArrayBuffer, this.call.wl_array(which), this.call.wl_array_size(which));
  }
  view(): View {
    const floats = (which: number) => this.array(which, Float32Array);
    return {
      points: floats(0), normals: floats(1), u: floats(2), rulings: floats(3), triangles: this.array(4, Uint32Array),
      nodes: floats(5),
      fields: { u: floats(6), kappa: floats(7), tau: floats(8), eta: floats(9), energy: floats(10) },
      poses: floats(13),
    };
  }
  private all(): Float64Array { return this.array(16, Float64Array); }
  numbers(): Numbers {
    const [time, elastic, kinetic, gravity, normalized, area_error, torsion_error, ruling_ratio, iterations, step_us,
      share] = this.all();
    return { time, elastic, kinetic, gravity, normalized, area_error, torsion_error, ruling_ratio, iterations, step_us, share };
  }
  settings(): Settings {
    const [length, width, stiffness, twist, damping, x, y, z] = this.all().subarray(11);
    return { length, width, stiffness, twist, damping, gravity: [x, y, z] };
  }
  /** Copies; each solid stands at the first of its poses. */
  solids(): Solid[] {
    const points = this.array(11, Float32Array), normals = this.array(12, Float32Array);
    const triangles = this.array(14, Uint32Array), sizes = this.array(15, Uint32Array), poses = this.array(13, Float32Array);
    const out: Solid[] = [];
    for (let i = 0, p = 0, t = 0; i < sizes.length; i += 2) {
      const [np, nt] = [3 * sizes[i], 3 * sizes[i + 1]];
      out.push({
        points: points.slice(p, p + np), normals: normals.slice(p, p + np), triangles: triangles.slice(t, t + nt),
        poses: poses.slice(7 * (i / 2), 7 * (i / 2) + 7),
      });
      p += np;
      t += nt;
    }
    return out;
  }

  glb(): Uint8Array<ArrayBuffer> { return this.bytes(this.call.wl_glb()); }
  pattern(): Uint8Array<ArrayBuffer> { return this.bytes(this.call.wl_pattern()); }
  private bytes(done: number): Uint8Array<ArrayBuffer> {
    this.done(done);
    return this.answerBytes();
  }
}
