// The endoscope with its suturing device: the tree of its joints, and its parts.

import {
  Box3, BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, FrontSide, Frustum, Group, Matrix4, Mesh, MeshPhongMaterial,
  Quaternion, Skeleton, SkinnedMesh, Sphere, SphereGeometry, Vector3, type Bone, type Camera, type Object3D,
} from 'three';
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import type { Link, SceneText, Visual } from './messages';
import { kEndoscopeLayer, kPlainLayer } from './organ';
import type { Capsule } from './shadow';
import { SeenTriangles } from './seen';
import { kReach, materialOf, smoke } from './shaders';

const kColour = new Color(0.6, 0.6, 0.62), kShine = 0.5, kSharpness = 40;

interface Part { geometry: BufferGeometry; material: MeshPhongMaterial }

interface Placed extends Part { frame: Object3D }
interface Range { frame: Object3D; box: Box3; start: number; count: number } // vertices of a part, and the box around them

/** The part with what its vertices have to know: their bone, and how they shine. */
function boneOf({ geometry, material }: Placed, bone: number): BufferGeometry {
  const count = geometry.getAttribute('position').count, { r, g, b } = material.color;
  const put = (name: string, numbers: number[]) => {
    const size = numbers.length, repeated = Float32Array.from({ length: size * count }, (_, k) => numbers[k % size]);
    geometry.setAttribute(name, new BufferAttribute(repeated, size));
  };
  put('color', [r, g, b]);
  put('skinIndex', [bone, 0, 0, 0]);
  put('skinWeight', [1, 0, 0, 0]);
  put('part_shine', [material.specular.r]);
  put('part_sharpness', [Math.max(1, material.shininess)]);
  return geometry;
}

function rangesOf(parts: Placed[]): Range[] {
  let start = 0;
  return parts.map(({ frame, geometry }) => {
    const count = geometry.getAttribute('position').count;
    start += count;
    return { frame, box: geometry.boundingBox!, start: start - count, count };
  });
}

function bodyOf(visual: Visual): BufferGeometry | null {
  if (visual.sphere) return new SphereGeometry(visual.sphere[0], 24, 16);
  if (visual.cylinder) return new CylinderGeometry(visual.cylinder[0], visual.cylinder[0], visual.cylinder[1], 24).rotateX(Math.PI / 2);
  if (visual.box) return new BoxGeometry(...(visual.box as [number, number, number]));
  return null;
}

export class Robot {
  readonly root = new Group();
  capsules: Capsule[] = []; // that cast shadows
  onLoad: () => void = () => {}; // when its parts are there
  private frames = new Map<string, Object3D>();
  private moving: { link: Link; frame: Object3D; place: Vector3; turn: Quaternion; axis: Vector3 }[] = [];
  private names: string[] = [];
  private positions = new Map<string, number>();
  private meshes = new Map<string, Promise<Part[]>>();
  private known = '';
  private ranges: Range[] = [];
  private seen = new SeenTriangles(new Mesh()); // by the endoscope

  /** Takes over what has changed: the parts are loaded once. */
  setScene(scene: SceneText) {
    this.names = scene.joints ?? [];
    const robot = JSON.stringify([scene.robot, scene.base]);
    if (!scene.robot || robot === this.known) return;
    this.known = robot;
    this.root.clear();
    this.frames.clear();
    this.moving = [];
    this.ranges = [];
    for (const link of scene.robot.links) this.addLink(link);
    const base = scene.base;
    for (const frame of this.frames.values()) if (!frame.parent) this.root.add(frame);
    if (base) {
      this.frame(base.link).position.fromArray(base.place);
      this.frame(base.link).quaternion.fromArray(base.turn as [number, number, number, number]);
    }
    this.capsules = scene.robot.visuals.flatMap((visual) => this.capsulesOf(visual));
    void this.addVisuals(scene.robot.visuals);
  }

  frame(name: string): Object3D {
    let frame = this.frames.get(name);
    if (!frame) this.frames.set(name, (frame = new Group()));
    return frame;
  }

