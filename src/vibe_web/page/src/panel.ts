// The page around the pictures: what is wrong, state, events, measures and keys.

import type { Drive } from './drive';
import { Kind, readText, type EventText, type HealthText, type KeyTable, type StateText } from './messages';
import { noticeOf } from './notice';
import type { Stream } from './stream';
import { element, made, minutes, row } from './texts';
import { Timeline } from './timeline';
import { addTouch } from './touch';

const kSaid = 8000; // how long an answer to the person stands [ms]
const kWell: HealthText = { text: '', alarm: false };

export class Panel {
  readonly timeline: Timeline;
  private health = kWell;
  private link = 'Connecting...';
  private said = { text: '', until: 0, seat: 0 };
  private delay = '-';

  constructor(stream: Stream, private drive: Drive) {
    this.timeline = new Timeline(stream, drive, (text) => this.status(text), () => this.showReplay());
    stream.on(Kind.State, (bytes) => this.showState(readText(bytes)));
    stream.on(Kind.Events, (bytes) => this.showEvents(readText(bytes)));
    stream.on(Kind.Health, (bytes) => (this.health = readText(bytes)));
    stream.on(Kind.Refusal, (bytes) => this.status(new TextDecoder().decode(new Uint8Array(bytes, 1))));
    addTouch(drive);
    element('numbers').onclick = () => this.openDrawer();
    addEventListener('keydown', ({ key }) => key === 'Escape' && this.openDrawer(false));
  }

  /** An answer to what the person did, until the place changes hands, and no longer than a while. */
  status(text: string) {
    this.said = { text, until: performance.now() + kSaid, seat: this.drive.operator?.seat ?? 0 };
    this.showLink();
  }

  /** @param why  there is no connection; empty: it is being made */
  setLink(open: boolean, why: string) {
    this.link = open ? 'Connected' : why || 'Connecting...';
    if (!open) this.health = kWell;
    this.showLink();
    this.showDriving();
  }

  private showLink() {
    const { text, until, seat } = this.said, holds = text && performance.now() < until && seat === (this.drive.operator?.seat ?? 0);
    const shown = holds ? text : this.link, status = element('status');
    if (status.textContent !== shown) status.textContent = shown;
    status.classList.toggle('quiet', shown === 'Connected');
  }

  /** Regularly. @param delay  from a state to its picture, NaN: unknown. @param drawing  a part of it [ms] */
  showHealth(silence: number, delay: number, drawing: number) {
    this.delay = Number.isNaN(delay) ? '-' : `${delay.toFixed(0)} ms from state to picture`;
    const shown = element('state').lastElementChild;
    if (shown) shown.textContent = this.delay;
    const { drive, health } = this, { driving, strangePad } = drive;
    const trouble = this.timeline.replay ? '' : drive.operator?.trouble ?? '';
    const notice = this.link === 'Connected' ? noticeOf({ silence, health, trouble, driving, delay, drawing, strangePad }) : kWell;
    for (const id of ['trouble', 'hint']) {
      const part = element(id), text = notice.alarm === (id === 'trouble') ? notice.text : '';
      if (part.textContent !== text) part.textContent = text;
      part.hidden = !text;
    }
    const step = element('step');
    step.textContent = drive.operator?.step ?? '';
    step.hidden = !driving || !!notice.text || !step.textContent || !!this.timeline.replay;
    this.showLink();
  }

  showForce(newton: number, torque: number) {
    element<HTMLMeterElement>('force').value = newton;
    element('newton').textContent = `${newton.toFixed(1)} N, ${(1000 * torque).toFixed(0)} mN m`;
  }

  showDriving() {
    const { driving, operator } = this.drive, control = element<HTMLButtonElement>('control');
    control.textContent = driving ? 'Give control back' : 'Take control';
    control.setAttribute('aria-pressed', String(driving));
    const moves = driving && !this.timeline.replay; // a recording has nothing to drive
    document.body.classList.toggle('driving', moves);
    for (const button of document.querySelectorAll<HTMLButtonElement>('button[data-key]')) {
      button.classList.toggle('down', operator?.keys.includes(Number(button.dataset.key)) ?? false);
      button.disabled = !moves;
    }
    this.showLink();
  }

  /** @param open  or the other way round */
  private openDrawer(open?: boolean) {
    element('numbers').setAttribute('aria-expanded', String(document.body.classList.toggle('drawer', open)));
  }

  showKeys(table: KeyTable) {
    const drives = ({ key }: { key: number }) => table.bindings.some((each) => each.key === key);
    element('keys').replaceChildren(...table.rows.filter(({ caps }) => caps.some(drives)).map(({ caps, text }) => {
      const line = made('div', '', 'row'), plain = text.replace(/ \((wheel|drag)\)/, ''); // which are those of rviz
      line.append(...caps.filter(drives).map(({ key, label }) => this.keyButton(key, label, plain)), made('span', plain));
      return line;
    }));
    this.showDriving();
  }

  private keyButton(key: number, label: string, text: string): HTMLElement {
    const button = made('button', label) as HTMLButtonElement;
    button.type = 'button';
    button.setAttribute('aria-label', `${label}: ${text}`);
    this.drive.bindButton(button, key);
    return button;
  }

  /** Time is that of the line. */
  private showReplay() {
    const { replay } = this.timeline, shown = element('state').querySelector('dd');
    if (shown && replay) shown.textContent = minutes(replay.time);
    element('keys').closest('section')!.hidden = !!replay;
    this.showDriving();
  }

  private showState(state: StateText) {
    const { replay } = this.timeline;
    const terms: [string, string][] = [
      ['Time', replay ? minutes(replay.time) : minutes(state.time) + (state.paused ? ', paused' : '')], // first: showReplay() writes there
      ['Phase', state.phase], ['Tool', state.tool], ['Needle', state.needle],
      ['Gas', `${(state.pressure / 133.322).toFixed(1).replace('-0.0', '0.0')} mmHg, ${(1e6 * state.volume).toFixed(0)} mL`],
      ['Marks', state.marks], ['Bites', String(state.bites)], ['Sets', `${state.cinched} of ${state.sutures} cinched`],
      ['Bleeding', state.bleeding ? `${state.bleeding} now, ${(1e6 * state.blood).toFixed(1)} mL lost` : 'none'],
      ['Delay', this.delay], // last: showHealth() writes there
    ];
    element('state').replaceChildren(...terms.flatMap(([name, value]) => [made('dt', name), made('dd', value)]));
    element('sets').querySelector('tbody')!.replaceChildren(...state.sets.map((set) => row([set.set, set.bites, set.technique, set.stage, set.tension], set.warns ? 'warns' : '', set.help)));
    element('measures').querySelector('tbody')!.replaceChildren(...state.measures.map((measure) => {
      const value = measure.value === null ? '-' : measure.value.toFixed(measure.decimals) + ' ' + measure.unit;
      return row([measure.label, value, measure.range], measure.outside ? 'outside' : '', `${measure.explained}\n${measure.rating}`);
    }));
  }

  private showEvents(events: EventText[]) {
    element('events').replaceChildren(...events.slice(-30).reverse().map(({ number, severity, text }) => {
      const item = made('li', (severity === 'note' ? '' : severity + ': ') + text, severity) as HTMLLIElement;
      item.value = number;
      return item;
    }));
  }
}
