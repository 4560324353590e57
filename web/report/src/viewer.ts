// The ribbon in 3D.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/examples/jsm/environments/RoomEnvironment.js';
import { diverging, fieldRange } from './colour';
import { addBodies } from './bodies';
import { isOneSided, type FieldName, type Frame, type Run } from './data';
import { bestView, fitsOf, frameAll, type Fit } from './framing';

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

const paint = { front: 0xc65a34, back: 0xe9c9a1 };
const lightFrom = new THREE.Vector3(1.6, -1.2, 3.4);

/** Edges that belong to one triangle only, as pairs of points: the rims, and the ends unless they are joined. */
function boundary({ triangles, pointU, summary }: Run): Uint32Array {
  const joined = summary.closure_error !== undefined;
  const seen = new Map<number, [number, number] | null>();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[t + k], b = triangles[t + ((k + 1) % 3)];
      const key = Math.min(a, b) * 67108864 + Math.max(a, b);
      const across = joined && pointU !== null && pointU[a] === pointU[b];
      seen.set(key, across || seen.has(key) ? null : [a, b]);
    }
  }
  return Uint32Array.from([...seen.values()].filter((edge) => edge !== null).flat());
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

/** Paper-like; the back of a two-sided strip has its own colour. */
function ribbonMaterial(): { material: THREE.MeshPhysicalMaterial; back: { value: THREE.Color } } {
  const material = new THREE.MeshPhysicalMaterial({
    side: THREE.DoubleSide, vertexColors: true, roughness: 0.58, metalness: 0, sheen: 0.2, sheenRoughness: 0.5,
    clearcoat: 0.08, clearcoatRoughness: 0.6, polygonOffset: true, polygonOffsetFactor: 1.5, polygonOffsetUnits: 2,
  });
  const back = { value: new THREE.Color(paint.back) };
  // Where a strip shadows itself is looked up a little off its surface: on the side of the light, whichever side of the
  // strip that is. Else every second side lies in its own shadow, and a one-sided band changes its shade at the seam.
  const { x, y, z } = lightFrom;
  const offset = THREE.ShaderChunk.shadowmap_vertex.replace(
    'transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );',
    `$& shadowWorldNormal *= sign(dot(shadowWorldNormal, vec3(${x.toFixed(3)}, ${y.toFixed(3)}, ${z.toFixed(3)})));`);
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <shadowmap_vertex>', offset);
    shader.uniforms.backColour = back;
    shader.fragmentShader = 'uniform vec3 backColour;\n' + shader.fragmentShader.replace(
      '#include <color_fragment>',
      '#include <color_fragment>\nif (!gl_FrontFacing) diffuseColor.rgb = backColour * vColor.rgb;');
  };
  return { material, back };
}

function lines(count: number, colour: number, opacity: number): THREE.LineSegments {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  const material = new THREE.LineBasicMaterial({ color: colour, transparent: opacity < 1, opacity });
  const out = new THREE.LineSegments(geometry, material);
  out.frustumCulled = false;
  return out;
}

function keyLight(): THREE.DirectionalLight {
  const light = new THREE.DirectionalLight(0xfff4e6, 2.2);
  light.position.copy(lightFrom);
  light.castShadow = true;
  light.shadow.mapSize.set(2048, 2048);
  light.shadow.normalBias = 0.015;
  light.shadow.bias = -0.0004;
  light.shadow.radius = 6;
  Object.assign(light.shadow.camera, { left: -1.6, right: 1.6, top: 1.6, bottom: -1.6, near: 0.5, far: 8 });
  return light;
}

function createRenderer(host: HTMLElement): THREE.WebGLRenderer {
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: false });
  renderer.toneMapping = THREE.NeutralToneMapping;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  host.append(renderer.domElement);
  return renderer;
}

function createControls(camera: THREE.Camera, element: HTMLElement): OrbitControls {
  const controls = new OrbitControls(camera, element);
  controls.enableDamping = true;
  controls.dampingFactor = 0.12;
  controls.minDistance = 0.3;
  controls.maxDistance = 14;
  return controls;
}

/** `seenAs`: a run whose best view is taken, so that several are seen from one side. */
export function createViewer(host: HTMLElement, run: Run, onFirstDrag: () => void, seenAs: Run = run): Viewer {
  const renderer = createRenderer(host);

  const scene = new THREE.Scene();
  const environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
  scene.environment = environment;
  scene.environmentRotation.set(Math.PI / 2, 0, 0);   // the room's ceiling is along y, ours along z
  scene.add(keyLight());

  const { material, back } = ribbonMaterial();
  const count = run.frames[0].points.length / 3;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * count).fill(1), 3));
  geometry.setIndex(new THREE.BufferAttribute(run.triangles, 1));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  const rims = boundary(run);
  const rimLines = lines(rims.length, 0x2a1a12, 0.55);
  const rulingLines = lines(run.frames[0].rulings.length / 3, 0x2a1a12, 0.5);
  rulingLines.visible = false;
  const marker = lines(2, 0xffffff, 1);
  Object.assign(marker, { visible: false, renderOrder: 2 });
  const body = new THREE.Group();
  body.add(mesh, rimLines, rulingLines, marker);
  const placeBodies = addBodies(body, run.bodies);
  scene.add(body);

  const floor = new THREE.Mesh(new THREE.CircleGeometry(6, 48), new THREE.ShadowMaterial({ opacity: 0.16 }));
  floor.receiveShadow = true;
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
    const offset = camera.position.clone().sub(controls.target);
    const polar = new THREE.Spherical().setFromCartesianCoords(offset.x, offset.z, -offset.y);   // z up to y up
    polar.theta += right;
    polar.phi = Math.max(0.05, Math.min(Math.PI - 0.05, polar.phi - up));
    const turned = new THREE.Vector3().setFromSpherical(polar);
    camera.position.set(turned.x, -turned.z, turned.y).add(controls.target);
    controls.update();
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
      camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
      controls.update();
      request();
    },
    setTheme(dark) {
      scene.environmentIntensity = dark ? 0.55 : 0.75;
      (floor.material as THREE.ShadowMaterial).opacity = dark ? 0.45 : 0.16;
      (marker.material as THREE.LineBasicMaterial).color.set(dark ? 0xffffff : 0x101014);
      request();
    },
  };
}
