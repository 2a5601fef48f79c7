// What the page sends is what the person holds: random sequences of keys, pointers, focus, gamepad, headset and link, beside a
// model of what is physically held; and which sentence the page says. Needs no browser. Argument: number of sequences.

import { check, expect, load } from './checks.mjs';

const count = Number(process.argv[2]);
const { Hands, kLapse } = await load('hands'), { noticeOf } = await load('notice');

const kNames = { KeyW: 'w', KeyG: 'g', ArrowUp: 'ArrowUp', Space: ' ', Digit3: '3', ShiftLeft: 'Shift', ShiftRight: 'Shift', Enter: 'Enter', ControlLeft: 'Control', AltLeft: 'Alt', MetaLeft: 'Meta' };
const kNumbers = { KeyW: 87, KeyG: 71, ArrowUp: 0x01000013, Space: 32, Digit3: 51, ShiftLeft: 0x01000020, ShiftRight: 0x01000020 };
const kButtonKey = 73; // that the button of the page holds
const kModifiers = ['ControlLeft', 'AltLeft', 'MetaLeft'];
const kTick = 50, kTold = 300; // [ms]
const kTable = [...Object.values(kNumbers), kButtonKey];

/** Numbers that are the same in every run (mulberry32). */
function random(seed) {
  return (most) => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return Math.floor((((t ^ (t >>> 14)) >>> 0) / 4294967296) * most);
  };
}

/** A person with a keyboard, fingers and devices, and the browser that tells `hands` of them. Each thing knows when it was
 *  begun; it counts if nothing has ended all since. */
class Person {
  moment = 0;
  ended = { all: 0, keys: 0 };
  keys = new Map(); // code: { begun, number }
  pointers = new Map();
  devices = { pad: this.device(), headset: this.device() };
  padName = 'one';
  focus = 'page';
  focused = true;
  link = 'open';
  drives = true;
  now = 10000;

  constructor(hands, pick) {
    Object.assign(this, { hands, pick, mac: pick(2) === 0 });
    hands.known = new Set(kTable);
    this.settle();
  }

  device() {
    return { keys: new Set(), axes: [0, 0, 0, 0, 0, 0, 0], rested: -1 };
  }

  get open() {
    return this.drives && this.link === 'open';
  }

  tick() {
    this.hands.setOpen(this.open);
    this.hands.tick(this.now);
    const { pad, headset } = this.devices, copy = ({ keys, axes }) => ({ keys: new Set(keys), axes: [...axes] });
    this.hands.setPad(this.padName, this.padName ? copy(pad) : copy(this.device()));
    this.hands.headset.keys = new Set(headset.keys);
    this.hands.headset.axes = [...headset.axes];
    for (const device of Object.values(this.devices))
      if (device.keys.size === 0 && device.axes.every((axis) => axis === 0)) device.rested = this.moment;
    return this.hands.held();
  }

  settle() {
    let sent;
    for (const end = this.now + kTold; this.now < end; this.now += kTick) sent = this.tick();
    return sent;
  }

  expected() {
    const keys = new Set(), axes = [0, 0, 0, 0, 0, 0, 0];
    const add = (hand) => {
      hand.keys.forEach((key) => keys.add(key));
      hand.axes.forEach((axis, k) => (axes[k] += axis));
    };
    if (!this.open) return { keys, axes };
    for (const { begun, number } of this.keys.values())
      if (number && begun > Math.max(this.ended.all, this.ended.keys)) keys.add(number);
    for (const each of this.pointers.values()) if (each.counts && each.begun > this.ended.all) add(each);
    for (const [name, device] of Object.entries(this.devices))
      if (device.rested >= this.ended.all && (name !== 'pad' || this.padName)) add(device);
    return { keys, axes: axes.map((axis) => Math.min(1, Math.max(-1, axis))) };
  }

  get modified() {
    return kModifiers.some((code) => this.keys.has(code));
  }

  nameOf(code) {
    const shift = this.keys.has('ShiftLeft') || this.keys.has('ShiftRight');
    return !shift ? kNames[code] : code === 'Digit3' ? '#' : kNames[code].length === 1 ? kNames[code].toUpperCase() : kNames[code];
  }

  tellDown(code, repeat) {
    const own = this.focus === 'key button' && ['Enter', 'Space'].includes(code);
    if (this.focus !== 'page' && !own && ['Enter', 'Space', 'ArrowUp'].includes(code)) return 0;
    this.hands.keyDown({ code, key: this.nameOf(code), repeat, modified: this.modified, instead: own ? kButtonKey : undefined });
    return this.modified ? 0 : own ? kButtonKey : kNumbers[code] ?? 0;
  }

