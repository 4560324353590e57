// The ribbon in 3D.
import * as THREE from 'three';
import { diverging } from '../../shared/colour';
import {
  boundary, createControls, createFloor, createRenderer, createScene, lines, paint, ribbonMaterial, ribbonMesh, turnCamera,
  zoomCamera,
} from '../../shared/stage';
import { addBodies } from './bodies';
import { fieldRange, isOneSided, type FieldName, type Frame, type Run } from './data';
import { bestView, fitsOf, frameAll, type Fit } from '../../shared/framing';

export type Colour = 'none' | FieldName;

export interface Viewer {
  /** A frame index; between two whole numbers the frames are mixed. */
  show(position: number): void;
  setColour(colour: Colour): void;
  setRulings(visible: boolean): void;
  /** Marks the ruling of a node, or none. */
  mark(node: number | null): void;
  resetView(): void;
  turn(right: number, up: number): void;
  zoom(factor: number): void;
  setTheme(dark: boolean): void;
}

function mix(out: Float32Array, a: Float32Array, b: Float32Array, t: number) {
  for (let i = 0; i < out.length; ++i) out[i] = a[i] + (b[i] - a[i]) * t;
}

/** For each mesh point the node before it and the share of the next one. */
function nodeWeights(run: Run): { node: Uint32Array; share: Float32Array } | null {
  if (!run.pointU) return null;
  const node = new Uint32Array(run.pointU.length);
  const share = new Float32Array(run.pointU.length);
  let k = 0;
  run.pointU.forEach((u, i) => {
    while (k > 0 && run.u[k] > u) --k;
    while (k < run.u.length - 2 && run.u[k + 1] < u) ++k;
    node[i] = k;
    share[i] = (u - run.u[k]) / (run.u[k + 1] - run.u[k]);
  });
  return { node, share };
}

