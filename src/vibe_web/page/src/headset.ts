// The session in a headset, through WebXR: a room with the endoscope's picture on a monitor, the organ as a model to walk
// around, and controllers that hold the handle of the scope.

import {
  BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, CapsuleGeometry, CircleGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial,
  PlaneGeometry, Quaternion, SphereGeometry, Vector3,
  type Texture, type WebXRManager, type XRTargetRaySpace,
} from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import type { Drive } from './drive';
import type { Lens } from './messages';
import { kPlainLayer } from './organ';
import type { Stage } from './stage';

const kMonitor = 0.9; // edge of the monitor [m]
const kAhead = 1.3, kBelow = 0.1; // where its centre is: in front of the eyes and below them [m]
const kModelAhead = 0.65, kModelBelow = 0.45; // the same of the organ's model
const kModelScale = 1.2;
const kPatientAhead = 1.05, kPatientBelow = 0.88; // the same of the middle of the patient
const kSheet = [0.5, 0.62, 0.68]; // colour
const kDome = 1.6; // radius of the picture around the viewer [m]
const kInsertion = 0.03, kRotation = 0.8; // speeds of the hand that are those of a key: [m/s], [rad/s]
const kStrong = 8; // force of the strongest pulse [N]

const kRings = 24, kSectors = 64; // of that picture
const kMiddle = 0.55; // share of its rings that are its middle, which leaves the edge of the eye at rest

const enum Pad { Trigger = 0, Squeeze = 1, Stick = 3, Lower = 4, Upper = 5 }
// Keys of the table that buttons hold: of the hand at the handle, and of the other one, which works the device.
const keyOf = (letter: string) => letter.charCodeAt(0);
const kHandle: [Pad, number][] = [[Pad.Trigger, keyOf(' ')], [Pad.Lower, keyOf('G')], [Pad.Upper, keyOf('I')], [Pad.Stick, keyOf('T')]];
const kDevice: [Pad, number][] = [[Pad.Trigger, keyOf('R')], [Pad.Lower, keyOf('N')], [Pad.Upper, keyOf('C')], [Pad.Stick, keyOf('F')]];
const kHelixAdvance = 4, kHelixRotation = 5; // joints

/** The picture as the lens took it, on a part of a ball around the eye: equidistant, so angles are true. */
function dome(fieldOfView: number): BufferGeometry {
  const place: number[] = [], uv: number[] = [], triangles: number[] = [];
  for (let r = 0; r <= kRings; r++)
    for (let s = 0; s < kSectors; s++) {
      const share = r / kRings, theta = (share * fieldOfView) / 2, phi = (2 * Math.PI * s) / kSectors;
      place.push(kDome * Math.sin(theta) * Math.cos(phi), kDome * Math.sin(theta) * Math.sin(phi), -kDome * Math.cos(theta));
      uv.push(0.5 + 0.5 * share * Math.cos(phi), 0.5 + 0.5 * share * Math.sin(phi));
      if (r === kRings) continue;
      const a = r * kSectors + s, b = r * kSectors + ((s + 1) % kSectors);
      triangles.push(a, b, a + kSectors, b, b + kSectors, a + kSectors); // from the middle outwards
    }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(place), 3));
  geometry.setAttribute('uv', new BufferAttribute(new Float32Array(uv), 2));
  geometry.setIndex(triangles);
  return geometry;
}

/** The endoscope's picture of each eye, at one place. */
class Pair extends Group {
  private eyes: Mesh<BufferGeometry, MeshBasicMaterial>[];

  constructor(geometry: BufferGeometry) {
    super();
    this.eyes = [1, 2].map((layer) => {
      const mesh = new Mesh(geometry, new MeshBasicMaterial({ side: DoubleSide }));
      mesh.layers.set(layer); // three.js: what only the left, or the right eye sees
      this.add(mesh);
      return mesh;
    });
  }

