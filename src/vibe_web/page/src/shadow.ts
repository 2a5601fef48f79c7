// The shadows of the device on the wall: capsules in the view of the lens, as graphics/endoscope_lamp (DeviceShadow) sends
// them to shadow.glsl.

import { Matrix4, Vector3, type Camera, type Object3D } from 'three';

const kMaxCapsules = 12; // as in shadow.glsl
const kBehind = 0.0005; // parts nearer to the lens hold lens and guides, or stand behind them [m]
const kGuides = [new Vector3(0.0035, 0.0012, 0), new Vector3(-0.0035, 0.0012, 0)]; // as in lamp.glsl

export interface Capsule { frame: Object3D; from: Vector3; to: Vector3; radius: number }

function distance(from: Vector3, to: Vector3, place: Vector3): number {
  const along = to.clone().sub(from), aside = place.clone().sub(from);
  const t = Math.min(1, Math.max(0, along.dot(aside) / Math.max(along.lengthSq(), 1e-12)));
  return aside.addScaledVector(along, -t).length();
}

/** Fills the numbers of the shader; returns how many capsules there are. */
export function castShadow(capsules: Capsule[], camera: Camera, numbers: Float32Array): number {
  const toView = new Matrix4(), lens = new Vector3();
  const seen = capsules.map(({ frame, from, to, radius }) => {
    toView.multiplyMatrices(camera.matrixWorldInverse, frame.matrixWorld);
    return { from: from.clone().applyMatrix4(toView), to: to.clone().applyMatrix4(toView), radius };
  }).filter(({ from, to, radius }) => Math.min(from.z, to.z) <= -kBehind && kGuides.every((guide) => distance(from, to, guide) >= radius + kBehind));
  const width = ({ from, to, radius }: (typeof seen)[0]) =>
    (radius * (radius + from.distanceTo(to))) / from.clone().add(to).multiplyScalar(0.5).distanceToSquared(lens);
  const widest = seen.sort((a, b) => width(b) - width(a)).slice(0, kMaxCapsules);
  numbers.fill(0);
  widest.forEach(({ from, to, radius }, k) => numbers.set([from.x, from.y, from.z, radius, to.x, to.y, to.z, 0], 8 * k));
  return widest.length;
}
