// Threads, T-tags, cinches, bites and bleeding: from outside drawn here, with the tension of threads as their colour; as
// the endoscope sees them, the shapes of vibe_graphics, which the server sends.

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Vector3 } from 'three';
import { CylinderGeometry, SphereGeometry, type Camera, type Material } from 'three';
import type { Shape as SentShape, Sutures } from './messages';
import { kEndoscopeLayer, kPlainLayer } from './organ';
import { SeenTriangles } from './seen';
import { kReach, materialOf, smoke } from './shaders';

const kThread = 0.16e-3; // radius of 2-0 polypropylene [m]
const kEmphasis = 3; // of the view from outside, as in vibe.rviz
const kSides = 6;
const kCell = 0.008; // of the grid in which neighbours are found [m]
const kSteel = [0.72, 0.72, 0.74, 0.5], kPolymer = [0.85, 0.86, 0.88, 1];
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
    geometry.setAttribute('color', new BufferAttribute(new Float32Array(this.colours), 4));
    geometry.setIndex(this.triangles);
    return geometry;
  }
}

const kFull = [0.1, 0.75, 0.3, 1], kPartial = [0.95, 0.55, 0.1, 1], kBleeding = [0.7, 0.03, 0.03, 1], kStopped = [0.3, 0.12, 0.08, 1];

/** A shape whose vertices go where the points go that were nearest to them when it was sent. */
class Follower {
  private nearest: Uint32Array;

  constructor(private places: Float32Array, private points: Float32Array) {
    this.nearest = nearestOf(places, points);
  }

  move(mesh: Mesh, points: Float32Array) {
    const { places, nearest } = this, position = mesh.geometry.getAttribute('position') as BufferAttribute;
    if (points.length !== this.points.length || points.length === 0) return;
    for (let k = 0; k < places.length; k++) {
      const from = 3 * nearest[Math.floor(k / 3)] + (k % 3);
      position.array[k] = places[k] + points[from] - this.points[from];
    }
    position.needsUpdate = true;
  }
}

/** For each place the nearest of the points, which is looked for in its cell and in those around. */
function nearestOf(places: Float32Array, points: Float32Array): Uint32Array {
  const cells = new Map<number, number[]>(), all = Array.from({ length: points.length / 3 }, (_, k) => k);
  const key = (of: Float32Array, k: number, x = 0, y = 0, z = 0) =>
    ((Math.floor(of[k] / kCell) + x) * 1009 + Math.floor(of[k + 1] / kCell) + y) * 1009 + Math.floor(of[k + 2] / kCell) + z;
  for (const k of all) cells.set(key(points, 3 * k), [...(cells.get(key(points, 3 * k)) ?? []), k]);
  const steps = [-1, 0, 1];
  return Uint32Array.from({ length: places.length / 3 }, (_, vertex) => {
    const v = 3 * vertex, near = steps.flatMap((x) => steps.flatMap((y) => steps.flatMap((z) => cells.get(key(places, v, x, y, z)) ?? [])));
    let nearest = 0, least = Infinity;
    for (const k of near.length > 0 ? near : all) {
      const x = points[3 * k] - places[v], y = points[3 * k + 1] - places[v + 1], z = points[3 * k + 2] - places[v + 2];
      const squared = x * x + y * y + z * z;
      if (squared < least) [nearest, least] = [k, squared];
    }
    return nearest;
  });
}

export class SutureView {
  readonly root = new Group();
  private threads: Follower | null = null; // by the lines of the sutures
  private pools: Follower | null = null; // blood, by the wall
  private line = new Float32Array(0); // of all threads, as last sent
  private plain = this.mesh(kPlainLayer, new MeshBasicMaterial({ vertexColors: true }));
  private natural = new SeenTriangles(this.mesh(kEndoscopeLayer, materialOf({
    vertex: 'surface.vert', fragment: 'suture.frag', side: DoubleSide, uniforms: { reach: { value: kReach }, smoke },
  })));
  private blood = new SeenTriangles(this.mesh(kEndoscopeLayer, materialOf({
    vertex: 'surface.vert', fragment: 'blood.frag', side: DoubleSide, transparent: true, uniforms: { reach: { value: kReach }, smoke },
  })));

  /** @param unseen  share of half the picture within which nothing of it is shown */
  lookFrom(camera: Camera, unseen: number) {
    for (const each of [this.natural, this.blood]) each.lookFrom(camera, unseen);
  }

  private mesh(layer: number, material: Material): Mesh {
    const mesh = new Mesh(new BufferGeometry(), material);
    mesh.layers.set(layer);
    mesh.frustumCulled = false;
    mesh.visible = false;
    this.root.add(mesh);
    return mesh;
  }

  set(sutures: Sutures) {
    this.plain.geometry.dispose();
    this.plain.geometry = this.shapeOf(sutures).geometry();
    this.plain.visible = this.plain.geometry.index!.count > 0;
    this.line = Float32Array.from(sutures.sets.flatMap((set) => set.threads.flatMap(({ points }) => Array.from(points))));
    this.threads?.move(this.natural.mesh, this.line); // else another shape will come
  }

  setThreads(shape: SentShape) {
    this.natural.show(geometryOf(shape));
    this.threads = new Follower(shape.places, shape.points);
    this.threads.move(this.natural.mesh, this.line);
  }

  /** @param wall  places of its particles now */
  setBlood(shape: SentShape, wall: Float32Array) {
    this.blood.show(geometryOf(shape));
    this.pools = shape.places.length > 0 && wall.length > 0 ? new Follower(shape.places, wall.slice()) : null;
  }

  moveBlood(wall: Float32Array) {
    this.pools?.move(this.blood.mesh, wall);
  }

  private shapeOf(sutures: Sutures): Shape {
    const shape = new Shape();
    for (const set of sutures.sets) {
      for (const { tension, points } of set.threads) {
        const line = Array.from({ length: points.length / 3 }, (_, k) => new Vector3().fromArray(points, 3 * k));
        if (line.length > 1) shape.tube(line, kThread * kEmphasis, tensionColour(tension));
      }
      if (set.tTag) shape.body(at(new CylinderGeometry(0.45e-3, 0.45e-3, 6.5e-3, 10), set.tTag), kSteel);
      if (set.cinch) shape.body(at(new CylinderGeometry(0.95e-3, 1.3e-3, 6e-3, 12), set.cinch), kPolymer);
      for (const bite of set.bites) shape.body(at(new SphereGeometry(1.5e-3, 8, 6), bite.place), bite.full ? kFull : kPartial);
    }
    for (const wound of sutures.wounds) shape.body(at(new SphereGeometry(woundRadius(wound.amount), 16, 10), wound.place), wound.rate > 0 ? kBleeding : kStopped);
    return shape;
  }
}

const at = <T extends BufferGeometry>(body: T, place: number[]): T => body.translate(place[0], place[1], place[2]);

/** Of a ball with a third of what is lost, so that it is seen from outside [m]. */
const woundRadius = (millilitres: number) => Math.min(0.02, 0.01 * Math.cbrt(0.3 * millilitres + 0.02));

function geometryOf({ places, triangles, colours, normals }: SentShape): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(places.slice(), 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  geometry.setAttribute('vertex_colour', new BufferAttribute(colours, 4, true));
  geometry.setAttribute('texcoord0', new BufferAttribute(new Float32Array(places.length), 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}
