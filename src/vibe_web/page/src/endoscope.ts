// The endoscope's picture: two plane pictures, bent by the lens, as vibe_graphics/graphics/endoscope_lens does it.

import {
  FloatType, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, Mesh, OrthographicCamera, PerspectiveCamera, PlaneGeometry, Scene, Vector2, WebGLRenderTarget,
  type Object3D, type RawShaderMaterial, type WebGLRenderer, DoubleSide, BufferAttribute,
} from 'three';
import { wallAhead } from './convergence';
import { AutoExposure } from './exposure';
import type { Lens, Source } from './messages';
import { kEndoscopeLayer, type Organ } from './organ';
import type { Robot } from './robot';
import { castShadow } from './shadow';
import { materialOf } from './shaders';
import type { SutureView } from './sutures';

const kBase = 1 / 60; // from the left lens to the right one, in distances of the wall: then eyes can fuse also what is four times nearer
const kFollow = 0.1; // share of the way to where the lenses should meet, per picture: nothing jumps
const kMeter = 32; // edge of the picture that measures the level [px]

/** As unseenShare() of endoscope_lens.cpp: within this share of half the picture of the whole only that of the middle is shown. */
function unseenShare({ field_of_view, whole, middle }: Lens): number {
  if (middle.size === 0) return 0;
  const edge = 0.85 * middle.half_width; // kFirstBlend
  return Math.max(0, edge - ((1 + edge * edge) * field_of_view) / kMeter) / whole.half_width;
}

interface Subject { scene: Scene; organ: Organ; robot: Robot; sutures: SutureView }

const degrees = (halfWidth: number) => (2 * Math.atan(halfWidth) * 180) / Math.PI;

export class EndoscopeView {
  readonly camera = new PerspectiveCamera(90, 1, 0.0005, 2);
  readonly target: WebGLRenderTarget; // of the only lens, or the left one
  readonly right: WebGLRenderTarget;
  private meeting = 0; // where the views of both lenses meet [m]
  private whole: WebGLRenderTarget;
  private middle: WebGLRenderTarget;
  private meter = new WebGLRenderTarget(kMeter, kMeter);
  private quad: Mesh<PlaneGeometry, RawShaderMaterial>;
  private screen = new Scene();
  private flat = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private exposure: AutoExposure;
  private pixels = new Uint8Array(4 * kMeter * kMeter);

  constructor(private renderer: WebGLRenderer, private lens: Lens, private subject: Subject) {
    const type = renderer.extensions.has('EXT_color_buffer_float') && renderer.extensions.has('OES_texture_float_linear') ? FloatType : HalfFloatType;
    const plane = ({ size }: Source) => new WebGLRenderTarget(size, size, { type, minFilter: LinearFilter, magFilter: LinearFilter });
    this.whole = plane(lens.whole);
    this.middle = plane(lens.middle.size > 0 ? lens.middle : lens.whole);
    this.target = new WebGLRenderTarget(lens.size, lens.size, { depthBuffer: false, generateMipmaps: true, minFilter: LinearMipmapLinearFilter });
    this.right = this.target.clone();
    this.exposure = new AutoExposure(lens.exposure);
    this.camera.layers.set(kEndoscopeLayer);
    this.quad = new Mesh(new PlaneGeometry(2, 2), this.lensMaterial());
    const place = this.quad.geometry.getAttribute('uv').array as Float32Array;
    this.quad.geometry.setAttribute('texcoord0', new BufferAttribute(place, 2));
    this.quad.frustumCulled = false;
    this.screen.add(this.quad);
  }

  dispose() {
    for (const target of [this.whole, this.middle, this.meter, this.target, this.right]) target.dispose();
    this.quad.material.dispose();
  }