/** `seenAs`: a run whose best view is taken, so that several are seen from one side. */
export function createViewer(host: HTMLElement, run: Run, onFirstDrag: () => void, seenAs: Run = run): Viewer {
  const renderer = createRenderer(host);

  const scene = createScene(renderer);
  const { material, back } = ribbonMaterial();
  const count = run.frames[0].points.length / 3;
  const mesh = ribbonMesh(count, run.triangles, material), geometry = mesh.geometry;
  const rims = boundary(run.triangles, run.pointU, run.summary.closure_error !== undefined);
  const rimLines = lines(rims.length, 0x2a1a12, 0.55);
  const rulingLines = lines(run.frames[0].rulings.length / 3, 0x2a1a12, 0.5);
  rulingLines.visible = false;
  const marker = lines(2, 0xffffff, 1);
  Object.assign(marker, { visible: false, renderOrder: 2 });
  const body = new THREE.Group();
  body.add(mesh, rimLines, rulingLines, marker);
  const placeBodies = addBodies(body, run.bodies);
  scene.add(body);

  const floor = createFloor();
  scene.add(floor);

  const camera = new THREE.PerspectiveCamera(32, 1, 0.05, 50);
  camera.up.set(0, 0, 1);
  const controls = createControls(camera, renderer.domElement);
  let untouched = true;   // until then the view is fitted anew when the page changes its size
  controls.addEventListener('start', () => { untouched = false; onFirstDrag(); });

  const fits = fitsOf(run.frames);
  const usualView = bestView(seenAs.frames[seenAs.frames.length - 1]);
  const weights = nodeWeights(run);
  let position = run.frames.length - 1;
  let colour: Colour = 'none';
  let range = 1;
  let marked: number | null = null;
  let queued = false;

  function draw() {
    queued = false;
    if (controls.update()) request();
    renderer.render(scene, camera);
  }
  function request() {
    if (queued) return;
    queued = true;
    requestAnimationFrame(draw);
  }
  controls.addEventListener('change', request);

  function paintPoints(a: Frame, b: Frame, t: number) {
    const attribute = geometry.getAttribute('color') as THREE.BufferAttribute;
    const out = attribute.array as Float32Array;
    if (colour === 'none' || !weights) {
      out.fill(1);
    } else {
      const [fa, fb] = [a.fields[colour], b.fields[colour]];
      const value = (node: number) => fa[node] + (fb[node] - fa[node]) * t;
      const rgb = new THREE.Color();
      for (let i = 0; i < count; ++i) {
        const k = weights.node[i];
        const field = value(k) + (value(k + 1) - value(k)) * weights.share[i];
        rgb.setRGB(...diverging(field / range), THREE.SRGBColorSpace).toArray(out, 3 * i);
      }
    }
    attribute.needsUpdate = true;
    material.color.set(colour === 'none' ? paint.front : 0xffffff);
    back.value.set(colour !== 'none' ? 0xffffff : isOneSided(run) ? paint.front : paint.back);
  }

  function place(a: Fit, b: Fit, t: number) {
    const radius = a.radius + (b.radius - a.radius) * t;
    const centre = a.centre.clone().lerp(b.centre, t);
    body.scale.setScalar(1 / radius);
    body.position.copy(centre).multiplyScalar(-1 / radius);
    floor.position.z = (a.floor + (b.floor - a.floor) * t - centre.z) / radius - 0.12;
  }

  function update() {
    const k = Math.min(run.frames.length - 1, Math.floor(position));
    const next = Math.min(run.frames.length - 1, k + 1);
    const t = position - k;
    const [a, b] = [run.frames[k], run.frames[next]];
    const points = geometry.getAttribute('position') as THREE.BufferAttribute;
    mix(points.array as Float32Array, a.points, b.points, t);
    points.needsUpdate = true;
    const normals = geometry.getAttribute('normal') as THREE.BufferAttribute;
    mix(normals.array as Float32Array, a.normals, b.normals, t);
    normals.needsUpdate = true;
    const rim = rimLines.geometry.getAttribute('position') as THREE.BufferAttribute;
    rims.forEach((point, i) => rim.setXYZ(i, points.getX(point), points.getY(point), points.getZ(point)));
    rim.needsUpdate = true;
    const ruling = rulingLines.geometry.getAttribute('position') as THREE.BufferAttribute;
    mix(ruling.array as Float32Array, a.rulings, b.rulings, t);
    ruling.needsUpdate = true;
    marker.visible = marked !== null;
    if (marked !== null) {
      const ends = marker.geometry.getAttribute('position') as THREE.BufferAttribute;
      (ends.array as Float32Array).set((ruling.array as Float32Array).subarray(6 * marked, 6 * marked + 6));
      ends.needsUpdate = true;
    }
    placeBodies(k, next, t);
    paintPoints(a, b, t);
    place(fits[k], fits[next], t);
    request();
  }

  function resetView() {
    untouched = true;
    controls.target.copy(frameAll(camera, usualView, run.frames, fits));
    controls.update();
    request();
  }

  function turn(right: number, up: number) {
    untouched = false;
    turnCamera(camera, controls, right, up);
    request();
  }

  new ResizeObserver(() => {
    const { clientWidth, clientHeight } = host;
    if (!clientWidth || !clientHeight) return;
    camera.aspect = clientWidth / clientHeight;
    camera.updateProjectionMatrix();
    renderer.setSize(clientWidth, clientHeight);
    if (untouched) resetView();
    request();
  }).observe(host);

  return {
    show(value) { position = value; update(); },
    setColour(value) {
      colour = value;
      if (value !== 'none') range = fieldRange(run.frames, value);
      update();
    },
    setRulings(visible) { rulingLines.visible = visible; request(); },
    mark(node) { if (node !== marked) { marked = node; update(); } },
    resetView,
    turn,
    zoom(factor) {
      untouched = false;
      zoomCamera(camera, controls, factor);
      request();
    },
    setTheme(dark) {
      scene.environmentIntensity = dark ? 0.55 : 0.75;
      floor.material.opacity = dark ? 0.45 : 0.16;
      (marker.material as THREE.LineBasicMaterial).color.set(dark ? 0xffffff : 0x101014);
      request();
    },
  };
}
