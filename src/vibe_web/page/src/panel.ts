// The page around the pictures: state, events, measures, keys and the timeline of a recording.

import { Kind, readText, type EventText, type KeyTable, type ReplayText, type StateText } from './messages';
import type { Drive } from './drive';
import type { Stream } from './stream';

export const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

const seconds = (time: number) => `${Math.floor(time / 60)}:${(time % 60).toFixed(1).padStart(4, '0')}`;

/** Replaces the children of an element by rows of texts. */
function fill(parent: HTMLElement, rows: HTMLElement[]) {
  parent.replaceChildren(...rows);
}

function made(tag: string, text: string, className = '', title = ''): HTMLElement {
  const child = document.createElement(tag);
  child.textContent = text;
  child.className = className;
  if (title) child.title = title;
  return child;
}

function row(cells: string[], className: string, title: string): HTMLElement {
  const line = made('tr', '', className, title);
  line.append(...cells.map((cell) => made('td', cell)));
  return line;
}

export class Panel {
  private replay: ReplayText | null = null;
  private seeking = false;
  private delay = '';

  constructor(private stream: Stream, private drive: Drive) {
    stream.on(Kind.State, (bytes) => this.showState(readText(bytes)));
    stream.on(Kind.Events, (bytes) => this.showEvents(readText(bytes)));
    stream.on(Kind.Replay, (bytes) => this.showReplay(readText(bytes)));
    stream.on(Kind.Refusal, (bytes) => this.status(new TextDecoder().decode(new Uint8Array(bytes, 1))));
    element('play').onclick = () => this.sendReplay(!this.replay?.playing);
    const seek = element<HTMLInputElement>('seek');
    seek.oninput = () => (this.seeking = true);
    seek.onchange = () => {
      this.seeking = false;
      this.sendReplay(this.replay?.playing ?? false, seek.valueAsNumber);
    };
  }

  status(text: string) {
    element('status').textContent = text;
  }

  showDelay(text: string) {
    this.delay = text || '-';
    const shown = element('state').lastElementChild;
    if (shown) shown.textContent = this.delay;
  }

  showForce(newton: number, torque: number) {
    element<HTMLMeterElement>('force').value = newton;
    element('newton').textContent = `${newton.toFixed(1)} N, ${(1000 * torque).toFixed(0)} mN m`;
  }

  showDriving() {
    const { drive } = this, operator = drive.operator;
    const control = element<HTMLButtonElement>('control');
    control.textContent = drive.driving ? 'Give control back' : 'Take control';
    control.setAttribute('aria-pressed', String(drive.driving));
    const trouble = drive.driving ? operator?.trouble ?? '' : '';
    element('trouble').textContent = trouble;
    element('trouble').hidden = !trouble;
    element('step').textContent = operator?.step ?? '';
    element('step').hidden = !drive.driving || !!trouble || !operator?.step;
    for (const button of element('keys').querySelectorAll<HTMLButtonElement>('button')) {
      button.classList.toggle('down', operator?.keys.includes(Number(button.dataset.key)) ?? false);
      button.disabled = !drive.driving;
    }
  }

  showKeys(table: KeyTable) {
    fill(element('keys'), table.rows.map(({ caps, text }) => {
      const line = made('div', '', 'row');
      for (const cap of caps.filter(({ key }) => key !== 0)) line.append(this.keyButton(cap.key, cap.label, text));
      line.append(made('span', text));
      return line;
    }));
    this.showDriving();
  }

  private keyButton(key: number, label: string, text: string): HTMLElement {
    const button = made('button', label) as HTMLButtonElement;
    button.type = 'button';
    button.dataset.key = String(key);
    button.setAttribute('aria-label', `${label}: ${text}`);
    const hold = (down: boolean) => this.drive.hold(key, down);
    button.onpointerdown = (event) => {
      button.setPointerCapture(event.pointerId);
      hold(true);
    };
    button.onpointerup = button.onpointercancel = button.onlostpointercapture = () => hold(false);
    button.oncontextmenu = (event) => event.preventDefault();
    return button;
  }

  private showState(state: StateText) {
    const terms: [string, string][] = [
      ['Time', seconds(state.time) + (state.paused ? ', paused' : '')], ['Phase', state.phase], ['Tool', state.tool],
      ['Needle', state.needle], ['Gas', `${(state.pressure / 133.322).toFixed(1).replace('-0.0', '0.0')} mmHg, ${(1e6 * state.volume).toFixed(0)} mL`],
      ['Marks', String(state.marks)], ['Bites', String(state.bites)], ['Sets', `${state.cinched} of ${state.sutures} cinched`],
      ['Bleeding', state.bleeding ? `${state.bleeding} now, ${(1e6 * state.blood).toFixed(1)} mL lost` : 'none'],
      ['Delay', this.delay], // last: showDelay() writes there
    ];
    fill(element('state'), terms.flatMap(([name, value]) => [made('dt', name), made('dd', value)]));
    fill(element('sets').querySelector('tbody')!, state.sets.map((set) => row([set.set, set.bites, set.technique, set.stage, set.tension], set.warns ? 'warns' : '', set.help)));
    fill(element('measures').querySelector('tbody')!, state.measures.map((measure) => {
      const value = measure.value === null ? '-' : measure.value.toFixed(measure.decimals) + ' ' + measure.unit;
      return row([measure.label, value, measure.range], measure.outside ? 'outside' : '', `${measure.explained}\n${measure.rating}`);
    }));
  }

  private showEvents(events: EventText[]) {
    fill(element('events'), events.slice(-30).reverse().map(({ number, severity, text }) => {
      const item = made('li', (severity === 'note' ? '' : severity + ': ') + text, severity) as HTMLLIElement;
      item.value = number;
      return item;
    }));
  }

  private showReplay(replay: ReplayText) {
    this.replay = replay;
    element('timeline').hidden = false;
    element('play').textContent = replay.playing ? 'Pause' : 'Play';
    const seek = element<HTMLInputElement>('seek');
    seek.max = String(replay.duration);
    if (!this.seeking) seek.value = String(replay.time);
    seek.setAttribute('aria-valuetext', seconds(replay.time));
    element('clock').textContent = `${seconds(replay.time)} / ${seconds(replay.duration)}`;
  }

  private sendReplay(play: boolean, time?: number) {
    if (!this.drive.driving) return this.status('Take control to move in the recording.');
    const bytes = new ArrayBuffer(16), view = new DataView(bytes);
    view.setUint8(0, 5);
    view.setUint8(1, (play ? 1 : 0) | (time === undefined ? 0 : 2));
    view.setFloat32(4, this.replay?.rate ?? 1, true);
    view.setFloat64(8, time ?? 0, true);
    this.stream.send(bytes);
  }
}
