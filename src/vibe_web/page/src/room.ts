// The room of a headset: a monitor with readings, and before it the patient on a table, above whom the organ lies as a
// model of its true size. From no place within kReach of where the viewer began does anything stand before the monitor.

import {
  BoxGeometry, BufferAttribute, CapsuleGeometry, CircleGeometry, Color, CylinderGeometry, Group, Matrix4, Mesh, MeshBasicMaterial, PlaneGeometry,
  SphereGeometry, Vector3, type BufferGeometry, type Texture,
} from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { dome, EyePictures } from './eye_pictures';
import { kPlainLayer } from './organ';
import { Readings } from './readings';

export const kMonitor = 0.8, kMonitorAhead = 1.5; // its edge, and where it is in front of the eyes, at their height [m]
const kRim = 0.03, kGap = 0.28, kTurn = -0.35; // of the monitor; from its edge to the middle of the readings, turned to the viewer [m], [rad]
const kModelAhead = 0.75, kModelBelow = 0.58; // middle of the organ [m]
const kTorsoBelow = 0.77, kTableBelow = 0.91; // their middle [m]
const kDome = 1.6; // radius of the picture around the viewer [m]
const kNear = { ahead: 0.6, below: 0.95 }; // the readings beside that picture [m]
const kFloor = 3; // radius [m]
const kWallAhead = 2.3, kWallWidth = 4.4, kWallHeight = 2.7; // [m]

const kDim = 0x3a424b, kDark = 0x0a0c0e; // background of the room, and of the picture around the viewer
const kFloorColour = 0x59626a, kWall = 0x66727d, kSheet = 0x8099a8, kSkin = 0xc09a84, kSteel = 0x8d979f, kPillow = 0xb9c3c8;

export enum View { Monitor, Around, Middle }

/** A body of one colour, lighter from above: no lamp has to be computed. */
export function shaded(body: BufferGeometry, colour: number): BufferGeometry {
  const normal = body.getAttribute('normal'), { r, g, b } = new Color(colour);
  const light = (k: number) => [r, g, b][k % 3] * (0.7 + 0.3 * normal.getY(Math.floor(k / 3)));
  body.setAttribute('color', new BufferAttribute(Float32Array.from({ length: 3 * normal.count }, (_, k) => light(k)), 3));
  return body;
}

/** The patient lies on the back, the head to the left: a figure under a sheet, for the eye to know where it is. */
function patient(): BufferGeometry[] {
  const limb = (radius: number, length: number, x: number, z: number) => shaded(new CapsuleGeometry(radius, length, 6, 16).rotateZ(Math.PI / 2).translate(x, 0, z), kSheet);
  return [
    shaded(new SphereGeometry(0.095, 24, 16).scale(1.15, 1, 0.9).translate(-0.55, 0.02, 0), kSkin),
    shaded(new CapsuleGeometry(0.05, 0.1, 4, 12).rotateZ(Math.PI / 2).translate(-0.42, 0, 0), kSkin),
    shaded(new CapsuleGeometry(0.12, 0.5, 8, 24).rotateZ(Math.PI / 2).scale(1, 1, 1.35).translate(-0.05, 0, 0), kSheet),
    limb(0.075, 0.75, 0.6, -0.09), limb(0.075, 0.75, 0.6, 0.09), limb(0.045, 0.5, -0.05, -0.21), limb(0.045, 0.5, -0.05, 0.21),
    shaded(new BoxGeometry(0.26, 0.06, 0.4).translate(-0.58, -0.09, 0), kPillow),
  ];
}