  has(name: string) {
    return this.frames.has(name);
  }

  setJoints(values: ArrayLike<number>) {
    this.names.forEach((name, k) => this.positions.set(name, values[k]));
    for (const { link, frame, place, turn, axis } of this.moving) {
      const by = this.positionOf(link);
      frame.position.copy(place);
      frame.quaternion.copy(turn);
      if (link.type === 'turn') frame.rotateOnAxis(axis, by);
      else frame.translateOnAxis(axis, by);
    }
  }

  private positionOf({ joint, mimic }: Link): number {
    const own = this.positions.get(joint);
    if (own !== undefined || !mimic) return own ?? 0;
    return (this.positions.get(mimic.joint) ?? 0) * mimic.factor + mimic.offset;
  }

  private addLink(link: Link) {
    const frame = this.frame(link.name);
    this.frame(link.parent).add(frame);
    frame.position.fromArray(link.place);
    frame.quaternion.fromArray(link.turn as [number, number, number, number]);
    if (link.type === 'fixed') return;
    this.moving.push({ link, frame, place: frame.position.clone(), turn: frame.quaternion.clone(), axis: new Vector3(...link.axis).normalize() });
  }

  private async addVisuals(visuals: Visual[]) {
    const { known } = this;
    const loaded = await Promise.all(visuals.map((visual) => this.partsOf(visual)));
    if (known !== this.known) return; // another robot has come meanwhile
    const parts = visuals.flatMap((visual, k) => loaded[k].map(({ geometry, material }) => {
      const placed = new Group();
      placed.position.fromArray(visual.place);
      placed.quaternion.fromArray(visual.turn as [number, number, number, number]);
      placed.scale.fromArray(visual.scale);
      placed.updateMatrix();
      const frame = this.rigid(visual.link, placed);
      return { frame, material, geometry: geometry.clone().applyMatrix4(placed.matrix) };
    }));
    if (parts.length > 0) this.addBody(parts);
    this.onLoad();
  }

  /** All links as the bones of one body, which is drawn at once: from outside, and as the endoscope sees it. */
  private addBody(parts: Placed[]) {
    const frames = [...new Set(parts.map(({ frame }) => frame))];
    for (const { geometry } of parts) geometry.computeBoundingBox();
    const geometry = mergeGeometries(parts.map((part) => boneOf(part, frames.indexOf(part.frame))))!;
    const seen = new BufferGeometry();
    seen.attributes = { ...geometry.attributes, part_colour: geometry.getAttribute('color') };
    this.ranges = rangesOf(parts);
    const skeleton = new Skeleton(frames as Bone[], frames.map(() => new Matrix4()));
    const plain = new MeshPhongMaterial({ vertexColors: true, specular: 0x555555, shininess: kSharpness });
    const lit = materialOf({
      vertex: 'surface.vert', fragment: 'instrument.frag', side: FrontSide, parts: ['colour', 'shine', 'sharpness'],
      uniforms: { smoke, reach: { value: kReach } },
    });
    const meshes = [new SkinnedMesh(geometry, plain), new SkinnedMesh(seen, lit)];
    this.seen = new SeenTriangles(meshes[1]);
    this.seen.show(seen);
    for (const mesh of meshes) {
      mesh.bind(skeleton, new Matrix4());
      mesh.frustumCulled = false;
      mesh.boundingSphere = new Sphere(); // else three.js looks for it, long
      mesh.layers.set(mesh.material === plain ? kPlainLayer : kEndoscopeLayer);
      this.root.add(mesh);
    }
  }

  /** @param unseen  share of half the picture within which nothing of it is shown */
  lookFrom(camera: Camera, unseen: number) {
    const view = new Frustum().setFromProjectionMatrix(camera.projectionMatrix), toView = new Matrix4();
    const inView = this.ranges.filter(({ frame, box }) => view.intersectsBox(box.clone().applyMatrix4(toView.multiplyMatrices(camera.matrixWorldInverse, frame.matrixWorld))));
    this.seen.lookFrom(camera, unseen, inView.map(({ frame, start, count }) => ({ start, count, frame: frame.matrixWorld })));
  }

