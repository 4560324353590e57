// Obstacles in the view.
import * as THREE from 'three';
import type { Body } from './data';

/** Seen from outside only, so that a floor does not hide the ribbon from below. */
function bodyMesh(body: Body): THREE.Mesh {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(body.points, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(body.normals, 3));
  geometry.setIndex(new THREE.BufferAttribute(body.triangles, 1));
  const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0x9aa1a9, roughness: 0.75 }));
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

const from = new THREE.Quaternion();
const to = new THREE.Quaternion();

/** Puts a body between its poses in the frames `k` and `next`. */
function placeBody(mesh: THREE.Mesh, { poses }: Body, k: number, next: number, t: number) {
  const [a, b] = [7 * k, 7 * next];
  mesh.position.set(poses[a], poses[a + 1], poses[a + 2]);
  mesh.position.lerp(new THREE.Vector3(poses[b], poses[b + 1], poses[b + 2]), t);
  mesh.quaternion.slerpQuaternions(from.fromArray(poses, a + 3), to.fromArray(poses, b + 3), t);
}

/** Adds the bodies to a group; the returned function puts them between two frames. */
export function addBodies(group: THREE.Group, bodies: Body[]): (k: number, next: number, t: number) => void {
  const meshes = bodies.map(bodyMesh);
  meshes.forEach((mesh) => group.add(mesh));
  return (k, next, t) => meshes.forEach((mesh, i) => placeBody(mesh, bodies[i], k, next, t));
}
