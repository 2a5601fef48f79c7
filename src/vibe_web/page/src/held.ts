// What hands look like in the room of a headset: controllers, the joints of hands that are tracked, and what they hold.

import {
  BoxGeometry, CylinderGeometry, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, SphereGeometry, TorusGeometry, Vector3, type Group, type WebXRManager,
} from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { kPlainLayer } from './organ';
import { shaded } from './room';

const kBeam = 0.5; // length [m]
const kJoints = 25, kRadius = 0.009; // of a hand, at most [m]: its joints, not its flesh
const kDark = 0x2a2f34, kLight = 0xd0d6da, kTip = 0x4d9de0, kSkin = 0xd2a48c;

// In the frame of a grip the hand closes around z, and the thumb is at -z.
const rod = (radius: number, length: number, colour: number) => shaded(new CylinderGeometry(radius, radius, length, 16).rotateX(Math.PI / 2), colour);
const wheel = (radius: number, x: number, colour: number) => shaded(new CylinderGeometry(radius, radius, 0.01, 24).rotateZ(Math.PI / 2).translate(x, 0, -0.05), colour);
const controller = () => mergeGeometries([
  rod(0.016, 0.1, kDark), shaded(new SphereGeometry(0.018, 16, 12).translate(0, 0, -0.05), kLight),
  shaded(new TorusGeometry(0.035, 0.005, 8, 24).translate(0, 0.02, -0.05), kDark),
]);

/** The control body of the scope with its two wheels; the shaft begins below the hand. */
const handle = () => mergeGeometries([
  shaded(new CylinderGeometry(0.016, 0.022, 0.16, 20).rotateX(-Math.PI / 2), kDark), rod(0.0065, 0.3, kDark).translate(0, 0, 0.22),
  wheel(0.032, 0.028, kLight), wheel(0.022, 0.041, kDark),
]);

/** The handle of the suturing device with its lever. */
const device = () => mergeGeometries([
  rod(0.011, 0.13, kLight), shaded(new BoxGeometry(0.012, 0.07, 0.014).rotateX(-0.4).translate(0, -0.04, 0.03), kTip), rod(0.004, 0.1, kDark).translate(0, 0, 0.11),
]);

/** Along a ray, to point with. */
const beam = () => rod(0.0012, kBeam, kTip).translate(0, 0, -kBeam / 2);

export enum Holds { Nothing, Handle, Device }

export class HandFigure {
  private material = new MeshBasicMaterial({ vertexColors: true });
  private bodies = [controller(), handle(), device()].map((body) => new Mesh(body, this.material)); // as Holds says
  private beam = new Mesh(beam(), this.material);
  private joints = new InstancedMesh(shaded(new SphereGeometry(1, 10, 8), kSkin), this.material, kJoints);

  constructor(private xr: WebXRManager, private k: number, root: Group) {
    const grip = xr.getControllerGrip(k);
    for (const part of [...this.bodies, this.beam, this.joints]) part.layers.set(kPlainLayer);
    this.joints.frustumCulled = false;
    grip.add(...this.bodies);
    xr.getController(k).add(this.beam);
    root.add(grip, this.joints);
  }

  /** @param isHand  tracked, without a controller */
  show(isHand: boolean, holds: Holds) {
    this.bodies.forEach((body, k) => (body.visible = k === holds && !(isHand && holds === Holds.Nothing)));
    this.beam.visible = holds === Holds.Nothing;
    const place = new Matrix4();
    this.joints.count = 0;
    if (isHand) for (const joint of Object.values(this.xr.getHand(this.k).joints)) {
      if (!joint?.visible) continue;
      place.compose(joint.position, joint.quaternion, new Vector3().setScalar(Math.min(joint.jointRadius ?? kRadius, kRadius)));
      this.joints.setMatrixAt(this.joints.count++, place);
    }
    this.joints.instanceMatrix.needsUpdate = true;
    this.joints.visible = this.joints.count > 0;
  }
}