  private lensMaterial() {
    const { lens } = this;
    const material = materialOf({
      vertex: 'endoscope.vert', fragment: 'endoscope.frag', side: DoubleSide,
      uniforms: {
        picture: { value: this.whole.texture }, middle: { value: this.middle.texture }, picture_size: { value: new Vector2() },
        radius: { value: 0 }, half_angle: { value: lens.field_of_view / 2 }, equidistant: { value: 1 },
        source_half_width: { value: lens.whole.half_width }, source_size: { value: lens.whole.size },
        middle_half_width: { value: lens.middle.size > 0 ? lens.middle.half_width : 0 }, middle_size: { value: lens.middle.size },
        gain: { value: 1 },
      },
    });
    material.depthTest = material.depthWrite = false;
    return material;
  }

  /** Draws into `target` what the lens at this frame (z ahead, x right, y down) sees at this time [s], and into `right` what a second one beside it does. */
  draw(frame: Object3D, time: number, stereo: boolean) {
    const { renderer } = this;
    const wasXr = renderer.xr.enabled;
    renderer.xr.enabled = false;
    frame.updateWorldMatrix(true, false);
    this.subject.scene.updateMatrixWorld();
    this.drawEye(frame);
    do {
      this.bend(this.target, this.lens.size);
      this.exposure.see(this.level(), time);
    } while (this.exposure.isLost);
    if (stereo) {
      const { organ } = this.subject, there = wallAhead(organ.particles, this.camera.matrixWorldInverse.clone().multiply(organ.root.matrixWorld));
      this.meeting += (this.meeting > 0 ? kFollow : 1) * (there - this.meeting);
      this.drawEye(frame, kBase * this.meeting, kBase);
      this.bend(this.right, this.lens.size);
    }
    renderer.setRenderTarget(null);
    renderer.xr.enabled = wasXr;
  }

  /** The plane pictures of a lens that stands `aside` to the right, and is turned to the left by this angle [rad]. */
  private drawEye(frame: Object3D, aside = 0, turn = 0) {
    const { camera, subject } = this;
    frame.matrixWorld.decompose(camera.position, camera.quaternion, camera.scale);
    camera.rotateX(Math.PI);
    camera.translateX(aside);
    camera.rotateY(turn);
    camera.updateMatrixWorld();
    const { capsules: numbers, capsule_count: count } = subject.organ.mucosa.uniforms;
    count.value = castShadow(subject.robot.capsules, camera, numbers.value);
    this.drawPlane(this.whole, this.lens.whole.half_width, unseenShare(this.lens));
    if (this.lens.middle.size > 0) this.drawPlane(this.middle, this.lens.middle.half_width, 0);
  }

  private drawPlane(target: WebGLRenderTarget, halfWidth: number, unseen: number) {
    const { scene, organ, robot, sutures } = this.subject;
    this.camera.fov = degrees(halfWidth);
    this.camera.updateProjectionMatrix();
    for (const each of [organ, robot, sutures]) each.lookFrom(this.camera, unseen);
    organ.mucosa.uniforms.window.value.set(target.width, target.height);
    this.renderer.setRenderTarget(target);
    this.renderer.setClearColor(0, 1);
    this.renderer.clear();
    this.renderer.render(scene, this.camera);
  }

  private bend(target: WebGLRenderTarget | null, size: number) {
    const { uniforms } = this.quad.material;
    uniforms.picture_size.value.set(size, size);
    uniforms.radius.value = size / 2;
    uniforms.gain.value = this.exposure.gain;
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.screen, this.flat);
  }

  /** Mean of the picture, weighted to its centre, as EndoscopeLens::level(). */
  private level(): number {
    this.bend(this.meter, kMeter);
    this.renderer.readRenderTargetPixels(this.meter, 0, 0, kMeter, kMeter, this.pixels);
    let sum = 0, weights = 0;
    for (let y = 0; y < kMeter; y++)
      for (let x = 0; x < kMeter; x++) {
        const share = Math.hypot(x + 0.5 - kMeter / 2, y + 0.5 - kMeter / 2) / (kMeter / 2);
        if (share > 1) continue;
        const weight = 1 - 0.75 * share * share, at = 4 * (y * kMeter + x), p = this.pixels;
        sum += (weight * (0.299 * p[at] + 0.587 * p[at + 1] + 0.114 * p[at + 2])) / 255;
        weights += weight;
      }
    return sum / weights;
  }
}
