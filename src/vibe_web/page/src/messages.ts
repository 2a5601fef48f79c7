// What the server sends: the layouts are in src/vibe_web/src/protocol of the sources.

export enum Kind {
  Scene = 1, Topology, Frame, Folds, Heat, Sutures, State, Events, Replay, Operator, Pong, Refusal, Grant, Blood, Threads, Health, Viewer,
}

export interface Topology {
  revision: number;
  particles: number;
  vertices: number;
  particleTriangles: Uint32Array;
  triangles: Uint32Array;
  offsets: Uint32Array;
  weightParticles: Uint32Array;
  weights: Float32Array;
  rest: Float32Array;
  mucosa: Float32Array; // eight numbers per vertex
}

export interface Frame {
  revision: number;
  time: number; // [s]
  smoke: number; // [1/m]
  lowest: Float32Array;
  step: Float32Array;
  wrench: Float32Array; // [N], [N m]
  joints: Float32Array;
  places: Uint16Array;
}

export interface Heat { revision: number; vertices: Uint32Array; effects: Uint8Array; browned: Uint8Array }

export function readHeat(bytes: ArrayBuffer): Heat {
  const [revision, count] = new Uint32Array(bytes, 4, 2);
  return {
    revision, vertices: new Uint32Array(bytes, 12, count),
    effects: new Uint8Array(bytes, 12 + 4 * count, count), browned: new Uint8Array(bytes, 12 + 5 * count, count),
  };
}

export interface Thread { tension: number; points: ArrayLike<number> }
export interface Suture {
  stage: number;
  tTag: number[] | null;
  cinch: number[] | null;
  bites: { place: number[]; full: boolean }[];
  threads: Thread[];
}
export interface Wound { place: number[]; inward: number[]; brisk: boolean; rate: number; amount: number; age: number }
export interface Sutures { sets: Suture[]; wounds: Wound[] }

export function readTopology(bytes: ArrayBuffer): Topology {
  const [revision, particles, vertices, coarse, fine, weights] = new Uint32Array(bytes, 4, 6);
  let place = 28;
  const whole = (count: number) => { place += 4 * count; return new Uint32Array(bytes, place - 4 * count, count); };
  const real = (count: number) => { place += 4 * count; return new Float32Array(bytes, place - 4 * count, count); };
  return {
    revision, particles, vertices,
    particleTriangles: whole(3 * coarse), triangles: whole(3 * fine), offsets: whole(vertices + 1),
    weightParticles: whole(weights), weights: real(weights), rest: real(3 * vertices), mucosa: real(8 * vertices),
  };
}

export function readFrame(bytes: ArrayBuffer): Frame {
  const view = new DataView(bytes);
  const joints = view.getUint8(1), particles = view.getUint32(20, true);
  return {
    revision: view.getUint32(4, true), time: view.getFloat64(8, true), smoke: view.getFloat32(16, true),
    lowest: new Float32Array(bytes, 24, 3), step: new Float32Array(bytes, 36, 3), wrench: new Float32Array(bytes, 48, 6),
    joints: new Float32Array(bytes, 72, joints), places: new Uint16Array(bytes, 72 + 4 * joints, 3 * particles),
  };
}

export function readSutures(bytes: ArrayBuffer): Sutures {
  const numbers = new Float32Array(bytes, 4);
  let at = 0;
  const next = () => numbers[at++];
  const triple = () => [next(), next(), next()];
  const list = <T>(count: number, read: () => T) => Array.from({ length: count }, read);
  const sets = next(), wounds = next();
  const readThread = (): Thread => {
    const tension = next(), points = next();
    at += 3 * points;
    return { tension, points: numbers.slice(at - 3 * points, at) };
  };
  const readSet = (): Suture => {
    const stage = next(), hasTag = next(), tag = triple(), hasCinch = next(), cinch = triple();
    const bites = next(), threads = next();
    return {
      stage, tTag: hasTag ? tag : null, cinch: hasCinch ? cinch : null,
      bites: list(bites, () => ({ place: triple(), full: next() > 0 })), threads: list(threads, readThread),
    };
  };
  return {
    sets: list(sets, readSet),
    wounds: list(wounds, () => ({ place: triple(), inward: triple(), brisk: next() > 0, rate: next(), amount: next(), age: next() })),
  };
}

