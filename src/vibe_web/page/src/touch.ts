// Two sticks and the buttons of the device over the picture, for thumbs.

import type { Drive } from './drive';
import { kAxes, qtKey } from './hands';
import { element, made } from './texts';

const kDead = 0.15; // of a stick, in its radius

interface Stick {
  label: string;
  across: [joint: number, sign: number];
  up: [joint: number, sign: number];
  keys: [up: string, down: string, left: string, right: string]; // that arrow keys hold where it has the focus
  buttons: [key: string, label: string][]; // beside it
}
const kSticks: Record<string, Stick> = {
  bend: {
    label: 'Bend the tip', across: [3, -1], up: [2, 1], keys: ['ArrowUp', 'ArrowDown', 'ArrowLeft', 'ArrowRight'],
    buttons: [[' ', 'beam'], ['I', 'gas'], ['E', 'helix out'], ['Q', 'helix in'], ['G', 'grab'], ['X', 'turn in'], ['Z', 'turn back'], ['1', 'slow']],
  },
  move: {
    label: 'In and out, rotate', across: [1, 1], up: [0, 1], keys: ['W', 'S', 'A', 'D'],
    buttons: [['R', 'close arm'], ['F', 'open arm'], ['N', 'needle'], ['T', 'T-tag'], ['C', 'cinch'], ['2', 'normal'], ['3', 'fast']],
  },
};

/** Where a pointer stands in a stick: to the right and up, -1 to 1, 0 near the middle. */
function shareIn(stick: HTMLElement, { clientX, clientY }: PointerEvent): [across: number, up: number] {
  const { left, top, width, height } = stick.getBoundingClientRect();
  const across = (2 * (clientX - left)) / width - 1, up = 1 - (2 * (clientY - top)) / height, length = Math.hypot(across, up);
  return length < kDead ? [0, 0] : [across / Math.max(1, length), up / Math.max(1, length)];
}

function addStick(drive: Drive, name: string, { label, across, up, keys, buttons }: Stick) {
  const side = element(name), stick = made('div', '', 'stick'), knob = made('span', ''), row = made('div', '', 'buttons');
  stick.tabIndex = 0;
  stick.setAttribute('role', 'group');
  stick.setAttribute('aria-label', `${label}: drag, or arrow keys`);
  stick.append(knob, made('small', label));
  ['arrowUp', 'arrowDown', 'arrowLeft', 'arrowRight'].forEach((arrow, k) => (stick.dataset[arrow] = String(qtKey(keys[k]))));
  const show = (x: number, y: number) => (knob.style.translate = `${45 * x}% ${-45 * y}%`);
  drive.bindStick(stick, (event) => {
    const [x, y] = shareIn(stick, event), axes = new Array(kAxes).fill(0);
    show(x, y);
    axes[across[0]] = across[1] * x;
    axes[up[0]] = up[1] * y;
    return axes;
  });
  stick.onlostpointercapture = () => show(0, 0);
  for (const [key, text] of buttons) {
    const button = made('button', '') as HTMLButtonElement;
    button.type = 'button';
    button.append(made('b', key === ' ' ? 'Space' : key), ` ${text}`); // the sentences on what to do next name the key
    drive.bindButton(button, qtKey(key));
    row.append(button);
  }
  side.append(row, stick);
}

export function addTouch(drive: Drive) {
  for (const [name, stick] of Object.entries(kSticks)) addStick(drive, name, stick);
}