  /** Of a dome, from its middle. */
  showRings(count: number) {
    for (const { geometry } of this.eyes) geometry.setDrawRange(0, 6 * kSectors * count);
  }

  show(pictures: Texture[]) {
    this.eyes.forEach(({ material }, eye) => {
      if (material.map === pictures[eye]) return;
      material.map = pictures[eye];
      material.needsUpdate = true;
    });
  }
}

/** The patient on a table, the head to the left: a figure in a sheet, for the eye to know where it is. */
function patient(): Mesh {
  const limb = (radius: number, length: number, x: number, z: number) =>
    new CapsuleGeometry(radius, length, 4, 12).rotateZ(Math.PI / 2).translate(x, 0, z);
  const parts = [
    new SphereGeometry(0.1, 16, 10).translate(-0.5, 0.02, 0), limb(0.14, 0.42, -0.1, 0), limb(0.075, 0.75, 0.6, -0.09), limb(0.075, 0.75, 0.6, 0.09),
    limb(0.045, 0.5, -0.05, -0.2), limb(0.045, 0.5, -0.05, 0.2), new BoxGeometry(2, 0.06, 0.62).translate(0.15, -0.17, 0),
  ];
  const figure = mergeGeometries(parts), normal = figure.getAttribute('normal');
  const light = (k: number) => kSheet[k % 3] * (0.65 + 0.35 * normal.getY(Math.floor(k / 3))); // from above
  figure.setAttribute('color', new BufferAttribute(Float32Array.from({ length: 3 * normal.count }, (_, k) => light(k)), 3));
  return new Mesh(figure, new MeshBasicMaterial({ vertexColors: true }));
}

/** A line of text on a plane, drawn anew only when it changes. */
class Label extends Mesh<PlaneGeometry, MeshBasicMaterial> {
  private canvas = document.createElement('canvas');
  private text = '';

  constructor(width: number) {
    super(new PlaneGeometry(width, width / 8), new MeshBasicMaterial({ transparent: true }));
    Object.assign(this.canvas, { width: 512, height: 64 });
    this.material.map = new CanvasTexture(this.canvas);
    this.layers.set(kPlainLayer);
  }

  show(text: string) {
    if (text === this.text) return;
    this.text = text;
    const pen = this.canvas.getContext('2d')!;
    pen.clearRect(0, 0, 512, 64);
    Object.assign(pen, { font: '30px sans-serif', fillStyle: '#e8eaed', textAlign: 'center', textBaseline: 'middle' });
    pen.fillText(text, 256, 32);
    this.material.map!.needsUpdate = true;
  }
}

/** A controller, and how it was held in the frame before. */
interface Grip { space: XRTargetRaySpace; source: XRInputSource | null; held: boolean; place: Vector3; turn: Quaternion; pressed: boolean[] }

export class Headset {
  private room = new Group();
  private model = new Group(); // the organ upright, at the height of a table
  private delay = new Label(0.9);
  private monitor = new Pair(new PlaneGeometry(kMonitor, kMonitor));
  private around: Pair;
  private patient = patient();
  private grips: Grip[] = [];
  private last = 0; // [ms]
  private period = 0.011; // of the headset's frames [s]
  private moved = [0, 0]; // by the hand that holds the handle, in times of a key, and not yet told [s]
  private placed = false;
  private view = 0;
  force = 0; // [N]

