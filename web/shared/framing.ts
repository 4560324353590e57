// Where to look from: what part of space a frame fills, and the view that shows the ribbon best.
import * as THREE from 'three';

/** What of a frame is looked at. */
interface Frame { points: Float32Array; normals: Float32Array }

export interface Fit { centre: THREE.Vector3; radius: number; floor: number }

export function fitOf(points: Float32Array[]): Fit {
  const box = new THREE.Box3();
  const p = new THREE.Vector3();
  for (const list of points) for (let i = 0; i < list.length; i += 3) box.expandByPoint(p.fromArray(list, i));
  const centre = box.getCenter(new THREE.Vector3());
  let radius = 0;
  for (const list of points) {
    for (let i = 0; i < list.length; i += 3) radius = Math.max(radius, p.fromArray(list, i).distanceTo(centre));
  }
  return { centre, radius: radius || 1, floor: box.min.z };
}

/** One fit for the whole run where that shows the last state well; else the view follows the ribbon. */
export function fitsOf(frames: Frame[]): Fit[] {
  const last = fitOf([frames[frames.length - 1].points]);
  const whole = fitOf(frames.map((frame) => frame.points));
  if (whole.radius <= 1.7 * last.radius) return frames.map(() => whole);
  return frames.map((frame) => fitOf([frame.points]));
}

interface View { towards: THREE.Vector3; right: THREE.Vector3; up: THREE.Vector3 }

function viewFrom(azimuth: number, elevation: number): View {
  const towards = new THREE.Vector3(
    Math.sin(azimuth) * Math.cos(elevation), -Math.cos(azimuth) * Math.cos(elevation), Math.sin(elevation));
  const right = new THREE.Vector3(0, 0, 1).cross(towards).normalize();
  return { towards, right, up: towards.clone().cross(right) };
}

/** How far the ribbon spreads over the picture, times how much of its surface is turned to the eye. */
function score(frame: Frame, view: View): number {
  const p = new THREE.Vector3(), n = new THREE.Vector3();
  let x = 0, y = 0, xx = 0, xy = 0, yy = 0, facing = 0;
  const count = frame.points.length / 3;
  for (let i = 0; i < frame.points.length; i += 3) {
    p.fromArray(frame.points, i);
    const a = p.dot(view.right), b = p.dot(view.up);
    x += a; y += b; xx += a * a; xy += a * b; yy += b * b;
    facing += Math.abs(n.fromArray(frame.normals, i).dot(view.towards));
  }
  x /= count; y /= count;
  const [vx, vy, cov] = [xx / count - x * x, yy / count - y * y, xy / count - x * y];
  return Math.sqrt(Math.max(0, vx * vy - cov * cov)) * (0.35 + facing / count);
}

/** The view of a frame from which most of its shape is seen, a little from above and rather from the usual side. */
export function bestView(frame: Frame): View {
  const usual = 0.5;
  let best = viewFrom(usual, 0.5), most = 0;
  for (let k = 0; k < 48; ++k) {
    for (const elevation of [0.3, 0.5, 0.7]) {
      const azimuth = usual + (k * Math.PI) / 24;
      const view = viewFrom(azimuth, elevation);
      const value = score(frame, view) * (1 + 0.4 * Math.cos(azimuth - usual));
      if (value > most) [best, most] = [view, value];
    }
  }
  return best;
}

/** Places the camera so that every frame, moved and scaled by its fit, stays in the picture. */
export function frameAll(camera: THREE.PerspectiveCamera, view: View, frames: Frame[], fits: Fit[]): THREE.Vector3 {
  const tall = 0.86 * Math.tan((camera.fov * Math.PI) / 360);
  const wide = tall * camera.aspect;
  const p = new THREE.Vector3();
  const each = (visit: (x: number, y: number, depth: number) => void) => frames.forEach((frame, k) => {
    for (let i = 0; i < frame.points.length; i += 3) {
      p.fromArray(frame.points, i).sub(fits[k].centre).divideScalar(fits[k].radius);
      visit(p.dot(view.right), p.dot(view.up), p.dot(view.towards));
    }
  });
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  each((x, y) => {
    low[0] = Math.min(low[0], x); high[0] = Math.max(high[0], x);
    low[1] = Math.min(low[1], y); high[1] = Math.max(high[1], y);
  });
  const [cx, cy] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2 - 0.03];   // room for the shadow below
  let distance = 0;
  each((x, y, depth) => { distance = Math.max(distance, depth + Math.max(Math.abs(x - cx) / wide, Math.abs(y - cy) / tall)); });
  const target = view.right.clone().multiplyScalar(cx).addScaledVector(view.up, cy);
  camera.position.copy(target).addScaledVector(view.towards, distance);
  return target;
}
