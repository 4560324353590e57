// The moving ribbon in 3D.
import * as THREE from 'three';
import { diverging } from '../../shared/colour';
import { bestView, fitOf, frameAll, type Fit } from '../../shared/framing';
import {
  boundary, createControls, createFloor, createRenderer, createScene, lines, paint, ribbonMaterial, ribbonMesh, solidMesh,
  turnCamera, zoomCamera,
} from '../../shared/stage';
import type { SceneInfo, Solid, View } from './simulator';

export const colours = ['none', 'kappa', 'tau', 'eta', 'energy'] as const;
export type Colour = (typeof colours)[number];

const tooFar = 1.5, tooNear = 0.6;   // of the radius that the view was made for: the view follows

/** Light to dark, for what is never negative. */
function sequential(t: number): [number, number, number] {
  const s = Math.max(0, Math.min(1, t));
  return diverging(0.02 + 0.98 * s);
}

/** A value that all but two per cent stay below. */
function reach(values: Float32Array): number {
  const sizes = Float32Array.from(values, Math.abs).sort();
  return sizes[Math.floor(0.98 * (sizes.length - 1))] || sizes[sizes.length - 1] || 1;
}

interface Ribbon {
  mesh: THREE.Mesh; rims: Uint32Array; rimLines: THREE.LineSegments; rulingLines: THREE.LineSegments;
  nodeBefore: Uint32Array; share: Float32Array;   // for each point of the mesh
}

