// Readings and buttons beside the monitor of a headset's room: what the page says, in one size of letters.

import { CanvasTexture, LinearFilter, Mesh, MeshBasicMaterial, PlaneGeometry, type Vector2 } from 'three';
import { kPlainLayer } from './organ';

export const kWidth = 0.52, kHeight = 0.86, kCapital = 0.021; // capital letters [m]
const kDots = 1000; // [px/m]
const kFont = (kCapital * kDots) / 0.72, kLine = 1.25 * kFont, kEdge = 0.7 * kFont, kButton = 2 * kFont; // [px]
const kColours = { back: '#12161a', dim: '#9fb0bd', plain: '#eef2f5', urgent: '#ffb347', button: '#2f3d49', pointed: '#4d7ea8' };

export interface Button { text: string; act: () => void }

/** What is to be read: rows of name and value, a sentence that says how things are, and one that has to be heeded. */
export interface Said { rows: [string, string][]; now: string; urgent: string }

const textOf = (id: string) => {
  const element = document.getElementById(id);
  return element && !element.hidden ? element.textContent ?? '' : '';
};

/** What the page itself shows, so that both say the same. */
export function pageSays(): Said {
  const terms = [...document.querySelectorAll('#state dt')], values = [...document.querySelectorAll('#state dd')];
  const rows = terms.map((term, k): [string, string] => [term.textContent ?? '', values[k]?.textContent ?? '']);
  const [force] = textOf('newton').split(', ');
  const status = textOf('status');
  return { rows: [['Force', force], ...rows], now: [textOf('hint'), textOf('step')].filter(Boolean).join(' '), urgent: [textOf('trouble'), status === 'Connected' ? '' : status].filter(Boolean).join(' ') };
}

export class Readings extends Mesh<PlaneGeometry, MeshBasicMaterial> {
  private canvas = document.createElement('canvas');
  private pen = this.canvas.getContext('2d')!;
  private drawn = '';
  private buttons: Button[] = [];

  constructor() {
    super(new PlaneGeometry(kWidth, kHeight), new MeshBasicMaterial());
    Object.assign(this.canvas, { width: kDots * kWidth, height: kDots * kHeight });
    const texture = new CanvasTexture(this.canvas);
    Object.assign(texture, { generateMipmaps: false, minFilter: LinearFilter });
    this.material.map = texture;
    this.layers.set(kPlainLayer);
  }

  /** Drawn anew only when it changes. @param pointed  buttons that controllers point at */
  show(said: Said, buttons: Button[], pointed: (Button | null)[]) {
    this.buttons = buttons;
    const marked = buttons.map((button) => pointed.includes(button));
    const key = JSON.stringify([said, buttons.map(({ text }) => text), marked]);
    if (key === this.drawn) return;
    this.drawn = key;
    const { pen } = this;
    Object.assign(pen, { font: `${kFont}px sans-serif`, textBaseline: 'middle', fillStyle: kColours.back });
    pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    let y = kEdge;
    for (const row of said.rows) y = this.row(row, y);
    y = this.sentence(said.urgent, kColours.urgent, y + kEdge / 2);
    this.sentence(said.now, kColours.plain, y);
    buttons.forEach(({ text }, k) => this.button(text, marked[k], k));
    this.material.map!.needsUpdate = true;
  }

  /** The button at this place of the plane. */
  buttonAt(uv: Vector2): Button | null {
    const { width, height } = this.canvas, x = uv.x * width, y = (1 - uv.y) * height;
    return this.buttons.find((_, k) => {
      const place = this.placeOf(k);
      return x > place.x && x < place.x + place.width && y > place.y && y < place.y + place.height;
    }) ?? null;
  }

  private row([name, value]: [string, string], y: number): number {
    this.write(name, kColours.dim, kEdge, y);
    this.write(value, kColours.plain, 0.34 * this.canvas.width, y);
    return y + kLine;
  }

  private write(text: string, fillStyle: string, x: number, y: number) {
    Object.assign(this.pen, { fillStyle, textAlign: 'left' });
    this.pen.fillText(text, x, y + kLine / 2, this.canvas.width - kEdge - x);
  }

  private sentence(text: string, colour: string, y: number): number {
    const lines: string[] = [];
    for (const word of text.split(/\s+/).filter(Boolean)) {
      const longer = [...lines.slice(-1), word].join(' ');
      if (lines.length === 0 || this.pen.measureText(longer).width > this.canvas.width - 2 * kEdge) lines.push(word);
      else lines[lines.length - 1] = longer;
    }
    for (const line of lines) {
      this.write(line, colour, kEdge, y);
      y += kLine;
    }
    return y;
  }

  /** In rows of two, from below; the first one, which is the most important, alone in its row above them. */
  private placeOf(k: number) {
    const { width, height } = this.canvas, rows = Math.ceil((this.buttons.length + 1) / 2), half = (width - 3 * kEdge) / 2;
    const row = Math.ceil(k / 2), y = height - (rows - row) * (kButton + kEdge / 2) - kEdge / 2;
    return { x: k > 0 && k % 2 === 0 ? 2 * kEdge + half : kEdge, y, width: k === 0 ? width - 2 * kEdge : half, height: kButton };
  }

  private button(text: string, pointed: boolean, k: number) {
    const { pen } = this, { x, y, width, height } = this.placeOf(k);
    pen.fillStyle = pointed ? kColours.pointed : kColours.button;
    pen.fillRect(x, y, width, height);
    Object.assign(pen, { fillStyle: kColours.plain, textAlign: 'center' });
    pen.fillText(text, x + width / 2, y + height / 2, width - kEdge);
  }
}
