// The models stored in the page of a comparison, unpacked.
import { body, bytes, normals, points, type Frame, type Run } from './data';

export interface ModelRun {
  model: string; method: string; resolution: string; converged: boolean; failure?: string; notes?: string[];
  unknowns: number; constraints: number; phases_us?: Record<string, number>;
  // Those of a shape, and of steps, are null where the model never moved.
  normalized: number | null; elastic: number | null; kinetic: number | null; gravity: number | null;
  area_error: number | null; diagonal_strain: number | null; rim_stretch: number | null;
  imbalance: number | null;  // of what says that it is at rest
  length_error: number | null; missed_steps: number | null;
  steps: number | null; step_us_median: number | null; wall_seconds: number | null;
  moved_seconds: number | null; wall_per_second: number | null;
  run: Run;
}

export interface Models {
  scene: string; title: string; text: string; program: string; version: string;
  models: ModelRun[];
}

const none = new Float32Array(0);

// eslint-disable-next-line @typescript-eslint/no-explicit-any
function frame(raw: any, low: number[], scale: number): Frame {
  return {
    time: raw.time, points: points(raw.points, low, scale), normals: normals(raw.normals),
    rulings: none, fields: { kappa: none, tau: none, eta: none },
  };
}

/** What the viewer needs of a run; tables of runs are not shown here. */
// eslint-disable-next-line @typescript-eslint/no-explicit-any
function runOf(raw: any): Run {
  return {
    triangles: new Uint32Array(bytes(raw.triangles)), pointU: null, u: none,
    frames: raw.frames_shown.map((f: unknown) => frame(f, raw.low, raw.scale)),
    bodies: raw.bodies.map(body),
    summary: { closure_error: undefined, topology: { twist: 0, writhe: 0, link: 0 } },
  } as unknown as Run;
}

export function readModels(text: string): Models {
  const raw = JSON.parse(text);
  // eslint-disable-next-line @typescript-eslint/no-explicit-any
  return { ...raw, models: raw.models.map((model: any) => ({ ...model, run: runOf(model) })) };
}
