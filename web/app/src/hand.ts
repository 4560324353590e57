// Pulling the ribbon: by mouse, by touch, by keyboard.
import * as THREE from 'three';
import type { Simulator, Strip } from './simulator';
import type { Stage } from './stage';

const near = { mouse: 26, touch: 44 };   // pixels from a node that still count as on the ribbon
const wheelTurn = 0.004;   // radians a wheel unit
const keyTurn = Math.PI / 24;

export interface Held { strip: number; node: number }

export class Hand {
  held: Held | null = null;
  private target = new THREE.Vector3();
  private offset = new THREE.Vector3();   // from where the pointer took hold to the node
  private pointer: number | null = null;
  private angle: number | null = null;    // between two fingers
  private second: number | null = null;
  private places = new Map<number, [number, number]>();

  constructor(private readonly simulator: Simulator, private readonly stage: Stage, private readonly strips: () => Strip[],
              private readonly changed: () => void) {
    const { canvas } = stage;
    canvas.addEventListener('pointerdown', (event) => this.down(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(name, (event) => this.up(event));
    // Where text is selected the browser would drag that away.
    document.addEventListener('dragstart', (event) => { if (this.held) event.preventDefault(); });
    canvas.addEventListener('wheel', (event) => {
      if (!this.held) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      this.turn(wheelTurn * event.deltaY);
    }, { capture: true, passive: false });
  }

  /** The number of a node among those of all strips, and back. */
  private index({ strip, node }: Held): number {
    return this.strips().slice(0, strip).reduce((sum, { segments }) => sum + segments + 1, 0) + node;
  }
  private heldAt(index: number): Held {
    let node = index, strip = 0;
    for (; node > this.strips()[strip].segments; ++strip) node -= this.strips()[strip].segments + 1;
    return { strip, node };
  }
  /** Where a node is [m]. */
  position(held: Held): THREE.Vector3 {
    return new THREE.Vector3().fromArray(this.simulator.view().nodes, 3 * this.index(held));
  }

  /** The node at a place in the picture, or near it if there is one. */
  nearest(x: number, y: number, within: number): Held | null {
    const hit = this.stage.hit(x, y);
    if (hit !== null) return this.heldAt(hit);
    const { nodes } = this.simulator.view(), point = new THREE.Vector3();
    let best: number | null = null, least = within;
    for (let i = 0; 3 * i < nodes.length; ++i) {
      const [px, py] = this.stage.project(point.fromArray(nodes, 3 * i));
      const distance = Math.hypot(px - x, py - y);
      if (distance < least) [best, least] = [i, distance];
    }
    return best === null ? null : this.heldAt(best);
  }

  /** Takes hold of a node; where it is held it stays, until it is moved. */
  take(held: Held) {
    this.simulator.grab(held.strip, held.node);
    if (!this.simulator.holds()) return;
    this.held = held;
    this.target = this.position(held);
    this.changed();
  }
  moveTo(target: THREE.Vector3) {
    this.target.copy(target);
    this.simulator.drag(target.x, target.y, target.z);
    this.changed();
  }
  /** By so much of the picture's directions right, up and towards the eye [m]. */
  moveBy(right: number, up: number, towards: number) {
    const axes = this.stage.axes();
    const target = this.target.clone();
    [right, up, towards].forEach((amount, k) => target.addScaledVector(axes[k], amount));
    this.moveTo(target);
  }
  turn(angle: number) { this.simulator.turn(angle); this.changed(); }
  letGo() {
    this.simulator.letGo();
    this.forget();
  }
  /** The simulator has let go by itself. */
  forget() {
    this.held = this.pointer = this.second = this.angle = null;
    this.stage.controls.enabled = true;
    this.changed();
  }
  /** What is drawn: the held node, and where it is pulled to. */
  mark() {
    if (this.held && !this.simulator.holds()) this.forget();
    this.stage.mark(this.held ? this.position(this.held) : null, this.held ? this.target : null);
  }

  /** The next end or the middle, then none; by keyboard. */
  choose(back: boolean) {
    const strip = this.held?.strip ?? 0, { segments } = this.strips()[strip];
    const stops = [segments, 0, Math.round(segments / 2)];
    const now = this.held ? stops.indexOf(this.held.node) : -1;
    const next = back ? (now < 0 ? stops.length - 1 : now - 1) : now + 1;
    this.letGo();
    if (next >= 0 && next < stops.length) this.take({ strip, node: stops[next] });
  }
  /** The node before or after the held one. */
  shift(by: number) {
    if (!this.held) return;
    const { strip, node } = this.held;
    const to = Math.max(0, Math.min(this.strips()[strip].segments, node + by));
    this.letGo();
    this.take({ strip, node: to });
  }
  get step(): number { return 0.02 * this.strips()[0].length; }
  readonly keyTurn = keyTurn;

  private place(event: PointerEvent): [number, number] {
    const box = this.stage.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }
  private down(event: PointerEvent) {
    const [x, y] = this.place(event);
    this.places.set(event.pointerId, [x, y]);
    if (this.pointer !== null) {   // a second finger turns what the first one holds
      if (this.second !== null || event.pointerId === this.pointer) return;
      event.stopImmediatePropagation();
      this.second = event.pointerId;
      this.angle = this.fingers();
      return;
    }
    if (event.button !== 0) return;
    const found = this.nearest(x, y, event.pointerType === 'touch' ? near.touch : near.mouse);
    if (!found) return;
    this.letGo();
    this.take(found);
    if (!this.held) return;
    event.stopImmediatePropagation();   // the view does not turn
    this.stage.controls.enabled = false;
    this.pointer = event.pointerId;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.offset = this.target.clone().sub(this.stage.unproject(x, y, this.target));
  }
  private fingers(): number | null {
    const a = this.places.get(this.pointer!), b = this.places.get(this.second!);
    return a && b ? Math.atan2(b[1] - a[1], b[0] - a[0]) : null;
  }
  private move(event: PointerEvent) {
    const [x, y] = this.place(event);
    if (this.pointer === null) {
      if (event.pointerType === 'mouse' && event.buttons === 0) {
        this.stage.canvas.classList.toggle('over', this.nearest(x, y, near.mouse) !== null);
      }
      return;
    }
    if (this.places.has(event.pointerId)) this.places.set(event.pointerId, [x, y]);
    if (this.second !== null && this.angle !== null) {
      const angle = this.fingers();
      if (angle !== null) {
        let by = angle - this.angle;
        if (by > Math.PI) by -= 2 * Math.PI;
        if (by < -Math.PI) by += 2 * Math.PI;
        this.turn(by);
        this.angle = angle;
      }
    }
    if (event.pointerId !== this.pointer) return;
    if (event.shiftKey) {
      this.turn(0.02 * event.movementX);
    } else {
      this.moveTo(this.stage.unproject(x, y, this.target).add(this.offset));
    }
  }
  private up(event: PointerEvent) {
    this.places.delete(event.pointerId);
    if (event.pointerId === this.second) this.second = this.angle = null;
    if (event.pointerId === this.pointer) this.letGo();
  }
}
