// The organ: its drawn surface from the positions of the particles, as vibe_graphics/geometry/deformable_surface does it.

import {
  BackSide, BufferAttribute, BufferGeometry, Data3DTexture, DynamicDrawUsage, FrontSide, Group, InterleavedBuffer,
  InterleavedBufferAttribute, LinearFilter, LinearMipmapNearestFilter, Mesh, RepeatWrapping, RGBAFormat, UnsignedByteType,
  Vector2, Vector3, type Camera, type RawShaderMaterial,
} from 'three';
import type { Frame, Heat, Topology } from './messages';
import { SeenTriangles } from './seen';
import { kReach, materialOf, smoke } from './shaders';

export const kPlainLayer = 3, kEndoscopeLayer = 4; // 1 and 2 are what only the left and the right eye of a headset see

// What vibe.material and vibe_graphics/src/graphics/tissue_visual.cpp say of the natural look.
const kInside = [0.86, 0.47, 0.42, 1];
const kRelief = 0.0006, kFill = 0.16, kWetness = 0.4;
const kOutside = [0.84, 0.62, 0.56, 0.15], kEdgeAlpha = 0.9, kGrain = 0.25;

function tissueMaterial(inside: boolean): RawShaderMaterial {
  return materialOf({
    vertex: 'surface.vert', fragment: 'tissue.frag', side: inside ? BackSide : FrontSide, transparent: !inside,
    uniforms: {
      side: { value: inside ? -1 : 1 }, tint: { value: inside ? kInside : kOutside },
      edge_alpha: { value: inside ? 1 : kEdgeAlpha }, wet: { value: kWetness * (inside ? 1 : 0.6) }, relief: { value: kRelief },
      grain: { value: kGrain }, fill: { value: kFill }, scars: { value: 1 }, reach: { value: 0 },
    },
  });
}

export class Organ {
  readonly root = new Group();
  readonly mucosa: RawShaderMaterial;
  readonly centre = new Vector3();
  revision = -1;
  private topology: Topology | null = null;
  private geometry = new BufferGeometry();
  particles = new Float32Array(0); // their places
  private normals = new Float32Array(0);
  private plain: Mesh[];
  private natural: SeenTriangles;

  constructor() {
    this.mucosa = materialOf({
      vertex: 'mucosa.vert', fragment: 'mucosa.frag', side: BackSide, defines: { SMOKE: '1' },
      uniforms: {
        tint: { value: kInside }, wet: { value: 1.3 * kWetness }, relief: { value: kRelief }, grain: { value: 1 },
        fill: { value: kFill }, scars: { value: 1 }, reach: { value: kReach }, window: { value: new Vector2(1, 1) },
        unseen: { value: 0 }, pattern: { value: null }, smoke, eye: { value: new Vector3() },
        pattern_shift: { value: new Vector3() }, capsules: { value: new Float32Array(96) }, capsule_count: { value: 0 },
      },
    });
    this.plain = [true, false].map((inside) => new Mesh(this.geometry, tissueMaterial(inside)));
    this.plain[1].renderOrder = 10; // what is transparent last
    this.natural = new SeenTriangles(new Mesh(this.geometry, this.mucosa));
    for (const mesh of [...this.plain, this.natural.mesh]) {
      mesh.layers.set(mesh === this.natural.mesh ? kEndoscopeLayer : kPlainLayer);
      mesh.frustumCulled = false;
      this.root.add(mesh);
    }
  }

  setPattern(bytes: Uint8Array, size: number) {
    const texture = new Data3DTexture(bytes, size, size, size);
    texture.format = RGBAFormat;
    texture.type = UnsignedByteType;
    texture.wrapS = texture.wrapT = texture.wrapR = RepeatWrapping;
    texture.magFilter = LinearFilter;
    texture.minFilter = LinearMipmapNearestFilter;
    texture.generateMipmaps = true;
    texture.needsUpdate = true;
    this.mucosa.uniforms.pattern.value = texture;
  }

