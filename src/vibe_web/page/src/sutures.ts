// Threads, T-tags, cinches, bites and bleeding. Sizes are those of vibe_graphics/geometry/suture_shapes.hpp.

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Vector3 } from 'three';
import { CylinderGeometry, SphereGeometry, type Material } from 'three';
import type { Sutures } from './messages';
import { kEndoscopeLayer, kPlainLayer } from './organ';
import { kReach, materialOf, smoke } from './shaders';

const kThread = 0.16e-3; // radius of 2-0 polypropylene [m]
const kEmphasis = 3; // of the view from outside, as in vibe.rviz
const kSides = 6;
const kNatural = [0.12, 0.3, 0.85, 1], kSteel = [0.72, 0.72, 0.74, 0.5], kPolymer = [0.85, 0.86, 0.88, 1];
const kStrong = 8; // tension at the end of the colours [N]

/** From blue (slack) over yellow to red. */
function tensionColour(tension: number): number[] {
  if (tension <= 0) return [0.93, 0.95, 1, 1];
  const t = Math.min(1, tension / kStrong);
  return [Math.min(1, 0.15 + 1.7 * t), 0.85 - 0.7 * Math.abs(t - 0.4), Math.max(0.1, 0.9 - 2 * t), 1];
}

class Shape {
  private positions: number[] = [];
  private normals: number[] = [];
  private colours: number[] = [];
  private triangles: number[] = [];

  tube(points: Vector3[], radius: number, colour: number[]) {
    const first = this.positions.length / 3, along = new Vector3(), side = new Vector3(), up = new Vector3(), out = new Vector3();
    points.forEach((point, k) => {
      along.subVectors(points[Math.min(k + 1, points.length - 1)], points[Math.max(k - 1, 0)]).normalize();
      if (k === 0) side.set(Math.abs(along.x) < 0.8 ? 1 : 0, Math.abs(along.x) < 0.8 ? 0 : 1, 0);
      side.addScaledVector(along, -side.dot(along)).normalize();
      up.crossVectors(along, side);
      for (let s = 0; s < kSides; s++) {
        const angle = (2 * Math.PI * s) / kSides;
        out.copy(side).multiplyScalar(Math.cos(angle)).addScaledVector(up, Math.sin(angle));
        this.positions.push(point.x + radius * out.x, point.y + radius * out.y, point.z + radius * out.z);
        this.normals.push(out.x, out.y, out.z);
        this.colours.push(...colour);
      }
    });
    for (let k = 0; k + 1 < points.length; k++)
      for (let s = 0; s < kSides; s++) {
        const a = first + k * kSides + s, b = first + k * kSides + ((s + 1) % kSides);
        this.triangles.push(a, b, a + kSides, b, b + kSides, a + kSides);
      }
  }

  body(geometry: BufferGeometry, colour: number[]) {
    const first = this.positions.length / 3, count = geometry.getAttribute('position').count;
    this.positions.push(...geometry.getAttribute('position').array);
    this.normals.push(...geometry.getAttribute('normal').array);
    for (let k = 0; k < count; k++) this.colours.push(...colour);
    for (const corner of geometry.index!.array) this.triangles.push(first + corner);
    geometry.dispose();
  }

  geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.setAttribute('normal', new BufferAttribute(new Float32Array(this.normals), 3));
    const colours = new Float32Array(this.colours);
    geometry.setAttribute('vertex_colour', new BufferAttribute(colours, 4));
    geometry.setAttribute('color', new BufferAttribute(colours, 4));
    geometry.setAttribute('texcoord0', new BufferAttribute(new Float32Array(this.positions.length), 3));
    geometry.setIndex(this.triangles);
    return geometry;
  }
}

function bloodColour(amount: number, stopped: boolean): number[] {
  return stopped ? [0.3, 0.12, 0.08, 0.8] : [Math.max(0.45, 0.75 - 0.05 * amount), 0.03, 0.03, 0.95];
}

export class SutureView {
  readonly root = new Group();
  private plain = this.mesh(kPlainLayer, new MeshBasicMaterial({ vertexColors: true }));
  private natural = this.mesh(kEndoscopeLayer, materialOf({
    vertex: 'surface.vert', fragment: 'suture.frag', side: DoubleSide, uniforms: { reach: { value: kReach }, smoke },
  }));
  private blood = this.mesh(kEndoscopeLayer, materialOf({
    vertex: 'surface.vert', fragment: 'blood.frag', side: DoubleSide, transparent: true, uniforms: { reach: { value: kReach }, smoke },
  }));

  private mesh(layer: number, material: Material): Mesh {
    const mesh = new Mesh(new BufferGeometry(), material);
    mesh.layers.set(layer);
    mesh.frustumCulled = false;
    mesh.visible = false;
    this.root.add(mesh);
    return mesh;
  }

  set(sutures: Sutures) {
    this.replace(this.plain, this.shapeOf(sutures, kEmphasis, (tension) => tensionColour(tension), true));
    this.replace(this.natural, this.shapeOf(sutures, 1, () => kNatural, false));
    const blood = new Shape();
    for (const wound of sutures.wounds) blood.body(pool(wound.place, wound.amount), bloodColour(wound.amount, wound.rate <= 0));
    this.replace(this.blood, blood);
  }

  private replace(mesh: Mesh, shape: Shape) {
    mesh.geometry.dispose();
    mesh.geometry = shape.geometry();
    mesh.visible = mesh.geometry.index!.count > 0;
  }

  private shapeOf(sutures: Sutures, emphasis: number, colour: (tension: number) => number[], symbols: boolean): Shape {
    const shape = new Shape();
    for (const set of sutures.sets) {
      for (const { tension, points } of set.threads) {
        const line = Array.from({ length: points.length / 3 }, (_, k) => new Vector3().fromArray(points, 3 * k));
        if (line.length > 1) shape.tube(line, kThread * emphasis, colour(tension));
      }
      if (set.tTag) shape.body(new CylinderGeometry(0.45e-3, 0.45e-3, 6.5e-3, 10).translate(...(set.tTag as [number, number, number])), kSteel);
      if (set.cinch) shape.body(new CylinderGeometry(0.95e-3, 1.3e-3, 6e-3, 12).translate(...(set.cinch as [number, number, number])), kPolymer);
      if (symbols)
        for (const bite of set.bites)
          shape.body(new SphereGeometry(1.5e-3, 8, 6).translate(...(bite.place as [number, number, number])), bite.full ? [0.1, 0.75, 0.3, 1] : [0.95, 0.55, 0.1, 1]);
    }
    if (symbols) for (const wound of sutures.wounds) shape.body(pool(wound.place, wound.amount), bloodColour(wound.amount, wound.rate <= 0));
    return shape;
  }
}

/** Simple: as much as is lost, in a flat ball around the wound. */
function pool(place: number[], amount: number): BufferGeometry {
  const radius = Math.min(0.02, 0.01 * Math.cbrt(0.3 * amount + 0.02));
  return new SphereGeometry(radius, 16, 10).translate(...(place as [number, number, number]));
}