  /** The frame above that moves: links that are fixed to it share its meshes. Moves `placed` into it. */
  private rigid(name: string, placed: Object3D): Object3D {
    let frame = this.frame(name);
    const moves = new Set(this.moving.map((each) => each.frame));
    while (!moves.has(frame) && frame.parent && frame.parent !== this.root) {
      frame.updateMatrix();
      placed.applyMatrix4(frame.matrix);
      placed.updateMatrix();
      frame = frame.parent;
    }
    return frame;
  }

  private capsulesOf({ link, place, turn, scale, capsules }: Visual): Capsule[] {
    const pose = new Matrix4().compose(new Vector3(...place), new Quaternion(...turn), new Vector3(...scale));
    return (capsules ?? []).map(([ax, ay, az, bx, by, bz, radius]) => ({
      frame: this.frame(link), from: new Vector3(ax, ay, az).applyMatrix4(pose), to: new Vector3(bx, by, bz).applyMatrix4(pose), radius: radius * scale[0],
    }));
  }

  private partsOf(visual: Visual): Promise<Part[]> {
    const body = bodyOf(visual);
    if (body) {
      body.deleteAttribute('uv');
      const material = new MeshPhongMaterial({ color: new Color(...(visual.colour as [number, number, number])), specular: new Color(kShine, kShine, kShine), shininess: kSharpness });
      return Promise.resolve([{ geometry: body.toNonIndexed(), material }]);
    }
    if (!visual.mesh) return Promise.resolve([]);
    const known = this.meshes.get(visual.mesh) ?? load(visual.mesh);
    this.meshes.set(visual.mesh, known);
    return known;
  }
}

const libraries = new Map<string, Promise<MTLLoader.MaterialCreator>>(); // several parts share one

function materialsOf(address: string): Promise<MTLLoader.MaterialCreator> {
  const read = async () => {
    const materials = new MTLLoader().parse(await (await fetch(address)).text(), '');
    materials.preload();
    return materials;
  };
  const known = libraries.get(address) ?? read();
  libraries.set(address, known);
  return known;
}

/** Colours of the files are used as they are, as Ogre does: they are no sRGB. */
async function load(path: string): Promise<Part[]> {
  const text = await (await fetch(path.slice(1))).text();
  const library = /^mtllib (\S+)/m.exec(text)?.[1];
  const loader = new OBJLoader();
  if (library) loader.setMaterials(await materialsOf(path.slice(1).replace(/[^/]*$/, library)));
  const parts: Part[] = [];
  loader.parse(text).traverse((object) => {
    if (!(object instanceof Mesh)) return;
    const all = (Array.isArray(object.material) ? object.material : [object.material]) as MeshPhongMaterial[];
    const geometry = object.geometry as BufferGeometry;
    geometry.deleteAttribute('uv');
    if (!geometry.getAttribute('normal')) geometry.computeVertexNormals();
    const groups = geometry.groups.length > 0 ? geometry.groups : [{ start: 0, count: Infinity, materialIndex: 0 }];
    for (const group of groups) {
      const material = all[group.materialIndex ?? 0] ?? new MeshPhongMaterial({ color: kColour });
      parts.push({ geometry: sliceOf(geometry, group.start, group.count), material });
    }
  });
  return parts;
}

function sliceOf(geometry: BufferGeometry, start: number, count: number): BufferGeometry {
  const slice = geometry.clone();
  slice.clearGroups();
  const end = Math.min(start + count, geometry.getAttribute('position').count);
  for (const name of ['position', 'normal']) {
    const whole = geometry.getAttribute(name);
    const part = whole.clone();
    part.array = whole.array.slice(3 * start, 3 * end);
    (part as { count: number }).count = end - start;
    slice.setAttribute(name, part as typeof whole);
  }
  for (const name of Object.keys(slice.attributes)) if (name !== 'position' && name !== 'normal') slice.deleteAttribute(name);
  return slice;
}