  setTopology(topology: Topology) {
    this.topology = topology;
    this.revision = topology.revision;
    const count = topology.vertices, geometry = new BufferGeometry();
    const moving = (size: number) => new BufferAttribute(new Float32Array(size * count), size).setUsage(DynamicDrawUsage);
    geometry.setIndex(new BufferAttribute(topology.triangles, 1));
    geometry.setAttribute('position', moving(3));
    geometry.setAttribute('normal', moving(3));
    geometry.setAttribute('vertex_colour', new BufferAttribute(new Uint8Array(4 * count).fill(255), 4, true));
    geometry.setAttribute('texcoord0', new BufferAttribute(topology.rest, 3));
    const mucosa = new InterleavedBuffer(topology.mucosa, 8);
    geometry.setAttribute('texcoord1', new InterleavedBufferAttribute(mucosa, 4, 0));
    geometry.setAttribute('texcoord2', new InterleavedBufferAttribute(mucosa, 4, 4));
    geometry.setAttribute('texcoord3', moving(1));
    geometry.setAttribute('texcoord4', moving(1));
    this.geometry = geometry;
    const coarse = new BufferGeometry(); // from outside the particles' own mesh is fine enough: it has a quarter of the triangles
    coarse.attributes = geometry.attributes;
    coarse.setIndex(particlesComeFirst(topology) ? new BufferAttribute(topology.particleTriangles, 1) : new BufferAttribute(topology.triangles, 1));
    for (const mesh of this.plain) {
      mesh.geometry.dispose();
      mesh.geometry = coarse;
    }
    this.natural.show(geometry);
    this.particles = new Float32Array(3 * topology.particles);
    this.normals = new Float32Array(3 * topology.particles);
  }

  setFrame(frame: Frame) {
    if (!this.topology || frame.revision !== this.revision) return;
    const { places, lowest, step } = frame, p = this.particles;
    for (let i = 0; i < p.length; i++) p[i] = lowest[i % 3] + step[i % 3] * places[i];
    this.centre.set(...([0, 1, 2].map((k) => lowest[k] + 32767 * step[k]) as [number, number, number]));
    this.findNormals(this.topology.particleTriangles);
    this.moveVertices(this.topology);
  }

  /** @param unseen  share of half the picture within which nothing of it is shown */
  lookFrom(camera: Camera, unseen: number) {
    this.mucosa.uniforms.unseen.value = unseen;
    this.natural.lookFrom(camera, unseen);
  }

  setFolds(bytes: ArrayBuffer, tallest: number) {
    const heights = new Uint8Array(bytes, 8), fold = this.geometry.getAttribute('texcoord3') as BufferAttribute;
    if (new Uint32Array(bytes, 4, 1)[0] !== this.revision || !fold) return;
    for (let v = 0; v < heights.length; v++) fold.array[v] = (heights[v] * tallest) / 255;
    fold.needsUpdate = true;
  }

  setHeat({ revision, vertices, effects, browned }: Heat) {
    const colour = this.geometry.getAttribute('vertex_colour') as BufferAttribute;
    const brown = this.geometry.getAttribute('texcoord4') as BufferAttribute;
    if (revision !== this.revision || !colour) return;
    colour.array.fill(255);
    brown.array.fill(0);
    vertices.forEach((vertex, k) => {
      colour.array[4 * vertex + 3] = effects[k];
      brown.array[vertex] = (3 * browned[k]) / 255;
    });
    colour.needsUpdate = brown.needsUpdate = true;
  }

  get triangles() {
    return this.topology ? this.topology.triangles.length / 3 : 0;
  }

  /** Means over triangles, weighted with their areas. */
  private findNormals(triangles: Uint32Array) {
    const p = this.particles, n = this.normals.fill(0);
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (const k of [a, b, c]) { n[k] += x; n[k + 1] += y; n[k + 2] += z; }
    }
    normalise(n);
  }

  private moveVertices({ offsets, weightParticles, weights, vertices }: Topology) {
    const position = this.geometry.getAttribute('position') as BufferAttribute;
    const normal = this.geometry.getAttribute('normal') as BufferAttribute;
    const x = position.array as Float32Array, n = normal.array as Float32Array, p = this.particles, q = this.normals;
    x.fill(0);
    n.fill(0);
    for (let v = 0; v < vertices; v++)
      for (let k = offsets[v]; k < offsets[v + 1]; k++) {
        const w = weights[k], i = 3 * weightParticles[k];
        for (let d = 0; d < 3; d++) { x[3 * v + d] += w * p[i + d]; n[3 * v + d] += w * q[i + d]; }
      }
    normalise(n);
    position.needsUpdate = normal.needsUpdate = true;
  }
}

/** Whether vertex v is that of particle v, as Loop's scheme numbers them. */
function particlesComeFirst({ particles, offsets, weightParticles, weights }: Topology): boolean {
  for (let v = 0; v < particles; v++) {
    let largest = offsets[v];
    for (let k = offsets[v]; k < offsets[v + 1]; k++) if (weights[k] > weights[largest]) largest = k;
    if (weightParticles[largest] !== v) return false;
  }
  return true;
}

function normalise(n: Float32Array) {
  for (let i = 0; i < n.length; i += 3) {
    const length = Math.hypot(n[i], n[i + 1], n[i + 2]) || 1;
    n[i] /= length; n[i + 1] /= length; n[i + 2] /= length;
  }
}
