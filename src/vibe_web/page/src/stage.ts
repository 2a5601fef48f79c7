// What is drawn: the organ with the endoscope from outside, and the endoscope's picture, one large and one small.

import {
  AmbientLight, ArrowHelper, ColorManagement, DirectionalLight, Group, LinearSRGBColorSpace, Mesh, MeshBasicMaterial,
  OrthographicCamera, PerspectiveCamera, PlaneGeometry, Scene, Vector3, Vector4, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { DriverFigure } from './driver';
import { EndoscopeView } from './endoscope';
import type { Frame, Lens } from './messages';
import { kPlainLayer, Organ } from './organ';
import { Robot } from './robot';
import { smoke } from './shaders';
import { SutureView } from './sutures';

const kSizes = [720, 480, 320, 240]; // of the endoscope's picture: a larger one where drawing is quick, a smaller one where it takes too long [px]
const kFirstSize = 240; // the first picture is soon there
const kQuick = 15, kTooLong = 60; // [ms]
const kPatience = 20; // pictures before one of another size
const kAside = 0.35; // the organ from the middle, in edges of the endoscope's picture
const kArrow = 0.02; // length of a newton [m]
const kOrganAlone = new Vector3(0.4, -0.19, 0.08), kWithDriver = new Vector3(1, -0.6, 2.3); // camera from the organ [m]
const kLensFrame = 'scope_camera_optical', kTipFrame = 'scope_tip';

ColorManagement.enabled = false; // shaders give shades as screens show them

export class Stage {
  readonly scene = new Scene();
  readonly body = new Group(); // world of the simulator: x to the front, y to the left, z to the head
  readonly organ = new Organ();
  readonly robot = new Robot();
  readonly sutures = new SutureView();
  readonly driver = new DriverFigure(); // in a headset, as others see it
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(40, 1, 0.01, 10);
  readonly controls: OrbitControls;
  endoscope: EndoscopeView | null = null;
  endoscopeLarge = false;
  inset = { above: false, right: 8 }; // the small picture: whether it is above, and how far from the right [px]
  time = 0; // of the frame that is shown [s]
  dirty = true;
  drawMs = 0;
  counts = { calls: 0, triangles: 0 }; // of the last picture of each kind, summed
  private lens: Lens | null = null;
  private size = 0;
  private meanMs = 0; // to draw the endoscope's picture, of the last ones
  private ofThisSize = 0;
  private framed = -1;
  private drawnTime = NaN;
  private arrow = new ArrowHelper(new Vector3(1, 0, 0), new Vector3(), 0.01, 0xffd200);
  private screen = new Scene();
  private flat = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private picture = new Mesh(new PlaneGeometry(2, 2), new MeshBasicMaterial({ depthTest: false, depthWrite: false }));

  /** @param withDriver  looks from far enough away to see who drives in a headset */
  constructor(readonly canvas: HTMLCanvasElement, private fixedSize: number, withDriver = false) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    this.scene.add(this.body);
    this.body.add(this.organ.root, this.robot.root, this.sutures.root, this.arrow, this.driver);
    this.light();
    this.arrow.traverse((part) => part.layers.set(kPlainLayer));
    this.arrow.visible = false;
    this.robot.onLoad = () => this.refresh();
    this.camera.layers.set(kPlainLayer);
    this.camera.up.set(withDriver ? 1 : 0, 0, withDriver ? 0 : 1); // the patient lies there
    this.camera.position.copy(withDriver ? kWithDriver : kOrganAlone);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => (this.dirty = true));
    this.screen.add(this.picture);
    this.size = fixedSize || kFirstSize;
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  private light() {
    const key = new DirectionalLight(0xffffff, 2.2), fill = new AmbientLight(0xffffff, 0.9);
    key.position.set(1, -0.6, 1);
    for (const light of [key, fill]) {
      light.layers.enable(kPlainLayer);
      this.scene.add(light);
    }
  }

  setLens(lens: Lens) {
    this.lens = lens;
    this.makeEndoscope();
  }

  private makeEndoscope() {
    if (!this.lens) return;
    const part = this.size / this.lens.size;
    const scaled = (source: Lens['whole']) => ({ ...source, size: Math.round(source.size * part) });
    this.endoscope?.dispose();
    this.endoscope = new EndoscopeView(this.renderer, { ...this.lens, size: this.size, whole: scaled(this.lens.whole), middle: scaled(this.lens.middle) }, this);
    this.picture.material.map = this.endoscope.target.texture;
    this.picture.material.needsUpdate = true;
    this.drawnTime = NaN;
  }

  setFrame(frame: Frame) {
    if (frame.revision !== this.organ.revision) return;
    this.organ.setFrame(frame);
    this.sutures.moveBlood(this.organ.particles);
    this.robot.setJoints(frame.joints);
    smoke.value = [frame.smoke, frame.time % 1000, 0, 0];
    this.showForce(frame.wrench);
    if (this.framed !== frame.revision) this.lookAtOrgan(frame.revision);
    this.time = frame.time;
    this.dirty = true;
  }

  private showForce(wrench: Float32Array) {
    const force = new Vector3(...wrench.subarray(0, 3)), newton = force.length();
    this.arrow.visible = newton > 0.05 && this.robot.has(kTipFrame);
    if (!this.arrow.visible) return;
    const tip = this.robot.frame(kTipFrame);
    tip.updateWorldMatrix(true, false);
    const toBody = this.body.matrixWorld.clone().invert().multiply(tip.matrixWorld);
    this.arrow.position.setFromMatrixPosition(toBody);
    this.arrow.setDirection(force.transformDirection(toBody));
    this.arrow.setLength(Math.max(0.008, kArrow * newton), 0.006, 0.004);
  }

  private lookAtOrgan(revision: number) {
    this.framed = revision;
    const to = this.camera.position.clone().sub(this.controls.target);
    this.controls.target.copy(this.organ.centre);
    this.camera.position.copy(this.organ.centre).add(to);
    this.controls.update();
  }

  private resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (this.renderer.xr.isPresenting || !clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.dirty = true;
  }

  /** Both pictures anew, although the frame is the same: a simulator that pauses sends no other. */
  refresh() {
    this.drawnTime = NaN;
    this.dirty = true;
  }

  /** The endoscope's picture of the present frame, unless there is one. */
  drawEndoscope(stereo = false) {
    if (!this.endoscope || !this.robot.has(kLensFrame) || this.drawnTime === this.time) return;
    const begin = performance.now();
    this.endoscope.draw(this.robot.frame(kLensFrame), this.time, stereo);
    this.drawnTime = this.time;
    this.meanMs += 0.2 * (performance.now() - begin - this.meanMs);
    if (!this.fixedSize && ++this.ofThisSize >= kPatience) this.chooseSize();
  }

  private chooseSize() {
    const by = this.meanMs > kTooLong ? 1 : this.meanMs < kQuick ? -1 : 0, next = kSizes[kSizes.indexOf(this.size) + by];
    if (!next || by === 0) return;
    this.size = next;
    this.ofThisSize = 0;
    this.makeEndoscope();
  }

  draw() {
    if (!this.dirty || this.framed < 0) return;
    this.dirty = false;
    const begin = performance.now(), { renderer } = this;
    renderer.info.reset();
    this.drawEndoscope();
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const edge = Math.round((this.endoscopeLarge ? 0.3 : 0.42) * Math.min(width, height)), inset = new Vector4(width - edge - this.inset.right, this.inset.above ? height - edge - 8 : 8, edge, edge);
    const square = Math.min(width, height);
    renderer.setRenderTarget(null);
    renderer.setClearColor(0x101418, 1);
    renderer.setViewport(0, 0, width, height);
    renderer.setScissorTest(false);
    renderer.clear();
    if (this.endoscopeLarge) {
      this.drawPicture(new Vector4((width - square) / 2, (height - square) / 2, square, square));
      this.camera.clearViewOffset();
      this.drawOutside(inset);
    } else {
      const aside = this.endoscope ? kAside * edge : 0; // the organ beside or above the endoscope's picture
      this.camera.setViewOffset(width, height, width > height ? aside : 0, width > height ? 0 : this.inset.above ? -aside : aside, width, height);
      this.drawOutside(new Vector4(0, 0, width, height));
      this.drawPicture(inset);
    }
    this.counts = { calls: renderer.info.render.calls, triangles: renderer.info.render.triangles };
    this.drawMs = performance.now() - begin;
  }

  private drawOutside(place: Vector4) {
    this.camera.aspect = place.z / place.w;
    this.camera.updateProjectionMatrix();
    this.renderer.setViewport(place);
    this.renderer.setScissor(place);
    this.renderer.setScissorTest(true);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.setScissorTest(false);
  }

  private drawPicture(place: Vector4) {
    if (!this.endoscope) return;
    this.renderer.setViewport(place);
    this.renderer.render(this.screen, this.flat);
  }

  /** Level of red, green and blue of the endoscope's picture, rows from below: for pictures that are compared. */
  pictureBytes(): { size: number; bytes: Uint8Array } {
    const size = this.endoscope!.target.width, bytes = new Uint8Array(4 * size * size);
    this.renderer.readRenderTargetPixels(this.endoscope!.target, 0, 0, size, size, bytes);
    return { size, bytes };
  }
}

