// The organ at the end of a session, in its report: the page's view from outside, without server and network. The report
// has its numbers in the element organ-data (vibe_sessions/report/viewer.py).

import type { Sutures } from './messages';
import { Stage } from './stage';

interface Data {
  lowest: number[]; step: number[]; // of the places, as in a frame of the server
  places: string; rest: string; triangles: string; grades: string; // base64 of u16[3 n], f32[3 n] [m], u32[3 t], u8[n]
  sutures: Sutures;
}

const kRevision = 1;
const kNear = 0.75; // of the distance in the page: without the scope the organ may fill the view
const canvas = document.getElementById('organ-canvas') as HTMLCanvasElement;

const bytesOf = (text: string) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;

function show(stage: Stage, data: Data) {
  const rest = new Float32Array(bytesOf(data.rest)), particles = rest.length / 3, triangles = new Uint32Array(bytesOf(data.triangles));
  stage.organ.setTopology({
    revision: kRevision, particles, vertices: particles, particleTriangles: triangles, triangles, rest,
    offsets: Uint32Array.from({ length: particles + 1 }, (_, k) => k), weightParticles: Uint32Array.from({ length: particles }, (_, k) => k),
    weights: new Float32Array(particles).fill(1), mucosa: new Float32Array(8 * particles),
  });
  const grades = new Uint8Array(bytesOf(data.grades)), vertices = Uint32Array.from(grades.keys()).filter((v) => grades[v] > 0);
  stage.organ.setHeat({
    revision: kRevision, vertices, effects: Uint8Array.from(vertices, (v) => 255 - 85 * grades[v]), browned: new Uint8Array(vertices.length),
  });
  stage.sutures.set(data.sutures);
  stage.setFrame({
    revision: kRevision, time: 0, smoke: 0, lowest: Float32Array.from(data.lowest), step: Float32Array.from(data.step),
    wrench: new Float32Array(6), joints: new Float32Array(0), places: new Uint16Array(bytesOf(data.places)),
  });
}

try {
  const stage = new Stage(canvas, 0);
  stage.camera.position.multiplyScalar(kNear);
  show(stage, JSON.parse(document.getElementById('organ-data')!.textContent!));
  stage.controls.enableZoom = false; // the wheel moves the page until somebody takes hold of the organ
  canvas.addEventListener('pointerdown', () => (stage.controls.enableZoom = true));
  canvas.addEventListener('pointerleave', () => (stage.controls.enableZoom = false));
  stage.renderer.setAnimationLoop(() => {
    stage.draw();
    canvas.dataset.triangles = String(stage.counts.triangles); // for tests
  });
} catch (error) {
  canvas.replaceWith(`This browser cannot draw the organ to turn (${error instanceof Error ? error.message : error}); it needs WebGL 2.`);
}