  press() {
    const free = Object.keys(kNames).filter((code) => !this.keys.has(code)), code = free[this.pick(free.length)];
    if (code === 'MetaLeft') this.ended.keys = this.moment;
    this.keys.set(code, { begun: this.moment, number: 0 });
    if (this.focused) this.keys.get(code).number = this.open * this.tellDown(code, false);
  }

  release() {
    const down = [...this.keys.keys()], code = down[this.pick(down.length)];
    if (!code) return;
    const untold = this.mac && this.keys.has('MetaLeft') && code !== 'MetaLeft';
    this.keys.delete(code);
    if (this.focused && !untold) this.hands.keyUp({ code, key: this.nameOf(code), modified: this.modified, control: this.focus !== 'page' });
  }

  repeat() {
    const code = [...this.keys.keys()].at(-1);
    if (code && this.focused) this.tellDown(code, true);
  }

  moveFocus() {
    if (!this.focused) return;
    this.focus = ['page', 'button', 'key button'][this.pick(3)];
    this.ended.keys = this.moment;
    this.hands.moveFocus();
  }

  leave() {
    this.focused = !this.focused;
    this.ended.all = this.moment;
    this.hands.letGo(); // blur, or hidden; and when it comes back
  }

  touch() {
    const id = this.pick(3), stick = this.pick(2) === 0;
    if (this.pointers.has(id)) return;
    const hand = stick ? { keys: new Set(), axes: [0, 0, 0.5, -0.5, 0, 0, 0] } : { keys: new Set([kButtonKey]), axes: [0, 0, 0, 0, 0, 0, 0] };
    this.pointers.set(id, { ...hand, begun: this.moment, counts: this.open });
    this.hands.pointerDown(id, { keys: new Set(hand.keys), axes: [...hand.axes] });
  }

  moveFinger() {
    const [id, finger] = [...this.pointers][0] ?? [];
    if (!finger || finger.keys.size) return;
    finger.axes = [0, 0, 1, 0.25, 0, 0, 0];
    this.hands.pointerMove(id, [...finger.axes]);
  }

  lift() {
    const id = this.pick(3);
    if (this.pointers.delete(id)) this.hands.pointerUp(id, this.pick(2) ? 'pointerup' : 'pointercancel');
  }

  handle(name) {
    const device = this.devices[name], what = this.pick(4);
    if (what === 0) device.keys.clear();
    else if (what === 1) device.keys.add(kTable[this.pick(kTable.length)]);
    else device.axes = what === 2 ? [0, 0, 0, 0, 0, 0, 0] : [0.5, 0, 0, -0.5, 0, 0, 0];
    this.settle();
  }

  plug() {
    this.padName = this.padName ? null : ['one', 'two'][this.pick(2)];
    this.devices.pad.rested = -1;
    this.settle();
  }

  changeLink() {
    const before = this.open;
    this.link = ['open', 'silent', 'open'][this.pick(3)];
    if (this.pick(3) === 0) this.drives = !this.drives;
    this.hands.setOpen(this.open);
    if (this.open !== before) this.ended.all = this.moment; // what is held while the link comes back wants a new press, too
  }

  sleep() {
    this.now += 1.5 * kLapse;
    this.ended.all = this.moment;
    this.tick();
  }
}

const kActs = ['press', 'press', 'press', 'release', 'release', 'release', 'repeat', 'moveFocus', 'leave', 'touch', 'touch', 'moveFinger', 'lift', 'lift', 'plug', 'changeLink', 'sleep', 'pad', 'pad', 'headset'];
const text = ({ keys, axes }) => JSON.stringify([[...keys].sort((a, b) => a - b), axes]);

/** Acts up to the first difference, or none. */
function differs(Kind, seed, events = 30) {
  const pick = random(seed), person = new Person(new Kind(), pick), acts = [];
  for (let k = 0; k < events; k++) {
    const act = kActs[pick(kActs.length)];
    person.moment++;
    if (act in person.devices) person.handle(act);
    else person[act]();
    acts.push(act);
    if (pick(3) === 0) continue; // the next one follows at once
    const sent = text(person.settle()), held = text(person.expected());
    if (sent !== held) return `sequence ${seed}, ${acts.join(' ')}: sent ${sent}, held ${held}`;
  }
  return '';
}

await check('what is sent is what is held', async () => {
  const found = Array.from({ length: count }, (_, seed) => differs(Hands, seed)).filter((text) => text);
  expect(found.length === 0, `${found.length} of ${count}: ${found[0]}`);
  return { sequences: count, held: found.length };
});