export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly camera = new THREE.PerspectiveCamera(32, 1, 0.02, 60);
  range = 1;   // of the colours
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene: THREE.Scene;
  private readonly body = new THREE.Group();
  private readonly solids = new THREE.Group();
  private readonly floor = createFloor();
  private readonly marker: THREE.Mesh<THREE.SphereGeometry, THREE.MeshBasicMaterial>;
  private readonly thread = lines(2, 0xb5451f, 0.9);   // from the hand to what it holds
  private readonly material = ribbonMaterial();
  readonly controls;
  private ribbon: Ribbon | null = null;
  private fit: Fit = { centre: new THREE.Vector3(), radius: 1, floor: 0 };
  private usual: ReturnType<typeof bestView> | null = null;
  private frame: { points: Float32Array; normals: Float32Array } | null = null;
  private untouched = true;
  private colour: Colour = 'none';
  private rulings = false;
  private oneSided = false;
  private plain = false;
  private info: SceneInfo | null = null;

  constructor(host: HTMLElement, onResize: () => void) {
    this.renderer = createRenderer(host);
    this.canvas = this.renderer.domElement;
    this.scene = createScene(this.renderer);
    this.camera.up.set(0, 0, 1);
    this.controls = createControls(this.camera, this.canvas);
    this.controls.addEventListener('start', () => { this.untouched = false; });
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), new THREE.MeshBasicMaterial({ color: 0xb5451f }));
    Object.assign(this.marker, { visible: false, renderOrder: 3 });
    this.thread.visible = false;
    this.body.add(this.solids, this.thread, this.marker);
    this.scene.add(this.body, this.floor);
    new ResizeObserver(() => {
      const { clientWidth, clientHeight } = host;
      if (!clientWidth || !clientHeight) return;
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      this.renderer.setSize(clientWidth, clientHeight);
      if (this.untouched) this.resetView();
      onResize();
    }).observe(host);
  }

  /** Another scene: its ribbon's mesh, its solids, and a view of both. */
  load(info: SceneInfo, view: View, solids: Solid[], nodesOfStrips: number[]) {
    this.info = info;
    if (this.ribbon) {
      for (const object of [this.ribbon.mesh, this.ribbon.rimLines, this.ribbon.rulingLines]) {
        this.body.remove(object);
        object.geometry.dispose();
      }
    }
    const count = view.points.length / 3, triangles = view.triangles.slice();
    const loop = info.strips.length === 1 && info.strips[0].loop;
    const mesh = ribbonMesh(count, triangles, this.material.material);
    const rims = boundary(triangles, view.u.slice(), loop);
    const rimLines = lines(rims.length, 0x2a1a12, 0.55), rulingLines = lines(view.rulings.length / 3, 0x2a1a12, 0.5);
    rulingLines.visible = this.rulings;
    this.ribbon = { mesh, rims, rimLines, rulingLines, ...weights(view, nodesOfStrips) };
    this.body.add(mesh, rimLines, rulingLines);
    this.oneSided = loop && Math.abs(info.strips[0].half_twists) % 2 === 1;
    this.solids.clear();
    for (const solid of solids) this.solids.add(solidMesh(solid.points, solid.normals, solid.triangles));
    this.show(view);
    this.lookAt(view, true);
  }

  /** The view is made anew for where the ribbon is now. */
  lookAt(view: View, fresh: boolean) {
    this.frame = { points: view.points.slice(), normals: view.normals.slice() };
    this.fit = this.wanted(view);
    if (fresh) this.usual = bestView(this.frame);
    if (fresh) this.untouched = true;
    this.place();
    if (this.untouched) this.resetView();
  }
  private wanted(view: View): Fit {
    const fit = fitOf([view.points]);
    return { ...fit, radius: Math.max(fit.radius, 0.25 * (this.info?.strips[0].length ?? 1)) };
  }

  /** Follows a ribbon that leaves the picture or becomes small in it; little by little. */
  follow(view: View) {
    const wanted = this.wanted(view), { fit } = this;
    const out = wanted.centre.distanceTo(fit.centre) + wanted.radius;
    if (out < tooFar * fit.radius && wanted.radius > tooNear * fit.radius) return;
    fit.centre.lerp(wanted.centre, 0.06);
    fit.radius += 0.06 * (wanted.radius - fit.radius);
    fit.floor += 0.06 * (wanted.floor - fit.floor);
    this.place();
  }
  private place() {
    const { centre, radius, floor } = this.fit;
    this.body.scale.setScalar(1 / radius);
    this.body.position.copy(centre).multiplyScalar(-1 / radius);
    this.floor.position.z = (floor - centre.z) / radius - 0.12;
    this.floor.visible = !this.plain && this.solids.children.length === 0;
    this.body.updateMatrixWorld(true);
  }

  show(view: View) {
    const { ribbon } = this;
    if (!ribbon) return;
    const attribute = (object: THREE.Mesh | THREE.LineSegments, name: string, values: Float32Array) => {
      const target = object.geometry.getAttribute(name) as THREE.BufferAttribute;
      (target.array as Float32Array).set(values);
      target.needsUpdate = true;
    };
    attribute(ribbon.mesh, 'position', view.points);
    attribute(ribbon.mesh, 'normal', view.normals);
    attribute(ribbon.rulingLines, 'position', view.rulings);
    const rim = ribbon.rimLines.geometry.getAttribute('position') as THREE.BufferAttribute;
    const out = rim.array as Float32Array;
    ribbon.rims.forEach((point, i) => {
      for (let c = 0; c < 3; ++c) out[3 * i + c] = view.points[3 * point + c];
    });
    rim.needsUpdate = true;
    this.solids.children.forEach((solid, i) => {
      solid.position.fromArray(view.poses, 7 * i);
      solid.quaternion.fromArray(view.poses, 7 * i + 3);
    });
    this.paintPoints(view);
  }

  private paintPoints(view: View) {
    const { mesh, nodeBefore, share } = this.ribbon!;
    const attribute = mesh.geometry.getAttribute('color') as THREE.BufferAttribute;
    const out = attribute.array as Float32Array, { colour } = this;
    this.material.material.color.set(colour === 'none' ? paint.front : 0xffffff);
    this.material.back.value.set(colour !== 'none' ? 0xffffff : this.oneSided ? paint.front : paint.back);
    if (colour === 'none') {
      if (out[0] !== 1 || out[out.length - 1] !== 1) { out.fill(1); attribute.needsUpdate = true; }
      return;
    }
    const field = view.fields[colour], map = colour === 'energy' ? sequential : diverging;
    const largest = reach(field);
    this.range = largest > this.range ? largest : this.range + 0.05 * (largest - this.range);
    const rgb = new THREE.Color();
    const painted = Array.from(field, (value) => rgb.setRGB(...map(value / this.range), THREE.SRGBColorSpace).toArray());
    for (let i = 0; i < nodeBefore.length; ++i) {
      const a = painted[nodeBefore[i]], b = painted[nodeBefore[i] + 1] ?? a;
      for (let c = 0; c < 3; ++c) out[3 * i + c] = a[c] + (b[c] - a[c]) * share[i];
    }
    attribute.needsUpdate = true;
  }

  setColour(colour: Colour, view: View) { this.colour = colour; this.range = 1e-9; this.show(view); }
  setRulings(visible: boolean) {
    this.rulings = visible;
    if (this.ribbon) this.ribbon.rulingLines.visible = visible;
  }
  setTheme(dark: boolean) {
    this.scene.environmentIntensity = dark ? 0.55 : 0.75;
    this.floor.material.opacity = dark ? 0.45 : 0.16;
  }

  resetView() {
    if (!this.frame || !this.usual) return;
    this.untouched = true;
    this.controls.target.copy(frameAll(this.camera, this.usual, [this.frame], [this.fit]));
    this.controls.update();
  }
  turn(right: number, up: number) {
    this.untouched = false;
    turnCamera(this.camera, this.controls, right, up);
  }
  zoom(factor: number) {
    this.untouched = false;
    zoomCamera(this.camera, this.controls, factor);
  }

  /** A point of the scene [m] in the picture, in CSS pixels from its corner. */
  project(point: THREE.Vector3): [number, number] {
    const p = this.body.localToWorld(point.clone()).project(this.camera);
    return [((p.x + 1) / 2) * this.canvas.clientWidth, ((1 - p.y) / 2) * this.canvas.clientHeight];
  }
  private sight(x: number, y: number): THREE.Raycaster {
    const { clientWidth, clientHeight } = this.canvas, ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.camera);
    return ray;
  }
  /** The node whose part of the ribbon is at a place in the picture. */
  hit(x: number, y: number): number | null {
    if (!this.ribbon) return null;
    const { mesh, nodeBefore, share } = this.ribbon;
    mesh.geometry.computeBoundingSphere();
    const [found] = this.sight(x, y).intersectObject(mesh);
    if (!found?.face) return null;
    return nodeBefore[found.face.a] + Math.round(share[found.face.a]);
  }
  /** Where the line of sight through a place in the picture meets the plane through a point, parallel to the picture. */
  unproject(x: number, y: number, through: THREE.Vector3): THREE.Vector3 {
    const normal = this.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, this.body.localToWorld(through.clone()));
    const hit = this.sight(x, y).ray.intersectPlane(plane, new THREE.Vector3());
    return hit ? this.body.worldToLocal(hit) : through.clone();
  }
  /** The picture's directions right, up and towards the eye, as directions of the scene. */
  axes(): [THREE.Vector3, THREE.Vector3, THREE.Vector3] {
    const [right, up, towards] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    this.camera.matrixWorld.extractBasis(right, up, towards);
    return [right, up, towards];
  }

  /** Marks a node, and the hand that pulls it. */
  mark(node: THREE.Vector3 | null, hand: THREE.Vector3 | null) {
    this.marker.visible = node !== null;
    this.thread.visible = node !== null && hand !== null;
    if (!node) return;
    this.marker.position.copy(node);
    this.marker.scale.setScalar(0.022 * this.fit.radius);
    if (!hand) return;
    const ends = this.thread.geometry.getAttribute('position') as THREE.BufferAttribute;
    ends.setXYZ(0, node.x, node.y, node.z);
    ends.setXYZ(1, hand.x, hand.y, hand.z);
    ends.needsUpdate = true;
  }

  /** Without shadows and shine, for machines that draw slowly. */
  plainly() {
    this.renderer.shadowMap.enabled = false;
    this.renderer.setPixelRatio(1);
    Object.assign(this.material.material, { sheen: 0, clearcoat: 0, needsUpdate: true });
    this.floor.visible = false;
    this.plain = true;
  }

  /** Waits until what was asked for is drawn. */
  finish() {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  draw() {
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
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
