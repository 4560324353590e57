// Obstacles in the view.
import * as THREE from 'three';
import type { Body } from './data';

/** Seen from outside only, so that a floor does not hide the ribbon from below. */
export function bodyMesh(body: Body): THREE.Mesh {
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
export function placeBody(mesh: THREE.Mesh, { poses }: Body, k: number, next: number, t: number) {
  const [a, b] = [7 * k, 7 * next];
  mesh.position.set(poses[a], poses[a + 1], poses[a + 2]);
  mesh.position.lerp(new THREE.Vector3(poses[b], poses[b + 1], poses[b + 2]), t);
  mesh.quaternion.slerpQuaternions(from.fromArray(poses, a + 3), to.fromArray(poses, b + 3), t);
}
