// The ribbon's mesh and lines, as the simulator has them.
import * as THREE from 'three';
import { diverging } from '../../shared/colour';
import { boundary, lines, ribbonMesh } from '../../shared/stage';
import type { View } from './simulator';

export const colours = ['none', 'kappa', 'tau', 'eta', 'energy'] as const;
export type Colour = (typeof colours)[number];

/** Light to dark, for what is never negative. */
function sequential(t: number): [number, number, number] {
  const s = Math.max(0, Math.min(1, t));
  return diverging(0.02 + 0.98 * s);
}

/** A value that all but two per cent stay below. */
export function reach(values: Float32Array): number {
  const sizes = Float32Array.from(values, Math.abs).sort();
  return sizes[Math.floor(0.98 * (sizes.length - 1))] || sizes[sizes.length - 1] || 1;
}

const attribute = (object: THREE.Mesh | THREE.LineSegments, name: string) =>
  object.geometry.getAttribute(name) as THREE.BufferAttribute;

export class Ribbon {
  readonly group = new THREE.Group();
  readonly mesh: THREE.Mesh;
  readonly rulings: THREE.LineSegments;
  private readonly rims: Uint32Array;
  private readonly rimLines: THREE.LineSegments;
  private readonly nodeBefore: Uint32Array;   // for each point of the mesh
  private readonly share: Float32Array;

  constructor(view: View, loop: boolean, nodesOfStrips: number[], material: THREE.Material) {
    const triangles = view.triangles.slice();
    this.mesh = ribbonMesh(view.points.length / 3, triangles, material);
    this.rims = boundary(triangles, view.u.slice(), loop);
    this.rimLines = lines(this.rims.length, 0x2a1a12, 0.55);
    this.rulings = lines(view.rulings.length / 3, 0x2a1a12, 0.5);
    ({ nodeBefore: this.nodeBefore, share: this.share } = weights(view, nodesOfStrips));
    this.group.add(this.mesh, this.rimLines, this.rulings);
  }

  /** Has any point moved by more than so much [m] since it was shown? */
  moved({ points }: View, tolerance: number): boolean {
    const shown = attribute(this.mesh, 'position').array;
    return points.some((value, i) => Math.abs(value - shown[i]) > tolerance);
  }

  show(view: View) {
    const put = (object: THREE.Mesh | THREE.LineSegments, name: string, values: Float32Array) => {
      const target = attribute(object, name);
      (target.array as Float32Array).set(values);
      target.needsUpdate = true;
    };
    put(this.mesh, 'position', view.points);
    put(this.mesh, 'normal', view.normals);
    put(this.rulings, 'position', view.rulings);
    const rim = attribute(this.rimLines, 'position'), out = rim.array as Float32Array;
    this.rims.forEach((point, i) => {
      for (let c = 0; c < 3; ++c) out[3 * i + c] = view.points[3 * point + c];
    });
    rim.needsUpdate = true;
  }

  /** White, to be coloured by the material alone. */
  whiten() {
    const colour = attribute(this.mesh, 'color'), out = colour.array as Float32Array;
    if (out[0] === 1 && out[out.length - 1] === 1) return;
    out.fill(1);
    colour.needsUpdate = true;
  }
  /** By a field of the nodes, whose largest value has the last colour. */
  paint(field: Float32Array, signed: boolean, range: number) {
    const { nodeBefore, share } = this, map = signed ? diverging : sequential;
    const colour = attribute(this.mesh, 'color'), out = colour.array as Float32Array;
    const rgb = new THREE.Color();
    const painted = Array.from(field, (value) => rgb.setRGB(...map(value / range), THREE.SRGBColorSpace).toArray());
    for (let i = 0; i < nodeBefore.length; ++i) {
      const a = painted[nodeBefore[i]], b = painted[nodeBefore[i] + 1] ?? a;
      for (let c = 0; c < 3; ++c) out[3 * i + c] = a[c] + (b[c] - a[c]) * share[i];
    }
    colour.needsUpdate = true;
  }

  /** The node whose part of the ribbon a ray meets first. */
  hit(ray: THREE.Raycaster): number | null {
    this.mesh.geometry.computeBoundingSphere();
    const [found] = ray.intersectObject(this.mesh);
    if (!found?.face) return null;
    return this.nodeBefore[found.face.a] + Math.round(this.share[found.face.a]);
  }

  /** All but the material of the mesh, which others go on with. */
  dispose() {
    this.group.removeFromParent();
    this.mesh.geometry.dispose();
    for (const object of [this.rimLines, this.rulings]) {
      object.geometry.dispose();
      (object.material as THREE.Material).dispose();
    }
  }
}

/** For each point of the mesh the node before it and the share of the next one; strips follow one another in both. */
function weights(view: View, nodesOfStrips: number[]): { nodeBefore: Uint32Array; share: Float32Array } {
  const nodeBefore = new Uint32Array(view.u.length), share = new Float32Array(view.u.length);
  const u = view.fields.u;
  let first = 0, strip = 0, k = 0;
  for (let i = 0; i < view.u.length; ++i) {
    if (i > 0 && view.u[i] < view.u[i - 1] - 1e-12 && strip + 1 < nodesOfStrips.length) {   // the next strip begins
      first += nodesOfStrips[strip++];
      k = first;
    }
    const last = first + nodesOfStrips[strip] - 2;
    while (k < last && u[k + 1] <= view.u[i]) ++k;
    nodeBefore[i] = k;
    share[i] = Math.max(0, Math.min(1, (view.u[i] - u[k]) / (u[k + 1] - u[k])));
  }
  return { nodeBefore, share };
}
