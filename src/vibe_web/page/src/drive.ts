// Hands of the person who drives: keys, buttons of the page, touch, a gamepad and the controllers of a headset. What is
// held goes to the server, which moves the scope as the tool 'Drive scope' of rviz does.

import { Kind, readText, type GrantText, type KeyTable, type OperatorText } from './messages';
import type { Stream } from './stream';

const kPeriod = 50; // of messages while the page drives [ms]; the server lets go after a silence
const kAxes = 7;
const kDead = 0.12; // of the sticks of a pad

// Qt::Key of keys that are not letters, digits or space
const kNamed: Record<string, number> = {
  ArrowLeft: 0x01000012, ArrowUp: 0x01000013, ArrowRight: 0x01000014, ArrowDown: 0x01000015, Shift: 0x01000020,
};
const qtKey = (key: string) => kNamed[key] ?? (key.length === 1 ? key.toUpperCase().charCodeAt(0) : 0);

// Standard gamepad: buttons as keys of the table, sticks as joints.
const kPadKeys: Record<number, string> = {
  0: ' ', 1: 'G', 2: 'N', 3: 'I', 4: 'F', 5: 'R', 6: 'Z', 7: 'X', 8: '1', 9: '3', 12: 'E', 13: 'Q', 14: 'C', 15: 'T',
};
const kPadAxes: [number, number, number][] = [[0, 3, -1], [1, 2, -1], [2, 1, 1], [3, 0, -1]]; // axis, joint, sign

/** One of the hands: what it holds now. */
export interface Hand { keys: Set<number>; axes: number[] }
export const emptyHand = (): Hand => ({ keys: new Set(), axes: new Array(kAxes).fill(0) });

export class Drive {
  operator: OperatorText | null = null;
  onChange: () => void = () => {};
  onSend: (seconds: number) => void = () => {}; // regularly, before it is told what hands hold
  readonly pointer = emptyHand();
  readonly headset = emptyHand();
  private keyboard = emptyHand();
  private pad = emptyHand();
  private grant: GrantText | null = null;
  private number = 0;
  private ticked = 0; // [ms]
  private table: KeyTable | null = null;

  constructor(private stream: Stream) {
    stream.on(Kind.Grant, (bytes) => this.begin(readText<GrantText>(bytes)));
    stream.on(Kind.Operator, (bytes) => {
      this.operator = readText<OperatorText>(bytes);
      this.onChange();
    });
    addEventListener('keydown', (event) => this.handleKey(event, true));
    addEventListener('keyup', (event) => this.handleKey(event, false));
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

  setTable(table: KeyTable) {
    this.table = table;
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
    this.grant = null;
    this.operator = null;
  }

  letGo() {
    for (const hand of [this.keyboard, this.pad, this.pointer, this.headset]) {
      hand.keys.clear();
      hand.axes.fill(0);
    }
    this.send();
  }

  /** Presses or releases a key of the table on the page. */
  hold(key: number, down: boolean) {
    if (down) this.pointer.keys.add(key);
    else this.pointer.keys.delete(key);
    this.send();
  }

  private begin(grant: GrantText) {
    if (grant.grant !== this.grant?.grant) this.number = 0;
    this.grant = grant;
    this.send();
  }

  private handleKey(event: KeyboardEvent, down: boolean) {
    const key = qtKey(event.key);
    if (event.ctrlKey || event.altKey || event.metaKey || !this.table?.bindings.some((each) => each.key === key)) return;
    const onControl = event.target instanceof HTMLElement && event.target.closest('button, input');
    if (!this.driving || (onControl && (event.key === ' ' || event.key.startsWith('Arrow')))) return;
    event.preventDefault();
    if (event.repeat) return;
    if (down) this.keyboard.keys.add(key);
    else this.keyboard.keys.delete(key);
    this.send();
  }

  private tick() {
    const now = performance.now();
    this.onSend((now - this.ticked) / 1000);
    this.ticked = now;
    if (!this.grant) return;
    this.readPad();
    if (!document.hidden) this.send(); // a page that nobody sees is silent, and the server lets go
  }

  private readPad() {
    const pad = navigator.getGamepads().find((each) => each?.mapping === 'standard');
    this.pad = emptyHand();
    if (!pad) return;
    for (const [button, key] of Object.entries(kPadKeys)) if (pad.buttons[+button]?.pressed) this.pad.keys.add(qtKey(key));
    for (const [axis, joint, sign] of kPadAxes) {
      const value = pad.axes[axis] ?? 0;
      if (Math.abs(value) > kDead) this.pad.axes[joint] = (sign * (value - Math.sign(value) * kDead)) / (1 - kDead);
    }
  }

  private send() {
    if (!this.grant) return;
    const hands = [this.keyboard, this.pad, this.pointer, this.headset];
    const keys = [...new Set(hands.flatMap((hand) => [...hand.keys]))].slice(0, 16);
    const bytes = new ArrayBuffer(28 + 4 * keys.length), view = new DataView(bytes);
    view.setUint8(0, 4);
    view.setUint8(1, keys.length);
    view.setUint32(4, this.grant.grant, true);
    view.setUint32(8, ++this.number, true);
    for (let joint = 0; joint < kAxes; joint++) {
      const sum = hands.reduce((all, hand) => all + hand.axes[joint], 0);
      view.setInt16(12 + 2 * joint, Math.round(32767 * Math.min(1, Math.max(-1, sum))), true);
    }
    keys.forEach((key, k) => view.setUint32(28 + 4 * k, key, true));
    this.stream.send(bytes);
  }
}
