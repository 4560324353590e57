// The moving ribbon in 3D.
import * as THREE from 'three';
import { bestView, fitOf, frameAll, type Fit } from '../../shared/framing';
import {
  createControls, createFloor, createRenderer, createScene, lines, mattMaterial, paint, ribbonMaterial, solidMesh, turnCamera,
  zoomCamera,
} from '../../shared/stage';
import type { Look } from './quality';
import { reach, Ribbon, type Colour } from './ribbon';
import type { SceneInfo, Solid, View } from './simulator';

const tooFar = 1.5, tooNear = 0.6;   // of the radius that the view was made for: the view follows
const seen = 2e-4;                   // of that radius: less is no motion; a tenth of a pixel
const narrowing = 0.05;              // of the colours' range, in a frame
const skyLight = 5.5;                // about as light as the room

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
  private readonly fine = ribbonMaterial();
  private readonly matt = mattMaterial(this.fine.back);
  private readonly room: THREE.Texture;
  private readonly sky = new THREE.HemisphereLight(0xffffff, 0xb8ada0, skyLight);   // in place of the room
  private readonly lamp: THREE.DirectionalLight;
  readonly controls;
  private ribbon: Ribbon | null = null;
  private fit: Fit = { centre: new THREE.Vector3(), radius: 1, floor: 0 };
  private usual: ReturnType<typeof bestView> | null = null;
  private frame: { points: Float32Array; normals: Float32Array } | null = null;
  private untouched = true;
  private colour: Colour = 'none';
  private rulings = false;
  private oneSided = false;
  private look: Look | null = null;
  private changed = true;   // since it was drawn
  private info: SceneInfo | null = null;

  constructor(host: HTMLElement, private readonly antialias: boolean) {
    this.renderer = createRenderer(host, antialias);
    this.canvas = this.renderer.domElement;
    this.scene = createScene(this.renderer);
    this.room = this.scene.environment!;
    this.lamp = this.scene.getObjectByProperty('isDirectionalLight', true) as THREE.DirectionalLight;
    this.camera.up.set(0, 0, 1);
    this.sky.position.set(0, 0, 1);
    this.controls = createControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => { this.changed = true; });
    this.controls.addEventListener('start', () => { this.untouched = false; });
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), new THREE.MeshBasicMaterial({ color: 0xb5451f }));
    Object.assign(this.marker, { visible: false, renderOrder: 3 });
    this.thread.visible = false;
    this.body.add(this.solids, this.thread, this.marker);
    this.scene.add(this.body, this.floor, this.sky);
    new ResizeObserver(() => {
      const { clientWidth, clientHeight } = host;
      if (!clientWidth || !clientHeight) return;
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      this.renderer.setSize(clientWidth, clientHeight);
      this.changed = true;
      if (this.untouched) this.resetView();
    }).observe(host);
  }

  /** Another scene: its ribbon's mesh, its solids, and a view of both. */
  load(info: SceneInfo, view: View, solids: Solid[], nodesOfStrips: number[]) {
    this.info = info;
    this.ribbon?.dispose();
    for (const solid of [...this.solids.children] as ReturnType<typeof solidMesh>[]) {
      solid.removeFromParent();
      solid.geometry.dispose();
      solid.material.dispose();
    }
    const loop = info.strips.length === 1 && info.strips[0].loop;
    this.oneSided = loop && Math.abs(info.strips[0].half_twists) % 2 === 1;
    this.ribbon = new Ribbon(view, loop, nodesOfStrips, this.look?.fine === false ? this.matt : this.fine.material);
    this.ribbon.rulings.visible = this.rulings;
    this.body.add(this.ribbon.group);
    for (const solid of solids) this.solids.add(solidMesh(solid.points, solid.normals, solid.triangles));
    [this.range, this.changed] = [1e-9, true];
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

  /** Follows a ribbon that leaves the picture or becomes small in it: little by little, and the farther out the faster. */
  follow(view: View) {
    const wanted = this.wanted(view), { fit } = this;
    const out = wanted.centre.distanceTo(fit.centre) + wanted.radius;
    if (out < tooFar * fit.radius && wanted.radius > tooNear * fit.radius) return;
    const share = Math.min(1, 0.06 + 0.5 * Math.max(0, out / fit.radius - tooFar));
    fit.centre.lerp(wanted.centre, share);
    fit.radius += share * (wanted.radius - fit.radius);
    fit.floor += share * (wanted.floor - fit.floor);
    this.place();
  }
  private place() {
    const { centre, radius, floor } = this.fit;
    this.body.scale.setScalar(1 / radius);
    this.body.position.copy(centre).multiplyScalar(-1 / radius);
    this.floor.position.z = (floor - centre.z) / radius - 0.12;
    this.floor.visible = this.look?.shadows !== false && this.solids.children.length === 0;
    this.body.updateMatrixWorld(true);
    this.changed = true;
  }

  /** Takes over where everything is, if anything has moved so far that it is seen. */
  show(view: View) {
    const { ribbon } = this;
    if (!ribbon) return;
    if (this.follows(view) || ribbon.moved(view, seen * this.fit.radius) || this.solidsMoved(view)) this.changed = true;
    if (!this.changed) return;
    ribbon.show(view);
    this.solids.children.forEach((solid, i) => {
      solid.position.fromArray(view.poses, 7 * i);
      solid.quaternion.fromArray(view.poses, 7 * i + 3);
    });
    this.paint(view);
  }
  private solidsMoved({ poses }: View): boolean {
    const shown = this.solids.children.flatMap(({ position, quaternion }) => [...position.toArray(), ...quaternion.toArray()]);
    return shown.some((value, i) => Math.abs(value - poses[i]) > seen * (i % 7 < 3 ? this.fit.radius : 1));
  }
  /** The range of the colours, which widens at once and narrows little by little. Has it changed? */
  private follows({ fields }: View): boolean {
    const { colour, range } = this;
    if (colour === 'none') return false;
    const largest = reach(fields[colour]);
    if (largest <= range && largest > 0.99 * range) return false;
    this.range = largest > range ? largest : range + narrowing * (largest - range);
    return true;
  }
  private paint(view: View) {
    const { colour, ribbon } = this, white = colour !== 'none';
    for (const material of [this.fine.material, this.matt]) material.color.set(white ? 0xffffff : paint.front);
    this.fine.back.value.set(white ? 0xffffff : this.oneSided ? paint.front : paint.back);
    if (colour === 'none') ribbon!.whiten();
    else ribbon!.paint(view.fields[colour], colour !== 'energy', this.range);
  }

  setColour(colour: Colour, view: View) {
    [this.colour, this.range, this.changed] = [colour, 1e-9, true];
    this.show(view);
  }
  setRulings(visible: boolean) {
    [this.rulings, this.changed] = [visible, true];
    if (this.ribbon) this.ribbon.rulings.visible = visible;
  }
  setTheme(dark: boolean) {
    this.changed = true;
    this.scene.environmentIntensity = dark ? 0.55 : 0.75;
    this.sky.intensity = skyLight * this.scene.environmentIntensity;
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
    return this.ribbon?.hit(this.sight(x, y)) ?? null;
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
    const ends = this.thread.geometry.getAttribute('position') as THREE.BufferAttribute;
    const near = (i: number, place: THREE.Vector3) =>
      place.distanceTo(new THREE.Vector3().fromBufferAttribute(ends, i)) <= seen * this.fit.radius;
    if (this.marker.visible === (node !== null) && (!node || (near(0, node) && near(1, hand ?? node)))) return;
    this.changed = true;
    this.marker.visible = this.thread.visible = node !== null;
    if (!node) return;
    this.marker.position.copy(node);
    this.marker.scale.setScalar(0.022 * this.fit.radius);
    [node, hand ?? node].forEach(({ x, y, z }, i) => ends.setXYZ(i, x, y, z));
    ends.needsUpdate = true;
  }

  /** How finely it is drawn from now on. */
  setLook(look: Look) {
    if (this.look === look) return;
    this.look = look;
    // Where edges are not smoothed as they are drawn, more pixels do.
    this.renderer.setPixelRatio(this.antialias ? Math.min(look.ratio, window.devicePixelRatio) : look.ratio);
    this.lamp.castShadow = look.shadows;
    this.scene.environment = look.fine ? this.room : null;
    this.sky.visible = !look.fine;
    if (this.ribbon) this.ribbon.mesh.material = look.fine ? this.fine.material : this.matt;
    this.place();
  }

  /** Waits until what was asked for is drawn. */
  finish() {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /** Is there anything to be drawn? */
  moves(): boolean {
    this.controls.update();
    return this.changed;
  }
  /** Draws if there is; was there? */
  draw(): boolean {
    if (!this.changed) return false;
    this.renderer.render(this.scene, this.camera);
    this.changed = false;
    return true;
  }
  get drawn(): number { return this.renderer.info.render.frame; }   // frames so far
  /** What the graphics processor holds. */
  memory(): { geometries: number; textures: number; programs: number } {
    const { memory, programs } = this.renderer.info;
    return { geometries: memory.geometries, textures: memory.textures, programs: programs?.length ?? 0 };
  }
}
