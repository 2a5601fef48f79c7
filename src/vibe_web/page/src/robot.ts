// The endoscope with its suturing device: the tree of its joints, and its parts.

import {
  BoxGeometry, Color, CylinderGeometry, Float32BufferAttribute, FrontSide, Group, Matrix4, Mesh, MeshPhongMaterial, Quaternion, Skeleton,
  SkinnedMesh, SphereGeometry, Uint16BufferAttribute, Vector3, type Bone,
  type BufferGeometry, type Object3D,
} from 'three';
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import type { Link, SceneText, Visual } from './messages';
import { kEndoscopeLayer, kPlainLayer } from './organ';
import type { Capsule } from './shadow';
import { kReach, materialOf, smoke } from './shaders';

const kColour = new Color(0.6, 0.6, 0.62), kShine = 0.5, kSharpness = 40;

interface Part { geometry: BufferGeometry; material: MeshPhongMaterial }

function bodyOf(visual: Visual): BufferGeometry | null {
  if (visual.sphere) return new SphereGeometry(visual.sphere[0], 24, 16);
  if (visual.cylinder) return new CylinderGeometry(visual.cylinder[0], visual.cylinder[0], visual.cylinder[1], 24).rotateX(Math.PI / 2);
  if (visual.box) return new BoxGeometry(...(visual.box as [number, number, number]));
  return null;
}

export class Robot {
  readonly root = new Group();
  capsules: Capsule[] = []; // that cast shadows
  private frames = new Map<string, Object3D>();
  private moving: { link: Link; frame: Object3D; place: Vector3; turn: Quaternion; axis: Vector3 }[] = [];
  private names: string[] = [];
  private positions = new Map<string, number>();
  private meshes = new Map<string, Promise<Part[]>>();
  private known = '';

  /** Takes over what has changed: the parts are loaded once. */
  setScene(scene: SceneText) {
    this.names = scene.joints ?? [];
    const robot = JSON.stringify([scene.robot, scene.base]);
    if (!scene.robot || robot === this.known) return;
    this.known = robot;
    this.root.clear();
    this.frames.clear();
    this.moving = [];
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

  /** One mesh for each link and material, so that few are drawn. */
  private async addVisuals(visuals: Visual[]) {
    const { known } = this;
    const parts = new Map<string, { frame: Object3D; material: MeshPhongMaterial; geometries: BufferGeometry[] }>();
    const loaded = await Promise.all(visuals.map((visual) => this.partsOf(visual)));
    for (const [k, visual] of visuals.entries())
      for (const { geometry, material } of loaded[k]) {
        const placed = new Group();
        placed.position.fromArray(visual.place);
        placed.quaternion.fromArray(visual.turn as [number, number, number, number]);
        placed.scale.fromArray(visual.scale);
        placed.updateMatrix();
        const frame = this.rigid(visual.link, placed);
        const key = frame.uuid + material.color.getHexString() + material.shininess;
        const part = parts.get(key) ?? { frame, material, geometries: [] };
        part.geometries.push(geometry.clone().applyMatrix4(placed.matrix));
        parts.set(key, part);
      }
    if (known !== this.known) return; // another robot has come meanwhile
    const whole = [...parts.values()].map(({ frame, material, geometries }) => ({ frame, material, geometry: mergeGeometries(geometries)! }));
    for (const { frame, material, geometry } of whole) this.addLit(frame, geometry, material);
    if (whole.length > 0) this.addPlain(whole);
  }

  /** From outside: all links as the bones of one mesh, which is drawn at once. */
  private addPlain(parts: { frame: Object3D; material: MeshPhongMaterial; geometry: BufferGeometry }[]) {
    const frames = [...new Set(parts.map(({ frame }) => frame))];
    const geometry = mergeGeometries(parts.map(({ frame, material, geometry: part }) => {
      const bone = part.clone(), count = part.getAttribute('position').count, { r, g, b } = material.color;
      const repeated = (numbers: number[]) => Array.from({ length: count }, () => numbers).flat();
      bone.setAttribute('color', new Float32BufferAttribute(repeated([r, g, b]), 3));
      bone.setAttribute('skinIndex', new Uint16BufferAttribute(repeated([frames.indexOf(frame), 0, 0, 0]), 4));
      bone.setAttribute('skinWeight', new Float32BufferAttribute(repeated([1, 0, 0, 0]), 4));
      return bone;
    }))!;
    const mesh = new SkinnedMesh(geometry, new MeshPhongMaterial({ vertexColors: true, specular: 0x555555, shininess: kSharpness }));
    mesh.bind(new Skeleton(frames as Bone[], frames.map(() => new Matrix4())), new Matrix4());
    mesh.frustumCulled = false;
    mesh.layers.set(kPlainLayer);
    this.root.add(mesh);
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

  /** As the endoscope sees it: each material by itself. */
  private addLit(frame: Object3D, geometry: BufferGeometry, material: MeshPhongMaterial) {
    const { color, specular, shininess } = material;
    const lit = new Mesh(geometry, materialOf({
      vertex: 'surface.vert', fragment: 'instrument.frag', side: FrontSide,
      uniforms: {
        colour: { value: color.toArray() }, shine: { value: specular.r }, sharpness: { value: Math.max(1, shininess) },
        smoke, reach: { value: kReach },
      },
    }));
    lit.layers.set(kEndoscopeLayer);
    frame.add(lit);
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

/** Colours of the files are used as they are, as Ogre does: they are no sRGB. */
async function load(path: string): Promise<Part[]> {
  const text = await (await fetch(path.slice(1))).text();
  const library = /^mtllib (\S+)/m.exec(text)?.[1];
  const loader = new OBJLoader();
  if (library) {
    const materials = new MTLLoader().parse(await (await fetch('mesh/' + library)).text(), '');
    materials.preload();
    loader.setMaterials(materials);
  }
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
