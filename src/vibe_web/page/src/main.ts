// The page: the session of a simulator, or a recording, in a browser.

import { savePicture, VideoRecorder } from './capture';
import { Drive } from './drive';
import { Headset } from './headset';
import { Kind, readFrame, readHeat, readShape, readSutures, readText, readTopology, type Frame, type SceneText } from './messages';
import { Panel } from './panel';
import { Stage } from './stage';
import { Stream } from './stream';
import { element } from './texts';

const kRate = 60; // frames asked for [Hz]
const kOtherTime = 10000, kSlow = 1000 / 60; // [ms]
const kTold = 500; // what is told of the link and the delay is renewed [ms]
const kSmall = matchMedia('(max-width: 50rem), (max-height: 30rem)'); // as in style.css
const kHeadsets = [['headset', 'immersive-vr'], ['passthrough', 'immersive-ar']] as const; // buttons
const options = new URLSearchParams(location.hash.slice(1));

const askPattern = () => fetch('pattern').then((answer) => (answer.ok ? answer.arrayBuffer() : null), () => null);
const pattern = askPattern(); // the largest part is asked for first; a server that has just begun may not have it yet
const canvas = element<HTMLCanvasElement>('canvas');
const stream = new Stream(options.get('token') ?? '', Number(options.get('rate') ?? kRate), (open, why) => {
  if (open) undrawn = 0;
  else drive.lost();
  panel.setLink(open, why);
});
const stage = makeStage(); // which takes long, while the stream opens
const drive = new Drive(stream);
const panel = new Panel(stream, drive);
const video = new VideoRecorder(canvas);
let scene: SceneText | null = null, headset: Headset | null = null, frame: Frame | null = null, complete = false;
let drawnAt = 0; // the last frame [ms]
let undrawn = 0; // frames that have come, and of which the server does not know that they are drawn

/** For tests and for the curious: what has been received and drawn. */
const stats = { frames: 0, drawn: 0, firstPicture: 0, latencies: [] as number[], received: () => stream.received };

function makeStage(): Stage {
  try {
    return new Stage(canvas, Number(options.get('size') ?? 0), options.get('view') === 'instructor');
  } catch (error) {
    stream.close();
    element('status').textContent = 'This browser draws nothing, because it has no WebGL 2; switch hardware acceleration on in its settings, or take another browser.';
    throw error;
  }
}

async function takeScene(text: SceneText) {
  scene = text;
  stage.robot.setScene(text);
  if (stage.endoscope) return;
  stage.setLens(text.lens);
  drive.setTable(text.keys);
  panel.showKeys(text.keys);
  headset = new Headset(stage, drive, stream, text);
  for (const [id, mode] of kHeadsets) element(id).hidden = !((await navigator.xr?.isSessionSupported(mode).catch(() => false)) ?? false);
  const bytes = (await pattern) ?? (await askPattern());
  if (!bytes) return panel.status('The server does not give the look of the mucosa; load this page again.');
  stage.organ.setPattern(new Uint8Array(bytes), text.pattern.size);
  complete = true;
  stage.refresh();
}

stream.on(Kind.Scene, (bytes) => void takeScene(readText(bytes)));
stream.on(Kind.Topology, (bytes) => stage.organ.setTopology(readTopology(bytes)));
stream.on(Kind.Frame, (bytes) => {
  frame = readFrame(bytes);
  stats.frames++;
  undrawn++;
  if (!document.hidden && !stage.renderer.xr.isPresenting) draw(); // an animation frame is up to one of the screen later
});

/** What is shown besides places. */
const onLook = (kind: Kind, set: (bytes: ArrayBuffer) => void) => stream.on(kind, (bytes) => {
  set(bytes);
  stage.refresh();
});
onLook(Kind.Folds, (bytes) => stage.organ.setFolds(bytes, scene?.tallest_fold ?? 0));
onLook(Kind.Heat, (bytes) => stage.organ.setHeat(readHeat(bytes)));
onLook(Kind.Sutures, (bytes) => stage.sutures.set(readSutures(bytes)));
onLook(Kind.Threads, (bytes) => stage.sutures.setThreads(readShape(bytes)));
stream.on(Kind.Viewer, (bytes) => {
  stage.driver.set(bytes);
  stage.driver.visible = !stage.renderer.xr.isPresenting; // else it is who looks
  stage.dirty = true;
});
onLook(Kind.Blood, (bytes) => stage.sutures.setBlood(readShape(bytes), stage.organ.particles));

drive.onChange = () => panel.showDriving();
element('swap').onclick = () => {
  stage.endoscopeLarge = !stage.endoscopeLarge;
  stage.dirty = true;
};
stage.endoscopeLarge = options.get('view') === 'endoscope';
element('control').onclick = () => {
  if (drive.driving) drive.giveBack();
  else drive.take();
  canvas.focus();
};
for (const [id, mode] of kHeadsets) element(id).onclick = async () => panel.status((await headset?.enter(mode)) ?? '');
element('picture').onclick = () => savePicture(canvas);
element('video').onclick = () => {
  video.toggle();
  element('video').setAttribute('aria-pressed', String(video.running));
};

function draw() {
  const shown = frame;
  if (shown) {
    frame = null;
    stage.setFrame(shown);
    const force = Math.hypot(...shown.wrench.subarray(0, 3));
    panel.showForce(force, Math.hypot(...shown.wrench.subarray(3, 6)));
    if (headset) headset.force = force;
  }
  if (stage.renderer.xr.isPresenting) headset?.draw();
  else stage.draw();
  tellDrawn();
  if (!shown || !complete) return;
  stats.drawn++;
  stats.firstPicture ||= performance.now();
  drawnAt = performance.now();
  stats.latencies.push(stream.now - 1000 * shown.time);
  if (stats.latencies.length > 600) stats.latencies.shift();
}
stage.renderer.setAnimationLoop(draw);

/** Then the server sends more: two frames may be on their way, but to a page that is slow only one, which else would wait here. */
function tellDrawn() {
  const kept = stage.drawMs > kSlow ? 1 : 0, told = Math.min(255, undrawn - kept);
  if (told <= 0) return;
  stream.send(Uint8Array.of(7, told));
  undrawn -= told;
}

setInterval(() => {
  const last = stats.latencies.slice(-15).sort((a, b) => a - b), delay = last[last.length >> 1];
  // a recording, and a simulation that is not in real time, have stamps of another time
  const known = delay >= 0 && delay < kOtherTime && performance.now() < drawnAt + kOtherTime / 2;
  panel.showHealth(stream.silence, known ? delay : NaN, stage.drawMs);
}, kTold);

/** The small picture is where no stick is: beside the right one, or above it. */
const arrange = new ResizeObserver(() => {
  const small = kSmall.matches, wide = canvas.clientWidth > canvas.clientHeight;
  stage.inset = { above: small, right: 8 + (small && wide ? element('move').offsetWidth : 0) };
  stage.dirty = true;
});
for (const part of [canvas, element('move')]) arrange.observe(part);

Object.assign(window, { vibe: { stage, stream, drive, stats, headset: () => headset, replay: () => panel.timeline.replay } });