  constructor(private stage: Stage, private drive: Drive, lens: Lens) {
    const { xr } = stage.renderer;
    xr.enabled = true;
    xr.setReferenceSpaceType('local-floor');
    this.around = new Pair(dome(lens.field_of_view));
    const floor = new Mesh(new CircleGeometry(3, 48).rotateX(-Math.PI / 2), new MeshBasicMaterial({ color: 0x2c3238 }));
    const rim = new Mesh(new PlaneGeometry(kMonitor + 0.06, kMonitor + 0.06).translate(0, 0, -0.01), new MeshBasicMaterial({ color: 0x0a0c0e }));
    for (const part of [floor, rim, this.patient]) part.layers.set(kPlainLayer);
    this.delay.position.set(0, -kMonitor / 2 - 0.1, 0);
    this.monitor.add(rim, this.delay);
    this.room.add(floor, this.patient, this.monitor, this.around, this.model);
    this.around.visible = false;
    this.room.visible = false;
    stage.scene.add(this.room);
    for (const k of [0, 1]) this.addGrip(xr, k);
    drive.onSend = (seconds) => this.tellMoved(seconds);
    xr.addEventListener('sessionstart', () => this.begin());
    xr.addEventListener('sessionend', () => this.end());
  }

  /** Asked by a click; says why not in one sentence. */
  async enter(): Promise<string> {
    const { xr } = this.stage.renderer;
    if (xr.isPresenting) return (await xr.getSession()?.end(), '');
    try {
      await xr.setSession(await navigator.xr!.requestSession('immersive-vr', { optionalFeatures: ['local-floor', 'hand-tracking'] }));
      return '';
    } catch (error) {
      return `The browser cannot enter a headset (${(error as Error).message}); is one connected, and is the address https?`;
    }
  }

  private addGrip(xr: WebXRManager, k: number) {
    const grip: Grip = { space: xr.getController(k), source: null, held: false, place: new Vector3(), turn: new Quaternion(), pressed: [] };
    grip.space.addEventListener('connected', ({ data }) => (grip.source = data));
    grip.space.addEventListener('disconnected', () => ((grip.source = null), (grip.held = false)));
    // hands pinch instead of squeezing
    for (const word of ['squeeze', 'select'] as const) {
      grip.space.addEventListener(`${word}start`, () => word === 'select' && !grip.source?.hand ? undefined : this.hold(grip));
      grip.space.addEventListener(`${word}end`, () => word === 'select' && !grip.source?.hand ? undefined : ((grip.held = false), undefined));
    }
    this.grips.push(grip);
    this.stage.scene.add(grip.space);
  }

  /** One hand holds the handle, whichever it is: left- and right-handed people need no setting. */
  private hold(grip: Grip) {
    for (const other of this.grips) other.held = other === grip;
    grip.place.copy(grip.space.position);
    grip.turn.copy(grip.space.quaternion);
  }

  private begin() {
    this.placed = false;
    this.room.visible = true;
    this.model.add(this.stage.body);
    this.model.rotation.set(-Math.PI / 2, 0, -Math.PI / 2); // z of the simulator is up, and its front faces the viewer
    this.last = performance.now();
  }

  private end() {
    this.room.visible = false;
    this.stage.scene.add(this.stage.body);
    this.drive.headset.keys.clear();
    this.drive.headset.axes.fill(0);
    this.moved.fill(0);
    this.stage.dirty = true;
  }

