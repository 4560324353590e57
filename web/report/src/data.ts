// The run stored in the page, unpacked.
import type { FieldName } from '../../shared/colour';

export interface Summary {
  program: string; version: string; scene: string; model: string; method: string;
  converged: boolean; failure?: string; segments: number; time: number; steps: number;
  energy: { elastic: number; kinetic: number; gravity: number; total: number; normalized: number };
  constraints: {
    max_length_error: number; max_parallel_error: number; max_binormal: number;
    max_torsion_mismatch: number; max_ruling_ratio: number;
  };
  area_error: number;
  timing: {
    wall_seconds: number; step_us_median: number; step_us_p95: number; iterations_mean: number;
    phases?: { name: string; seconds: number }[];
  };
  closure_error?: number;
  ends: { force: number[]; torque: number[] }[];
  stability?: { stable: boolean; negative_modes: number };
  topology: { twist: number; writhe: number; link: number };
  contact?: { count: number; max_penetration: number; minimum_distance: number };
  kappa_zeros: number[];
  warnings: string[];
}

export type { FieldName };

export interface Frame {
  time: number;
  points: Float32Array;    // x, y, z of each mesh point [m]
  normals: Float32Array;
  rulings: Float32Array;   // both ends of each node's ruling [m]
  fields: Record<FieldName, Float32Array>;   // by node
}

export interface History {
  time: number[]; elastic: number[]; kinetic: number[]; gravity: number[]; total: number[]; normalized: number[];
  length: number[]; torsion: number[]; ruling: number[]; area: number[]; iterations: number[]; step_us: number[];
}

/** An obstacle: a mesh in its own frame, and where that stands. */
export interface Body {
  points: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
  poses: Float32Array;   // x, y, z and quaternion x, y, z, w for each frame
}

export interface Run {
  title: string;
  summary: Summary;
  parameters: [string, string][];
  scene: string;
  length: number;
  width: number;
  history: History;
  recordedFrames: number;
  triangles: Uint32Array;
  pointU: Float32Array | null;   // arc length of each mesh point; absent for models without a centerline
  u: Float32Array;               // arc length of each node [m]
  frames: Frame[];
  bodies: Body[];
}

export function bytes(text: string): ArrayBuffer {
  const binary = atob(text);
  const out = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) out[i] = binary.charCodeAt(i);
  return out.buffer;
}

const floats = (text: string) => new Float32Array(bytes(text));

export function points(text: string, low: number[], scale: number): Float32Array {
  const packed = new Uint16Array(bytes(text));
  const out = new Float32Array(packed.length);
  for (let i = 0; i < packed.length; ++i) out[i] = low[i % 3] + scale * packed[i];
  return out;
}

/** The octahedral map, undone. */
export function normals(text: string): Float32Array {
  const packed = new Int16Array(bytes(text));
  const count = packed.length / 2;
  const out = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    let x = packed[2 * i] / 32767, y = packed[2 * i + 1] / 32767;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) {
      const fold = x;
      x = (1 - Math.abs(y)) * (x < 0 ? -1 : 1);
      y = (1 - Math.abs(fold)) * (y < 0 ? -1 : 1);
    }
    const norm = Math.hypot(x, y, z);
    out.set([x / norm, y / norm, z / norm], 3 * i);
  }
  return out;
}

// eslint-disable-next-line @typescript-eslint/no-explicit-any
function frame(raw: any, low: number[], scale: number): Frame {
  return {
    time: raw.time,
    points: points(raw.points, low, scale),
    normals: normals(raw.normals),
    rulings: points(raw.rulings, low, scale),
    fields: { kappa: floats(raw.kappa), tau: floats(raw.tau), eta: floats(raw.eta) },
  };
}

// eslint-disable-next-line @typescript-eslint/no-explicit-any
export function body(raw: any): Body {
  return {
    points: floats(raw.points),
    normals: floats(raw.normals),
    triangles: new Uint32Array(bytes(raw.triangles)),
    poses: floats(raw.poses),
  };
}

export function readRun(text: string): Run {
  const raw = JSON.parse(text);
  return {
    title: raw.title,
    summary: raw.summary,
    parameters: raw.parameters,
    scene: raw.scene,
    length: raw.length,
    width: raw.width,
    history: raw.history,
    recordedFrames: raw.recorded_frames,
    triangles: new Uint32Array(bytes(raw.mesh.triangles)),
    pointU: raw.mesh.u ? floats(raw.mesh.u) : null,
    u: floats(raw.u),
    frames: raw.frames.map((f: unknown) => frame(f, raw.low, raw.scale)),
    bodies: raw.bodies.map(body),
  };
}

/** Whether passing once along the ribbon turns it over: a Moebius strip has one side. */
export function isOneSided(run: Run): boolean {
  return run.summary.closure_error !== undefined && Math.abs(Math.round(2 * run.summary.topology.link)) % 2 === 1;
}

/** A value that all but two per cent of the field stay below, so that a spike does not wash out the rest. */
export function fieldRange(frames: Frame[], name: FieldName): number {
  const sizes: number[] = [];
  for (const frame of frames) for (const value of frame.fields[name]) sizes.push(Math.abs(value));
  sizes.sort((a, b) => a - b);
  return sizes[Math.floor(0.98 * (sizes.length - 1))] || sizes[sizes.length - 1] || 1;
}
