// What every view of a ribbon is made of: renderer, light, paper, lines.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/examples/jsm/environments/RoomEnvironment.js';

export const paint = { front: 0xc65a34, back: 0xe9c9a1 };
const lightFrom = new THREE.Vector3(1.6, -1.2, 3.4);

/** Edges that belong to one triangle only, as pairs of points: the rims, and the ends unless they are joined. */
export function boundary(triangles: Uint32Array, pointU: ArrayLike<number> | null, joined: boolean): Uint32Array {
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

export type Paper = THREE.MeshPhysicalMaterial | THREE.MeshLambertMaterial;

const offset = { polygonOffset: true, polygonOffsetFactor: 1.5, polygonOffsetUnits: 2 };   // lines on it are seen

/** Paper-like; the back of a two-sided strip has its own colour. */
export function ribbonMaterial(): { material: THREE.MeshPhysicalMaterial; back: { value: THREE.Color } } {
  const material = new THREE.MeshPhysicalMaterial({
    side: THREE.DoubleSide, vertexColors: true, roughness: 0.58, metalness: 0, sheen: 0.2, sheenRoughness: 0.5,
    clearcoat: 0.08, clearcoatRoughness: 0.6, ...offset,
  });
  const back = { value: new THREE.Color(paint.back) };
  paintBack(material, back);
  return { material, back };
}

/** The same without shine: for machines that draw slowly. */
export function mattMaterial(back: { value: THREE.Color }): THREE.MeshLambertMaterial {
  const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, vertexColors: true, ...offset });
  paintBack(material, back);
  return material;
}

function paintBack(material: Paper, back: { value: THREE.Color }) {
  // Where a strip shadows itself is looked up a little off its surface: on the side of the light, whichever side of the
  // strip that is. Else every second side lies in its own shadow, and a one-sided band changes its shade at the seam.
  const { x, y, z } = lightFrom;
  const shadow = THREE.ShaderChunk.shadowmap_vertex.replace(
    'transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );',
    `$& shadowWorldNormal *= sign(dot(shadowWorldNormal, vec3(${x.toFixed(3)}, ${y.toFixed(3)}, ${z.toFixed(3)})));`);
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <shadowmap_vertex>', shadow);
    shader.uniforms.backColour = back;
    shader.fragmentShader = 'uniform vec3 backColour;\n' + shader.fragmentShader.replace(
      '#include <color_fragment>',
      '#include <color_fragment>\nif (!gl_FrontFacing) diffuseColor.rgb = backColour * vColor.rgb;');
  };
}

export function lines(count: number, colour: number, opacity: number): THREE.LineSegments {
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

export function createRenderer(host: HTMLElement, antialias = true): THREE.WebGLRenderer {
  const renderer = new THREE.WebGLRenderer({ antialias, alpha: true, preserveDrawingBuffer: false });
  renderer.toneMapping = THREE.NeutralToneMapping;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  host.append(renderer.domElement);
  return renderer;
}

export function createControls(camera: THREE.Camera, element: HTMLElement): OrbitControls {
  const controls = new OrbitControls(camera, element);
  controls.enableDamping = true;
  controls.dampingFactor = 0.12;
  controls.minDistance = 0.3;
  controls.maxDistance = 14;
  return controls;
}

/** Light from a room and from above; the room's ceiling is along y, ours along z. */
export function createScene(renderer: THREE.WebGLRenderer): THREE.Scene {
  const scene = new THREE.Scene();
  scene.environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
  scene.environmentRotation.set(Math.PI / 2, 0, 0);
  scene.add(keyLight());
  return scene;
}

/** A floor that is seen only by the shadow on it. */
export function createFloor(): THREE.Mesh<THREE.CircleGeometry, THREE.ShadowMaterial> {
  const floor = new THREE.Mesh(new THREE.CircleGeometry(6, 48), new THREE.ShadowMaterial({ opacity: 0.16 }));
  floor.receiveShadow = true;
  return floor;
}

/** The ribbon's mesh, white, of so many points. */
export function ribbonMesh(count: number, triangles: Uint32Array, material: THREE.Material): THREE.Mesh {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * count).fill(1), 3));
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  return mesh;
}

/** A solid beside the ribbon, in its own frame; seen from outside only, so that a floor does not hide the ribbon. */
export function solidMesh(points: Float32Array, normals: Float32Array, triangles: Uint32Array):
  THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial> {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(points, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0x9aa1a9, roughness: 0.75 }));
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

/** Turns the camera about what it looks at, by radians to the right and up. */
export function turnCamera(camera: THREE.Camera, controls: OrbitControls, right: number, up: number) {
  const offset = camera.position.clone().sub(controls.target);
  const polar = new THREE.Spherical().setFromCartesianCoords(offset.x, offset.z, -offset.y);   // z up to y up
  polar.theta += right;
  polar.phi = Math.max(0.05, Math.min(Math.PI - 0.05, polar.phi - up));
  const turned = new THREE.Vector3().setFromSpherical(polar);
  camera.position.set(turned.x, -turned.z, turned.y).add(controls.target);
  controls.update();
}

/** Brings the camera nearer to what it looks at, or takes it away. */
export function zoomCamera(camera: THREE.Camera, controls: OrbitControls, factor: number) {
  camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
  controls.update();
}