export interface Shape { places: Float32Array; points: Float32Array; triangles: Uint32Array; colours: Uint8Array; normals: Float32Array }

export function readShape(bytes: ArrayBuffer): Shape {
  const [vertices, corners, runs, points] = new Uint32Array(bytes, 4, 4), all = new Uint8Array(bytes), box = new Float32Array(bytes, 20, 6);
  const placesFrom = (start: number, count: number) => Float32Array.from(new Uint16Array(bytes, start, 3 * count), (place, k) => box[k % 3] + box[3 + (k % 3)] * place);
  const signed = new Int8Array(bytes, 44 + 6 * (vertices + points), 3 * vertices);
  let at = 44 + 9 * vertices + 6 * points;
  const whole = () => {
    for (let number = 0, scale = 1; ; scale *= 128) {
      number += (all[at] & 0x7f) * scale;
      if (all[at++] < 0x80) return number;
    }
  };
  const colours = new Uint8Array(4 * vertices), triangles = new Uint32Array(corners);
  for (let run = 0, vertex = 0; run < runs; run++) {
    const colour = all.subarray(at, (at += 4));
    for (let left = whole(); left > 0; left--) colours.set(colour, 4 * vertex++);
  }
  for (let k = 0, corner = 0; k < corners; k++) {
    const step = whole();
    triangles[k] = corner += step % 2 ? -(step + 1) / 2 : step / 2;
  }
  return { places: placesFrom(44, vertices), points: placesFrom(44 + 6 * vertices, points), triangles, colours, normals: Float32Array.from(signed, (n) => n / 127) };
}

// --- texts

export interface Link {
  name: string; parent: string; joint: string; type: 'turn' | 'slide' | 'fixed'; place: number[]; turn: number[]; axis: number[];
  mimic?: { joint: string; factor: number; offset: number };
}
export interface Visual {
  link: string; place: number[]; turn: number[]; scale: number[]; colour: number[];
  mesh?: string; capsules?: number[][]; sphere?: number[]; cylinder?: number[]; box?: number[];
}
export interface Source { half_width: number; size: number }
export interface Lens {
  size: number; field_of_view: number; whole: Source; middle: Source;
  exposure: { target: number; rate: number; gap: number; first: number; min: number; max: number };
}
export interface KeyTable {
  bindings: { key: number; kind: string; index: number; sign: number }[];
  rows: { caps: { key: number; label: string }[]; text: string }[];
}
export interface SceneText {
  name: string; revision: number; joints?: string[];
  base?: { link: string; place: number[]; turn: number[] };
  robot?: { links: Link[]; visuals: Visual[] };
  lens: Lens; keys: KeyTable; tallest_fold: number; pattern: { size: number }; silence: number;
}
export interface StateText {
  scene: string; time: number; paused: boolean; phase: string; tool: string; pressure: number; volume: number; marks: string;
  bites: number; sutures: number; cinched: number; bleeding: number; blood: number; needle: string;
  measures: { label: string; unit: string; decimals: number; value: number | null; range: string; rating: string; outside: boolean; explained: string }[];
  sets: { set: string; bites: string; technique: string; stage: string; tension: string; warns: boolean; help: string }[];
}
export interface EventText { number: number; time: number; severity: string; text: string }
export interface ReplayText { file: string; time: number; duration: number; playing: boolean; rate: number; marks: { time: number; text: string }[]; difference: string }
export interface OperatorText { seat: number; driving: boolean; trouble: string; step: string; keys: number[]; gear: number; buttons: boolean[]; joints: (number | null)[] }
export interface HealthText { text: string; alarm: boolean }
export interface GrantText { seat: number; grant: number }

export function readText<T>(bytes: ArrayBuffer): T {
  return JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 1))) as T;
}
