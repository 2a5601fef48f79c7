// What the hands of the person hold: keys, fingers on the page, a gamepad, the controllers of a headset. A thing is held from a
// new press until it ends, and no longer; nothing here knows of a browser, so any sequence of events can be tried.

export const kAxes = 7;
export const kLapse = 5000; // a page that slept for longer wants new presses; so does the server [ms]

/** What one of the hands holds: keys of the table, and joints with shares of the speed of a key. */
export interface Hand { keys: Set<number>; axes: number[] }
export const emptyHand = (): Hand => ({ keys: new Set(), axes: new Array(kAxes).fill(0) });

/** A key of the keyboard goes down. */
export interface Press {
  code: string;
  key: string;
  repeat: boolean;
  modified: boolean; // with Control, Alt or Meta
  instead?: number; // the key of the table that it holds: where a button of the page has the focus
}

// Numbers of Qt::Key of keys that are not letters, digits or space
const kNamed: Record<string, number> = {
  ArrowLeft: 0x01000012, ArrowUp: 0x01000013, ArrowRight: 0x01000014, ArrowDown: 0x01000015, Shift: 0x01000020,
};
export const qtKey = (key: string) => kNamed[key] ?? (/^[ -~]$/.test(key) ? key.toUpperCase().charCodeAt(0) : 0); // of 'ß' it would be S

const isAtRest = ({ keys, axes }: Hand) => keys.size === 0 && axes.every((share) => share === 0);

/** A device that is asked again and again counts once it has been at rest. */
class Asked {
  hand = emptyHand();
  private rested = false;

  shut() {
    this.rested = false;
  }

  get held(): Hand[] {
    this.rested ||= isAtRest(this.hand);
    return this.rested ? [this.hand] : [];
  }
}

export class Hands {
  known = new Set<number>(); // keys of the table
  private open = false;
  private keyboard = new Map<string, number>(); // by the place of the key, whose name changes with Shift
  private pointers = new Map<number, Hand>();
  private pad = new Asked();
  private padName: string | null = null;
  private controllers = new Asked();
  private ticked = 0; // [ms]

  /** Of a headset, which writes here. */
  get headset() {
    return this.controllers.hand;
  }

  /** Whether presses count: while the page drives and hears the server. */
  setOpen(open: boolean) {
    if (open !== this.open) this.letGo();
    this.open = open;
  }

  letGo() {
    this.keyboard.clear();
    this.pointers.clear();
    this.pad.shut();
    this.controllers.shut();
  }

  /** Regularly, by a steady clock [ms]. */
  tick(now: number) {
    if (now - this.ticked > kLapse) this.letGo();
    this.ticked = now;
  }

  /** @return whether it is a key that drives */
  keyDown({ code, key, repeat, modified, instead }: Press): boolean {
    if (/^(Meta|OS)/.test(code)) this.keyboard.clear(); // macOS tells of no other key that comes up meanwhile
    const number = instead ?? this.numberOf(key, code);
    if (!this.open || modified || !this.known.has(number)) return false;
    if (!repeat) this.keyboard.set(code, number);
    return true;
  }

  keyUp({ code }: { code: string }) {
    this.keyboard.delete(code);
  }

  /** The focus goes elsewhere, and with it what the keys mean. */
  moveFocus() {
    this.keyboard.clear();
  }

  pointerDown(pointer: number, hand: Hand) {
    if (this.open) this.pointers.set(pointer, hand);
  }

  pointerMove(pointer: number, axes: number[]) {
    const hand = this.pointers.get(pointer);
    if (hand) hand.axes = axes;
  }

  pointerUp(pointer: number) {
    this.pointers.delete(pointer);
  }

  /** @param name  null: there is none; another one has to be at rest first */
  setPad(name: string | null, hand: Hand) {
    if (name !== this.padName) this.pad.shut();
    this.padName = name;
    this.pad.hand = hand;
  }

  held(): { keys: number[]; axes: number[] } {
    const hands = [...this.pointers.values(), ...this.pad.held, ...this.controllers.held];
    const keys = new Set([...this.keyboard.values(), ...hands.flatMap((hand) => [...hand.keys])]);
    const axes = emptyHand().axes.map((_, joint) => hands.reduce((sum, hand) => sum + hand.axes[joint], 0));
    return this.open ? { keys: [...keys], axes: axes.map((share) => Math.min(1, Math.max(-1, share))) } : { keys: [], axes: emptyHand().axes };
  }

  // Other alphabets, and digits with Shift, have other names on the same keys. On other Latin keyboards the name counts alone:
  // by its place, the comma of Dvorak would be a second W.
  private numberOf(key: string, code: string): number {
    const number = qtKey(key), place = number ? /^Digit(.)$/ : /^(?:Key|Digit)(.)$/;
    return this.known.has(number) ? number : qtKey(place.exec(code)?.[1] ?? '');
  }
}