// Each has one rule less, as a page may easily have it.
const kWorse = {
  'a key that comes up with a modifier': class extends Hands { keyUp(event) { if (!event.modified) super.keyUp(event); } },
  'a key that comes up on a control': class extends Hands { keyUp(event) { if (!event.control) super.keyUp(event); } },
  'a key that comes up under another name': class extends Hands {
    byName = new Map();
    keyDown(press) { this.byName.set(press.key, press.code); return super.keyDown(press); }
    keyUp({ key }) { super.keyUp({ code: this.byName.get(key) }); }
  },
  'keys on macOS that come up with Meta': class extends Hands { keyDown(press) { return super.keyDown({ ...press, code: press.code.replace('Meta', 'Alt') }); } },
  'a focus that moves': class extends Hands { moveFocus() {} },
  'a window that is left, a link that is lost, a tab that slept': class extends Hands { letGo() {} },
  'a link that is lost': class extends Hands { setOpen(open) { const { letGo } = this; this.letGo = () => {}; super.setOpen(open); this.letGo = letGo; } },
  'a tab that slept': class extends Hands { tick() {} },
  'a key that repeats': class extends Hands { keyDown(press) { return super.keyDown({ ...press, repeat: false }); } },
  'a finger that is cancelled': class extends Hands { pointerUp(id, how) { if (how !== 'pointercancel') super.pointerUp(id); } },
  'a gamepad that comes back': class extends Hands { setPad(name, hand) { super.setPad('any', hand); } },
};
await check('each rule that is missing is found', async () => {
  const found = Object.entries(kWorse).map(([name, Kind]) => [name, Array.from({ length: 400 }, (_, seed) => differs(Kind, seed)).filter((text) => text).length]);
  for (const [name, sequences] of found) expect(sequences > 0, `not found: ${name}`);
  return Object.fromEntries(found);
});

await check('a key drives by its name, and by its place where that is of another alphabet', async () => {
  const kLetters = new Set([...'ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 '].map((key) => key.charCodeAt(0)));
  const numberOf = (key, code) => {
    const hands = Object.assign(new Hands(), { known: kLetters });
    hands.setOpen(true);
    hands.keyDown({ code, key, repeat: false, modified: false });
    return String.fromCharCode(...hands.held().keys);
  };
  for (const [key, code, drives] of [['w', 'KeyW', 'W'], ['ц', 'KeyW', 'W'], ['ı', 'KeyI', 'I'], ['#', 'Digit3', '3'], ['&', 'Digit1', '1'], ['z', 'KeyW', 'Z'], [',', 'KeyW', ''], ['@', 'KeyQ', ''], ['ß', 'Minus', ''], ['ä', 'Quote', '']])
    expect(numberOf(key, code) === drives, `'${key}' at ${code} drives '${numberOf(key, code)}', not '${drives}'`);
  const others = Array.from({ length: 0xd800 - 0x80 }, (_, k) => String.fromCharCode(0x80 + k));
  const wrong = others.filter((key) => numberOf(key, 'Minus'));
  expect(wrong.length === 0, `${wrong} at a place without a letter`);
  const upper = others.filter((key) => kLetters.has(key.toUpperCase().charCodeAt(0))); // what this test is about
  expect(upper.includes('ß') && upper.includes('ſ'), `only ${upper}`);
  return { upper: upper.length };
});

await check('of what is wrong the most important is said', async () => {
  const well = { silence: 0, health: { text: '', alarm: false }, trouble: '', driving: true, delay: 200, drawing: 100, strangePad: '' };
  const kSaid = [ // from the last to the first
    [{ health: { text: 'paused', alarm: false } }, 'paused', false], [{ strangePad: 'X' }, "'X'", false], [{ delay: 1100 }, '1.0 s old, because the link', false],
    [{ drawing: 900 }, 'this device draws', false], [{ trouble: 'moves not' }, 'moves not', true], [{ health: { text: 'gone', alarm: true } }, 'gone', true],
    [{ silence: 7000 }, 'more than 5 s', true],
  ];
  expect(noticeOf(well).text === '', noticeOf(well).text);
  const facts = { ...well };
  for (const [more, part, alarm] of kSaid) {
    const notice = noticeOf(Object.assign(facts, more));
    expect(notice.text.includes(part) && notice.alarm === alarm, `${part}: ${JSON.stringify(notice)}`);
  }
  const watching = noticeOf({ ...well, driving: false, delay: 1100, trouble: 'moves not', strangePad: 'X' }); // which does not concern who looks on
  expect(watching.text === '', watching.text);
});
process.exit(0);
