// Obstacles in the view.
import * as THREE from 'three';
import { solidMesh } from '../../shared/stage';
import type { Body } from './data';

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
  const meshes = bodies.map((body) => solidMesh(body.points, body.normals, body.triangles));
  meshes.forEach((mesh) => group.add(mesh));
  return (k, next, t) => meshes.forEach((mesh, i) => placeBody(mesh, bodies[i], k, next, t));
}