/** What stands on the floor, for eyes at this height [m]. */
function furniture(eye: number): BufferGeometry {
  const table = eye - kTableBelow;
  const column = (radius: number, height: number, x: number, z: number) =>
    shaded(new CylinderGeometry(radius, radius, height, 24).translate(x, height / 2, z), kSteel);
  const foot = (x: number, z: number, width: number, depth: number) => shaded(new BoxGeometry(width, 0.05, depth).translate(x, 0.025, z), kSteel);
  const edge = kMonitor + 2 * kRim, behind = -kMonitorAhead - 0.06;
  return mergeGeometries([
    ...patient().map((part) => part.translate(0, eye - kTorsoBelow, -kModelAhead)),
    shaded(new BoxGeometry(2.1, 0.06, 0.62).translate(0.2, table, -kModelAhead), kSteel),
    column(0.09, table, 0.2, -kModelAhead), foot(0.2, -kModelAhead, 0.9, 0.5),
    column(0.035, eye - edge / 2, 0, behind), foot(0, behind, 0.6, 0.4),
    shaded(new BoxGeometry(kWallWidth, kWallHeight, 0.05).translate(0, kWallHeight / 2, -kWallAhead), kWall),
    shaded(new BoxGeometry(edge, edge, 0.05).translate(0, eye, -kMonitorAhead - 0.03), kDark),
  ])!;
}

const plain = (body: BufferGeometry) => {
  const mesh = new Mesh(body, new MeshBasicMaterial({ vertexColors: true }));
  mesh.layers.set(kPlainLayer);
  return mesh;
};

/** Becomes the background at its edge. */
function floor(): Mesh {
  const disc = new CircleGeometry(kFloor, 48).rotateX(-Math.PI / 2), count = disc.getAttribute('position').count;
  const shades = [new Color(kFloorColour), new Color(kDim)].map(({ r, g, b }) => [r, g, b]);
  disc.setAttribute('color', new BufferAttribute(Float32Array.from({ length: 3 * count }, (_, k) => shades[k < 3 ? 0 : 1][k % 3]), 3)); // the middle is first
  return plain(disc);
}

export class Room extends Group {
  readonly readings = new Readings();
  readonly model = new Group(); // of the organ, which lies as the patient does
  view = View.Monitor;
  passThrough = false; // the floor is that of the real room
  private floor = floor();
  private furniture = plain(furniture(1.6));
  private monitor = new EyePictures(new PlaneGeometry(kMonitor, kMonitor));
  private around: EyePictures;

  constructor(fieldOfView: number) {
    super();
    this.around = new EyePictures(dome(fieldOfView, kDome));
    // of the simulator x is to the front, which is up here, y to the left and z to the head
    this.model.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(new Vector3(0, 1, 0), new Vector3(0, 0, -1), new Vector3(-1, 0, 0)));
    this.add(this.floor, this.furniture, this.monitor, this.readings, this.around, this.model);
    this.show(View.Monitor);
  }

  /** Puts everything in front of the eyes and at their height: sitting or standing. */
  place(eye: Vector3, ahead: Vector3) {
    this.position.set(eye.x, 0, eye.z);
    this.rotation.y = Math.atan2(-ahead.x, -ahead.z);
    this.monitor.position.set(0, eye.y, -kMonitorAhead);
    this.around.position.set(0, eye.y, 0);
    this.model.position.set(0, eye.y - kModelBelow, -kModelAhead);
    this.furniture.geometry.dispose();
    this.furniture.geometry = furniture(eye.y);
    this.placeReadings();
  }

  show(view: View) {
    this.view = view;
    const onMonitor = view === View.Monitor;
    this.around.visible = !onMonitor;
    for (const part of [this.monitor, this.furniture, this.model]) part.visible = onMonitor; // else before or in the picture
    this.floor.visible = onMonitor && !this.passThrough;
    this.around.showMiddle(view === View.Middle);
    this.placeReadings();
  }

  private placeReadings() {
    const { readings, monitor, view } = this, eye = monitor.position.y;
    if (view === View.Monitor) readings.position.set(kMonitor / 2 + kRim + kGap, eye, -kMonitorAhead);
    else readings.position.set(0, eye - kNear.below, -kNear.ahead);
    readings.rotation.set(view === View.Monitor ? 0 : -Math.atan2(kNear.below, kNear.ahead), view === View.Monitor ? kTurn : 0, 0);
  }

  get background() {
    return this.view === View.Monitor ? kDim : kDark;
  }

  showPictures(pictures: Texture[]) {
    for (const each of [this.monitor, this.around]) each.show(pictures);
  }
}
