// The page that drives: it takes the place, hears keys, pointers and a gamepad of the browser, and tells the server 20 times a
// second what is held. The server moves the scope as the tool 'Drive scope' of rviz does.

import { emptyHand, Hands, kAxes, qtKey, type Hand } from './hands';
import { Kind, readText, type GrantText, type KeyTable, type OperatorText } from './messages';
import type { Stream } from './stream';

const kPeriod = 50; // of messages while the page drives [ms]; the server lets go after a silence
const kMaxKeys = 16; // of a message
const kDead = 0.12; // of the sticks of a pad

// Standard gamepad: buttons as keys of the table, sticks as joints.
const kPadKeys: Record<number, string> = {
  0: ' ', 1: 'G', 2: 'N', 3: 'I', 4: 'F', 5: 'R', 6: 'Z', 7: 'X', 8: '1', 9: '3', 12: 'E', 13: 'Q', 14: 'C', 15: 'T',
};
const kPadAxes: [number, number, number][] = [[0, 3, -1], [1, 2, -1], [2, 1, 1], [3, 0, -1]]; // axis, joint, sign

function handOf(pad: Gamepad): Hand {
  const hand = emptyHand();
  for (const [button, key] of Object.entries(kPadKeys)) if (pad.buttons[+button]?.pressed) hand.keys.add(qtKey(key));
  for (const [axis, joint, sign] of kPadAxes) {
    const value = pad.axes[axis] ?? 0;
    if (Math.abs(value) > kDead) hand.axes[joint] = (sign * (value - Math.sign(value) * kDead)) / (1 - kDead);
  }
  return hand;
}

export class Drive {
  operator: OperatorText | null = null;
  onChange: () => void = () => {};
  onSend: (seconds: number) => void = () => {}; // regularly, before it is told what hands hold
  readonly hands = new Hands();
  strangePad = ''; // name of a gamepad whose buttons are not in the standard order
  private grant: GrantText | null = null;
  private number = 0;
  private ticked = 0; // [ms]

  constructor(private stream: Stream) {
    stream.on(Kind.Grant, (bytes) => this.begin(readText<GrantText>(bytes)));
    stream.on(Kind.Operator, (bytes) => {
      const drove = this.driving;
      this.operator = readText<OperatorText>(bytes);
      if (drove && !this.driving) this.leave(); // the server gave the place away, for this page was silent for long
      this.onChange();
    });
    addEventListener('keydown', (event) => this.handleKey(event));
    addEventListener('keyup', (event) => this.change(() => this.hands.keyUp(event))); // wherever the focus is by now
    addEventListener('focusin', () => this.change(() => this.hands.moveFocus()));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const)
      addEventListener(end, ({ pointerId }) => this.change(() => this.hands.pointerUp(pointerId)));
    addEventListener('blur', () => this.letGo());
    document.addEventListener('visibilitychange', () => document.hidden && this.letGo());
    setInterval(() => this.tick(), kPeriod);
  }

  get driving() {
    return this.grant !== null && this.operator !== null && this.operator.seat === this.grant.seat;
  }

  get taken() {
    return !this.driving && (this.operator?.seat ?? 0) > 0;
  }

  get headset() {
    return this.hands.headset;
  }

  setTable(table: KeyTable) {
    this.hands.known = new Set(table.bindings.map(({ key }) => key));
  }

  take() {
    this.stream.send(Uint8Array.of(2));
  }

  giveBack() {
    this.letGo();
    this.stream.send(Uint8Array.of(3));
    this.grant = null;
  }

  lost() {
    this.leave();
    this.operator = null;
  }

  private leave() {
    this.grant = null;
    this.letGo();
  }

  letGo() {
    this.change(() => this.hands.letGo());
  }

  /** A button of the page holds a key of the table: while it is pressed, or Enter or Space where it has the focus. */
  bindButton(button: HTMLButtonElement, key: number) {
    button.dataset.key = String(key);
    button.onpointerdown = (event) => this.beginPointer(event, { ...emptyHand(), keys: new Set([key]) });
    button.oncontextmenu = (event) => event.preventDefault();
  }

  /** @param axes  of a pointer there: shares of the speed of a key, by joint */
  bindStick(stick: HTMLElement, axes: (event: PointerEvent) => number[]) {
    stick.onpointerdown = (event) => this.beginPointer(event, { ...emptyHand(), axes: axes(event) });
    stick.onpointermove = (event) => this.hands.pointerMove(event.pointerId, axes(event));
    stick.oncontextmenu = (event) => event.preventDefault();
  }

  private beginPointer(event: PointerEvent, hand: Hand) {
    if (event.button !== 0) return;
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    this.change(() => this.hands.pointerDown(event.pointerId, hand));
  }

  private begin(grant: GrantText) {
    if (grant.grant !== this.grant?.grant) this.number = 0;
    this.grant = grant;
    this.change(() => {});
  }

  private handleKey(event: KeyboardEvent) {
    const control = event.target instanceof HTMLElement ? event.target.closest<HTMLElement>('button, input, select, .stick') : null;
    const { code, key, repeat } = event, activates = key === ' ' || key === 'Enter', arrow = key.startsWith('Arrow');
    const own = control?.dataset[activates ? 'key' : arrow ? key.replace('A', 'a') : ''];
    if (control && own === undefined && (activates || arrow || control.matches('select'))) return; // it does something else with the key
    this.change(() => {
      const modified = event.ctrlKey || event.altKey || event.metaKey;
      if (this.hands.keyDown({ code, key, repeat, modified, instead: own && Number(own) || undefined })) event.preventDefault();
    });
  }

  private tick() {
    const now = performance.now();
    this.onSend((now - this.ticked) / 1000);
    this.ticked = now;
    this.hands.tick(now);
    this.readPad();
    if (!document.hidden) this.change(() => {}); // a page that nobody sees is silent, and the server lets go
  }

  private readPad() {
    const pads = navigator.getGamepads().filter((each) => each !== null), pad = pads.find(({ mapping }) => mapping === 'standard');
    this.strangePad = pad ? '' : pads[0]?.id ?? '';
    this.hands.setPad(pad ? `${pad.index} ${pad.id}` : null, pad ? handOf(pad) : emptyHand());
  }

  /** What the hands do counts while the page drives and hears the server, which is told at once. */
  private change(act: () => void) {
    const hears = this.stream.silence === 0;
    this.hands.setOpen(this.driving && hears);
    act();
    if (this.grant && hears) this.send(this.grant);
  }

  private send({ grant }: GrantText) {
    const { keys, axes } = this.hands.held(), count = Math.min(keys.length, kMaxKeys);
    const bytes = new ArrayBuffer(28 + 4 * count), view = new DataView(bytes);
    view.setUint8(0, 4);
    view.setUint8(1, count);
    view.setUint32(4, grant, true);
    view.setUint32(8, ++this.number, true);
    for (let joint = 0; joint < kAxes; joint++) view.setInt16(12 + 2 * joint, Math.round(32767 * axes[joint]), true);
    for (let k = 0; k < count; k++) view.setUint32(28 + 4 * k, keys[k], true);
    this.stream.send(bytes);
  }
}
