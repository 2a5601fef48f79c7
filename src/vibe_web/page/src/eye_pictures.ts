// The endoscope's picture in the room of a headset: on a monitor, or on a part of a ball around the viewer.

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, type Texture } from 'three';

const kRings = 24, kSectors = 64; // of the ball
const kMiddle = 0.55; // share of its rings that are its middle, which leaves the edge of the eye at rest

/** The picture as the lens took it, on a part of a ball around the eye: equidistant, so angles are true. */
export function dome(fieldOfView: number, radius: number): BufferGeometry {
  const place: number[] = [], uv: number[] = [], triangles: number[] = [];
  for (let r = 0; r <= kRings; r++)
    for (let s = 0; s < kSectors; s++) {
      const share = r / kRings, theta = (share * fieldOfView) / 2, phi = (2 * Math.PI * s) / kSectors;
      place.push(radius * Math.sin(theta) * Math.cos(phi), radius * Math.sin(theta) * Math.sin(phi), -radius * Math.cos(theta));
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

/** A picture of each eye, at one place. */
export class EyePictures extends Group {
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

  /** Of a dome: all of it, or its middle. */
  showMiddle(alone: boolean) {
    for (const { geometry } of this.eyes) geometry.setDrawRange(0, 6 * kSectors * (alone ? Math.round(kMiddle * kRings) : kRings));
  }

  show(pictures: Texture[]) {
    this.eyes.forEach(({ material }, eye) => {
      if (material.map === pictures[eye]) return;
      material.map = pictures[eye];
      material.needsUpdate = true;
    });
  }
}
