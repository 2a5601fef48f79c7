// How far ahead of a lens the wall is: two lenses are turned so that they meet there, and their pictures can be fused.

import { type Matrix4 } from 'three';

const kCone = Math.cos((15 * Math.PI) / 180); // around the middle of the picture
const kNearest = 0.008, kFarthest = 0.06, kUsual = 0.04; // [m]

/** Median distance along the view of the places around the middle of the picture [m]. @param toLens  z is behind the lens */
export function wallAhead(places: Float32Array, { elements: m }: Matrix4): number {
  const ahead: number[] = [];
  for (let i = 0; i < places.length; i += 3) {
    const [px, py, pz] = [places[i], places[i + 1], places[i + 2]];
    const x = m[0] * px + m[4] * py + m[8] * pz + m[12], y = m[1] * px + m[5] * py + m[9] * pz + m[13], z = m[2] * px + m[6] * py + m[10] * pz + m[14];
    if (-z > kCone * Math.hypot(x, y, z)) ahead.push(-z);
  }
  ahead.sort((a, b) => a - b);
  return Math.min(kFarthest, Math.max(kNearest, ahead[ahead.length >> 1] ?? kUsual));
}
