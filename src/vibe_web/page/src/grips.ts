// Hands of a headset at the handle of the scope: their way becomes axes of the drive, buttons and sticks its keys.

import { Group, Quaternion, Raycaster, Vector3, type WebXRManager, type XRGripSpace, type XRTargetRaySpace } from 'three';
import type { Drive } from './drive';
import { HandFigure, Holds } from './held';
import { kPlainLayer } from './organ';
import type { Button, Readings } from './readings';
import { Way } from './way';

const kSpeeds = [0.03, 0.8]; // of the hand that are those of a key, insertion and rotation: [m/s], [rad/s]
const kUnits = [[1000, 'mm'], [180 / Math.PI, 'degrees']] as const;
const kTold = 2, kBehind = [15, 25]; // way not followed that is told: of a hand that rests, and of one that moves [mm], [degrees]
const kRest = 500; // then the server has told where the scope is [ms]
const kStrong = 8; // force of the strongest pulse [N]

const enum Pad { Trigger = 0, Squeeze = 1, Stick = 3, Lower = 4, Upper = 5 }
// Keys of the table that buttons hold: of the hand at the handle, and of the other one, which works the device.
const keyOf = (letter: string) => letter.charCodeAt(0);
const kHandle: [Pad, number][] = [[Pad.Trigger, keyOf(' ')], [Pad.Lower, keyOf('G')], [Pad.Upper, keyOf('I')], [Pad.Stick, keyOf('T')]];
const kDevice: [Pad, number][] = [[Pad.Trigger, keyOf('R')], [Pad.Lower, keyOf('N')], [Pad.Upper, keyOf('C')], [Pad.Stick, keyOf('F')]];
const kNames: Record<string, string> = { // of what does the same as these keys
  W: 'the handle ahead', G: 'A or X', I: 'B or Y', T: 'the stick', R: 'the other trigger', N: 'the other A or X', C: 'the other B or Y',
  F: 'the other stick', E: 'the other stick ahead', Q: 'the other stick back', X: 'the other stick to the right',
};
const kHelixAdvance = 4, kHelixRotation = 5; // joints

/** A sentence about keys, for hands that have none. */
export const forHands = (text: string) => text.replace(/\b(press|hold|with) ([A-Z])\b/gi, (all, verb: string, key: string) => (kNames[key] ? `${verb} ${kNames[key]}` : all));

/** A controller or a hand, and how it was held in the frame before. */
interface Grip {
  ray: XRTargetRaySpace; space: XRGripSpace; figure: HandFigure; source: XRInputSource | null; held: boolean; pointed: Button | null;
  place: Vector3 | null; turn: Quaternion; pressed: boolean[];
}

export class Grips {
  readonly root = new Group(); // of what they look like, in the space of the headset
  readonly way = new Way(); // of the hand at the handle
  private from: (number | null)[] = []; // where joints were when the hand took the handle
  private behind = [0, 0]; // way that they have not followed since, in units of people
  private moved = 0; // the hand, the last time [ms]
  onView = () => {}; // buttons of a hand that holds nothing
  onRecentre = () => {};
  private grips: Grip[];
  private pointer = new Raycaster();

  constructor(xr: WebXRManager, private drive: Drive, private readings: Readings) {
    this.pointer.layers.set(kPlainLayer);
    this.grips = [0, 1].map((k) => this.makeGrip(xr, k));
  }

  /** Left and right, where they are there. */
  get hands() {
    return (['left', 'right'] as const).map((side) => this.grips.find(({ source, space }) => source?.handedness === side && space.visible) ?? null);
  }

  get pointed() {
    return this.grips.map(({ pointed }) => pointed);
  }

  get holding() {
    return this.grips.some(({ held }) => held);
  }

  private makeGrip(xr: WebXRManager, k: number): Grip {
    const grip: Grip = {
      ray: xr.getController(k), space: xr.getControllerGrip(k), figure: new HandFigure(xr, k, this.root), source: null, held: false, pointed: null,
      place: null, turn: new Quaternion(), pressed: [],
    };
    const release = () => (grip.held = false);
    grip.ray.addEventListener('connected', ({ data }) => (grip.source = data));
    grip.ray.addEventListener('disconnected', () => ((grip.source = null), release()));
    grip.ray.addEventListener('squeezestart', () => this.hold(grip));
    grip.ray.addEventListener('squeezeend', release);
    grip.ray.addEventListener('selectstart', () => {
      if (grip.pointed) grip.pointed.act();
      else if (grip.source?.hand) this.hold(grip); // hands pinch instead of squeezing
    });
    grip.ray.addEventListener('selectend', () => grip.source?.hand && release());
    this.root.add(grip.ray);
    return grip;
  }