  /** Puts the room in front of the eyes, at their height: sitting or standing. */
  recentre() {
    const { xr } = this.stage.renderer, camera = xr.getCamera();
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld), ahead = new Vector3(0, 0, -1).transformDirection(camera.matrixWorld);
    if (eye.lengthSq() === 0) return;
    ahead.setY(0).normalize();
    this.room.position.set(eye.x, 0, eye.z);
    this.room.rotation.y = Math.atan2(-ahead.x, -ahead.z);
    this.monitor.position.set(0, eye.y - kBelow, -kAhead);
    this.around.position.set(0, eye.y, 0);
    this.patient.position.set(0, eye.y - kPatientBelow, -kPatientAhead);
    this.model.position.set(0, eye.y - kModelBelow, -kModelAhead);
    this.placed = true;
  }

  showDelay(text: string) {
    this.delay.show(text);
  }

  /** Called for each frame of the headset. */
  draw() {
    const { stage } = this, now = performance.now();
    this.period = (now - this.last) / 1000;
    this.last = now;
    if (!this.placed) this.recentre();
    stage.body.position.copy(stage.organ.centre).negate(); // the model stands where its middle is
    this.readHands();
    stage.renderer.info.reset();
    this.model.visible = true; // the endoscope is in it, and its light falls off with true distances
    this.model.scale.setScalar(1);
    stage.drawEndoscope(true);
    this.model.scale.setScalar(kModelScale);
    this.model.visible = !this.around.visible;
    const { endoscope } = stage;
    if (endoscope) for (const pair of [this.monitor, this.around]) pair.show([endoscope.target.texture, endoscope.right.texture]);
    stage.renderer.xr.getCamera().layers.enable(kPlainLayer);
    stage.camera.layers.set(kPlainLayer);
    stage.renderer.setClearColor(0x3a424b, 1);
    stage.renderer.clear();
    stage.renderer.render(stage.scene, stage.camera);
    stage.counts = { calls: stage.renderer.info.render.calls, triangles: stage.renderer.info.render.triangles };
    stage.drawMs = performance.now() - now;
  }

  private readHands() {
    const { axes, keys } = this.drive.headset;
    axes.fill(0, 2); // but insertion and rotation
    keys.clear();
    for (const grip of this.grips) {
      if (grip.held) this.moveHandle(grip);
      this.readPad(grip, axes, keys);
    }
    if (!this.grips.some(({ held }) => held)) this.moved.fill(0);
  }

  private moveHandle(grip: Grip) {
    const ahead = new Vector3(0, 0, -1).applyQuaternion(grip.turn);
    const along = grip.space.position.clone().sub(grip.place).dot(ahead);
    const turned = grip.turn.clone().invert().multiply(grip.space.quaternion);
    const roll = 2 * Math.atan2(-turned.z, turned.w);
    this.moved[0] += along / kInsertion;
    this.moved[1] += Math.atan2(Math.sin(roll), Math.cos(roll)) / kRotation;
    grip.place.copy(grip.space.position);
    grip.turn.copy(grip.space.quaternion);
  }

  /** All of the way counts, told in steps of this time; where frames come more rarely, spread until the next one. */
  private tellMoved(seconds: number) {
    const share = Math.min(1, seconds / this.period);
    this.moved.forEach((time, joint) => {
      this.drive.headset.axes[joint] = (share * time) / seconds;
      this.moved[joint] -= share * time;
    });
  }

  // Without a hand at the handle the buttons are those of the room.
  private readPad(grip: Grip, axes: number[], keys: Set<number>) {
    const pad = grip.source?.gamepad;
    if (!pad) return;
    const pressed = (button: Pad) => (pad.buttons[button]?.pressed ?? false) && !grip.pressed[button];
    const held = this.grips.some((each) => each.held);
    if (!held && pressed(Pad.Lower)) this.nextView();
    if (!held && pressed(Pad.Upper)) this.recentre();
    if (held) for (const [button, key] of grip.held ? kHandle : kDevice) if (pad.buttons[button]?.pressed) keys.add(key);
    const [across, up] = [pad.axes[2] ?? 0, -(pad.axes[3] ?? 0)];
    if (held && !grip.held) {
      axes[kHelixAdvance] += up;
      axes[kHelixRotation] += across;
    } else {
      axes[3] -= across;
      axes[2] += up;
    }
    if (grip.held && this.force > 0.3) void pad.hapticActuators?.[0]?.pulse(Math.min(1, this.force / kStrong), 30);
    grip.pressed = pad.buttons.map((button) => button.pressed);
  }

  /** The picture on the monitor, all around the eyes, or its middle there. */
  nextView() {
    this.view = (this.view + 1) % 3;
    this.around.visible = this.view > 0;
    this.monitor.visible = this.view === 0;
    this.patient.visible = this.view !== 1; // which would stand before the picture
    this.around.showRings(this.view === 1 ? kRings : Math.round(kMiddle * kRings));
  }
}
