// Of a surface only the triangles are drawn that a plane picture of the endoscope may show.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Matrix4, Mesh, type Camera } from 'three';

const kCircle = 1.43; // |x| + |y| beyond which no shader shows anything, in half pictures: a little more than sqrt(2 * 1.02)
const kOnLens = 0.0038, kBehindLens = 0.005; // what mucosa.vert brings before the lens: so far beside and behind it, at most [m]
const kHole = 0.999; // of the part in the middle that is not shown, so that rounding shows nothing

/** Vertices that stand in the same frame. */
export interface Standing { start: number; count: number; frame: Matrix4 }

export class SeenTriangles {
  private all: ArrayLike<number> = []; // corners of triangles
  private sides = new Uint16Array(0); // of each vertex: one bit for each side of what is shown, beyond which it is

  constructor(readonly mesh: Mesh) {}

  /** Shows a geometry instead of the last one, and gives it an index of its own. */
  show(geometry: BufferGeometry) {
    const { mesh } = this, count = geometry.getAttribute('position').count;
    mesh.geometry.dispose();
    mesh.geometry = geometry;
    this.all = geometry.index?.array ?? Uint32Array.from({ length: count }, (_, k) => k);
    this.sides = new Uint16Array(count);
    geometry.setIndex(new BufferAttribute(Uint32Array.from(this.all), 1).setUsage(DynamicDrawUsage));
    mesh.visible = this.all.length > 0;
  }

  /**
   * @param unseen  share of half the picture within which nothing of it is shown
   * @param parts   what may be in the picture
   */
  lookFrom(camera: Camera, unseen: number, parts: Standing[] = [{ start: 0, count: this.sides.length, frame: this.mesh.matrixWorld }]) {
    if (this.all.length === 0) return;
    const { all, sides, mesh } = this, index = mesh.geometry.index!, shown = index.array;
    const toPicture = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    sides.fill(1);
    const onLens = kOnLens * camera.projectionMatrix.elements[0];
    for (const part of parts) this.findSides(part, toPicture.clone().multiply(part.frame), unseen, onLens);
    let count = 0;
    for (let k = 0; k < all.length; k += 3) {
      const a = all[k], b = all[k + 1], c = all[k + 2];
      if (sides[a] & sides[b] & sides[c]) continue; // all beyond the same side
      shown[count++] = a;
      shown[count++] = b;
      shown[count++] = c;
    }
    index.clearUpdateRanges();
    index.addUpdateRange(0, count);
    index.needsUpdate = true;
    mesh.geometry.setDrawRange(0, count);
    mesh.visible = count > 0;
  }

  // What is beyond a side is convex: a triangle with its corners there is there.
  private findSides({ start, count }: Standing, { elements: m }: Matrix4, unseen: number, onLens: number) {
    const { sides } = this, p = this.mesh.geometry.getAttribute('position').array, hole = (kHole * unseen) ** 2;
    for (let v = start, i = 3 * start; v < start + count; v++, i += 3) {
      const x = m[0] * p[i] + m[4] * p[i + 1] + m[8] * p[i + 2] + m[12];
      const y = m[1] * p[i] + m[5] * p[i + 1] + m[9] * p[i + 2] + m[13];
      const w = m[3] * p[i] + m[7] * p[i + 1] + m[11] * p[i + 2] + m[15], corner = kCircle * w; // w: distance ahead
      sides[v] = w < 0 && w > -kBehindLens && x * x + y * y < onLens * onLens ? 0 : (w < 0 ? 1 : 0) | (x > w ? 2 : 0) | (x < -w ? 4 : 0) | (y > w ? 8 : 0) | (y < -w ? 16 : 0) |
        (x + y > corner ? 32 : 0) | (x + y < -corner ? 64 : 0) | (x - y > corner ? 128 : 0) | (x - y < -corner ? 256 : 0) |
        (w > 0 && x * x + y * y < hole * w * w ? 512 : 0);
    }
  }
}
