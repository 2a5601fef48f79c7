// Head and hands of the person who drives in a headset: told to the server, and shown to those who look on.

import { BoxGeometry, CapsuleGeometry, Group, Matrix4, Mesh, MeshPhongMaterial, Quaternion, SphereGeometry, Vector3, type BufferGeometry, type Object3D } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { kPlainLayer } from './organ';

const kBytes = 96, kPoses = 12; // of the command, and where its poses begin
const kButtons = [0, 1, 3, 4, 5]; // of a pad: trigger, grip, stick, lower, upper

export interface Told { frame: Object3D; pad?: Gamepad }

/** Command 8 of src/protocol/command.hpp. @param world  of the simulator */
export function encodeDriver(head: Object3D, hands: (Told | null)[], world: Object3D): ArrayBuffer {
  const bytes = new ArrayBuffer(kBytes), view = new DataView(bytes), toWorld = world.matrixWorld.clone().invert();
  let present = 0, buttons = 0;
  [head, ...hands.map((hand) => hand?.frame)].forEach((frame, k) => {
    if (!frame) return;
    present |= 1 << k;
    poseOf(toWorld.clone().multiply(frame.matrixWorld)).forEach((number, at) => view.setFloat32(kPoses + 28 * k + 4 * at, number, true));
  });
  hands.forEach((hand, side) => {
    kButtons.forEach((button, k) => (buttons |= hand?.pad?.buttons[button]?.pressed ? 1 << (5 * side + k) : 0));
    [hand?.pad?.axes[2] ?? 0, -(hand?.pad?.axes[3] ?? 0)].forEach((share, k) => view.setInt16(4 + 4 * side + 2 * k, Math.round(32767 * share), true));
  });
  view.setUint8(0, 8);
  view.setUint8(1, present);
  view.setUint16(2, buttons, true);
  return bytes;
}

// Of a headset x is to the right, y up and -z ahead; of a pose x is ahead, y to the left and z up.
const kAxes = new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(new Vector3(0, 0, -1), new Vector3(-1, 0, 0), new Vector3(0, 1, 0)));

function poseOf(matrix: Matrix4): number[] {
  const place = new Vector3(), turn = new Quaternion();
  matrix.decompose(place, turn, new Vector3());
  return [...place.toArray(), ...turn.multiply(kAxes).normalize().toArray()];
}

/** The head with its headset, which faces x, and two hands, in the world of the simulator. */
export class DriverFigure extends Group {
  constructor() {
    super();
    const head = mergeGeometries([new SphereGeometry(0.09, 24, 16).scale(1, 0.85, 1.15), new BoxGeometry(0.08, 0.17, 0.09).translate(0.09, 0, 0.01)])!;
    const hand = () => new CapsuleGeometry(0.022, 0.08, 6, 16).rotateZ(Math.PI / 2);
    this.add(...[head, hand(), hand()].map((body: BufferGeometry, k) => new Mesh(body, new MeshPhongMaterial({ color: k === 0 ? 0x8fa3b0 : 0xd2a48c }))));
    for (const part of this.children) part.layers.set(kPlainLayer);
    this.set(new ArrayBuffer(4));
  }

  /** Message Viewer of src/protocol/viewer_poses.hpp. */
  set(bytes: ArrayBuffer) {
    const present = new Uint8Array(bytes)[1], poses = new Float32Array(bytes, 4);
    this.children.forEach((part, k) => {
      part.visible = (present & (1 << k)) > 0;
      if (!part.visible) return;
      part.position.fromArray(poses, 7 * k);
      part.quaternion.fromArray(poses, 7 * k + 3);
    });
  }
}