  /** One hand holds the handle, whichever it is: left- and right-handed people need no setting. */
  private hold(grip: Grip) {
    for (const other of this.grips) other.held = other === grip;
    grip.place = null; // the next frame knows where the hand is now
    this.begin();
  }

  private begin() {
    this.way.begin();
    this.from = [...(this.drive.operator?.joints ?? [])];
    this.behind.fill(0);
  }

  release() {
    for (const grip of this.grips) grip.held = false;
    this.drive.headset.keys.clear();
    this.drive.headset.axes.fill(0);
    this.way.end();
  }

  /** @param force  of the tissue on the tool, which is felt [N] */
  read(force: number) {
    const { axes, keys } = this.drive.headset, { holding } = this;
    axes.fill(0, 2); // but insertion and rotation
    keys.clear();
    for (const grip of this.grips) {
      if (grip.held) this.moveHandle(grip);
      this.readPad(grip, axes, keys, force);
      grip.pointed = grip.held ? null : this.buttonBefore(grip);
      grip.figure.show(!!grip.source?.hand, grip.held ? Holds.Handle : holding ? Holds.Device : Holds.Nothing);
    }
    if (!holding) this.way.end();
  }

  private buttonBefore(grip: Grip): Button | null {
    if (!grip.source) return null;
    grip.ray.updateWorldMatrix(true, false);
    const [hit] = this.pointer.setFromXRController(grip.ray).intersectObject(this.readings);
    return hit?.uv ? this.readings.buttonAt(hit.uv) : null;
  }

  private moveHandle(grip: Grip) {
    if (grip.place) this.addWay(grip, grip.place);
    grip.place = grip.ray.position.clone();
    grip.turn.copy(grip.ray.quaternion);
  }

  private addWay(grip: Grip, place: Vector3) {
    const ahead = new Vector3(0, 0, -1).applyQuaternion(grip.turn);
    const along = grip.ray.position.clone().sub(place).dot(ahead);
    const turned = grip.turn.clone().invert().multiply(grip.ray.quaternion);
    const roll = 2 * Math.atan2(-turned.z, turned.w);
    this.way.add([along, Math.atan2(Math.sin(roll), Math.cos(roll))].map((part, joint) => part / kSpeeds[joint]));
    if (along !== 0 || roll !== 0) this.moved = performance.now();
  }

  /** Before the server is told what hands hold. */
  tellWay(seconds: number, period: number, silence: number) {
    if (!this.drive.driving) this.begin(); // then nothing is expected
    this.way.told(seconds, silence);
    this.way.next(Math.max(seconds, period), silence).forEach((axis, joint) => (this.drive.headset.axes[joint] = axis));
    if (this.holding || !this.rests) this.compare();
  }

  private get rests() {
    return performance.now() > this.moved + kRest;
  }

  private compare() {
    const joints = this.drive.operator?.joints ?? [];
    kUnits.forEach(([scale], joint) => {
      const [from, now] = [this.from[joint] ?? null, joints[joint] ?? null];
      if (from !== null && now !== null) this.behind[joint] = scale * Math.abs(this.way.hand[joint] * kSpeeds[joint] - (now - from));
    });
  }

  /** What the scope has not followed of the hand since it took the handle, as text. */
  get notFollowed() {
    const told = this.behind.map((way, joint) => way >= (this.rests ? kTold : kBehind[joint]));
    return this.behind.map((way, joint) => `${way.toFixed(0)} ${kUnits[joint][1]}`).filter((_, joint) => told[joint]).join(' and ');
  }

  // Without a hand at the handle the buttons are those of the room.
  private readPad(grip: Grip, axes: number[], keys: Set<number>, force: number) {
    const pad = grip.source?.gamepad;
    if (!pad) return;
    const pressed = (button: Pad) => (pad.buttons[button]?.pressed ?? false) && !grip.pressed[button];
    const { holding } = this;
    if (!holding && pressed(Pad.Lower)) this.onView();
    if (!holding && pressed(Pad.Upper)) this.onRecentre();
    if (holding) for (const [button, key] of grip.held ? kHandle : kDevice) if (pad.buttons[button]?.pressed) keys.add(key);
    const [across, up] = [pad.axes[2] ?? 0, -(pad.axes[3] ?? 0)];
    if (holding && !grip.held) {
      axes[kHelixAdvance] += up;
      axes[kHelixRotation] += across;
    } else {
      axes[3] -= across;
      axes[2] += up;
    }
    if (grip.held && force > 0.3) void pad.hapticActuators?.[0]?.pulse(Math.min(1, force / kStrong), 30);
    grip.pressed = pad.buttons.map((button) => button.pressed);
  }
}
