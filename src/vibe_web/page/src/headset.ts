// The session in a headset, through WebXR: a room with the endoscope's picture on a monitor, the organ as a model to walk
// around, and hands that hold the handle of the scope.

import { Group, Vector3 } from 'three';
import type { Drive } from './drive';
import { encodeDriver } from './driver';
import { forHands, Grips } from './grips';
import type { SceneText } from './messages';
import { kPlainLayer } from './organ';
import { pageSays, type Button, type Said } from './readings';
import { Room, View } from './room';
import type { Stage } from './stage';
import type { Stream } from './stream';

const kSlow = 0.1; // from one picture to the next [s]
const kViews: Record<View, string> = { [View.Monitor]: 'monitor', [View.Around]: 'all around', [View.Middle]: 'middle' };

export class Headset {
  readonly room: Room;
  readonly grips: Grips;
  private inside = new Group(); // all that is seen in the headset only
  stereo = false; // endoscopes have one lens
  force = 0; // [N]
  private last = 0; // [ms]
  private period = 0.011; // of the headset's frames [s]
  private placed = false;
  private passThrough = false;

  constructor(private stage: Stage, private drive: Drive, private stream: Stream, private scene: SceneText) {
    const { xr } = stage.renderer;
    xr.enabled = true;
    xr.setReferenceSpaceType('local-floor');
    this.room = new Room(scene.lens.field_of_view);
    this.grips = new Grips(xr, drive, this.room.readings);
    this.inside.add(this.room, this.grips.root);
    this.inside.visible = false;
    stage.scene.add(this.inside);
    this.grips.onView = () => this.nextView();
    this.grips.onRecentre = () => this.recentre();
    drive.onSend = (seconds) => this.tell(seconds);
    xr.addEventListener('sessionstart', () => this.begin());
    xr.addEventListener('sessionend', () => this.end());
  }

  /** Asked by a click; says why not in one sentence. */
  async enter(mode: XRSessionMode): Promise<string> {
    const { xr } = this.stage.renderer;
    if (xr.isPresenting) return (await xr.getSession()?.end(), '');
    try {
      const session = await navigator.xr!.requestSession(mode, { optionalFeatures: ['local-floor', 'hand-tracking'] });
      this.passThrough = session.environmentBlendMode !== undefined && session.environmentBlendMode !== 'opaque';
      await xr.setSession(session);
      return '';
    } catch (error) {
      return `The browser cannot enter a headset (${(error as Error).message}); is one connected, and is the address https?`;
    }
  }

  private begin() {
    const { room, stage } = this;
    this.placed = false;
    this.inside.visible = true;
    room.passThrough = this.passThrough;
    room.show(View.Monitor);
    room.model.add(stage.body);
    this.last = performance.now();
    if (!this.drive.driving) this.drive.take();
  }

  private end() {
    this.inside.visible = false;
    this.stage.scene.add(this.stage.body);
    this.stage.body.position.set(0, 0, 0);
    this.grips.release();
    this.stage.refresh();
  }

  /** Puts the room in front of the eyes, at their height: sitting or standing. */
  recentre() {
    const camera = this.stage.renderer.xr.getCamera();
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld), ahead = new Vector3(0, 0, -1).transformDirection(camera.matrixWorld);
    if (eye.lengthSq() === 0) return;
    this.room.place(eye, ahead);
    this.placed = true;
  }

  /** Called for each frame of the headset. */
  draw() {
    const { stage, room, grips } = this, { renderer } = stage, now = performance.now();
    this.period = (now - this.last) / 1000;
    this.last = now;
    if (!this.placed) this.recentre();
    stage.body.position.copy(stage.organ.centre).negate(); // the model stands where its middle is
    grips.read(this.force);
    room.readings.show(this.says(), this.buttons(), grips.pointed);
    const two = this.stereo && room.view === View.Monitor;
    renderer.info.reset();
    room.model.visible = true; // the endoscope is in it
    stage.drawEndoscope(two);
    room.model.visible = room.view === View.Monitor;
    const { endoscope } = stage;
    if (endoscope) room.showPictures([endoscope.target.texture, (two ? endoscope.right : endoscope.target).texture]);
    renderer.xr.getCamera().layers.enable(kPlainLayer);
    stage.camera.layers.set(kPlainLayer);
    renderer.setClearColor(room.background, this.passThrough ? 0 : 1);
    renderer.clear();
    renderer.render(stage.scene, stage.camera);
    stage.counts = { calls: renderer.info.render.calls, triangles: renderer.info.render.triangles };
    stage.drawMs = performance.now() - now;
  }

  /** What the page says, and besides who drives, and what was not followed. */
  private says(): Said {
    const { drive, grips } = this, said = pageSays(), lost = grips.notFollowed;
    const reason = this.period > kSlow ? 'Slow picture' : 'Too fast, or at a limit';
    const now = drive.driving ? `You drive. ${forHands(said.now)}` : drive.taken ? 'Another page drives.' : 'Nobody drives: take control to move the scope.';
    return { ...said, now, urgent: lost ? `${reason}: ${lost} of the hand were not followed. ${said.urgent}` : said.urgent };
  }

  private buttons(): Button[] {
    const { drive, room } = this;
    const toggleStereo = () => {
      this.stereo = !this.stereo;
      this.stage.refresh();
    };
    return [
      { text: drive.driving ? 'Give control back' : 'Take control', act: () => (drive.driving ? drive.giveBack() : drive.take()) },
      { text: `View: ${kViews[room.view]}`, act: () => this.nextView() },
      { text: this.stereo ? 'Two lenses' : 'One lens', act: toggleStereo },
      { text: 'Recentre', act: () => this.recentre() },
      { text: 'Leave', act: () => void this.stage.renderer.xr.getSession()?.end() },
    ];
  }

  /** Regularly: the way of the hand to the drive, and to the server where head and hands are. */
  private tell(seconds: number) {
    const { xr } = this.stage.renderer;
    if (!xr.isPresenting) return;
    this.grips.tellWay(seconds, this.period, this.scene.silence);
    if (!this.drive.driving) return;
    const hands = this.grips.hands.map((hand) => hand && { frame: hand.space, pad: hand.source?.gamepad });
    this.stream.send(encodeDriver(xr.getCamera(), hands, this.stage.body));
  }

  /** The picture on the monitor, all around the eyes, or its middle there. */
  nextView() {
    this.room.show((this.room.view + 1) % 3);
  }
}
