// The line of a recording: where it stands, its events, and how fast it plays.

import type { Drive } from './drive';
import { Kind, readText, type ReplayText } from './messages';
import { element, made, minutes } from './texts';
import type { Stream } from './stream';

const kArrow = 1; // of an arrow key on the line; while it plays, an event that is less ago is where it comes from [s]
const kSame = 0.02; // a recording stands at the step next to where it was sent [s]

export class Timeline {
  replay: ReplayText | null = null; // null: there is no recording
  private seek = element<HTMLInputElement>('seek');
  private rate = element<HTMLSelectElement>('rate');
  private seeking = false;
  private marks = '';

  constructor(private stream: Stream, private drive: Drive, private say: (text: string) => void, private onChange: () => void) {
    stream.on(Kind.Replay, (bytes) => {
      this.replay = readText(bytes);
      element('timeline').hidden = !this.replay;
      if (this.replay) this.show(this.replay);
      this.onChange();
    });
    element('play').onclick = () => this.send(!this.replay?.playing);
    element('earlier').onclick = () => this.goTo(this.replay?.marks.filter(({ time }) => time < this.replay!.time - (this.replay!.playing ? kArrow : kSame)).pop()?.time ?? 0);
    element('later').onclick = () => this.goTo(this.replay?.marks.find(({ time }) => time > this.replay!.time + kSame)?.time);
    this.rate.onchange = () => this.send(this.replay?.playing ?? false);
    this.seek.oninput = () => (this.seeking = true);
    this.seek.onchange = () => this.goTo(this.seek.valueAsNumber);
    this.seek.onkeydown = (event) => {
      const by = { ArrowLeft: -kArrow, ArrowDown: -kArrow, ArrowRight: kArrow, ArrowUp: kArrow }[event.key];
      if (!by) return;
      event.preventDefault();
      this.goTo(Math.max(0, this.seek.valueAsNumber + by));
    };
  }

  private show(replay: ReplayText) {
    element('play').textContent = replay.playing ? 'Pause' : 'Play';
    this.seek.max = String(replay.duration);
    if (!this.seeking) this.seek.value = String(replay.time);
    const last = replay.marks.filter(({ time }) => time <= replay.time).pop();
    this.seek.setAttribute('aria-valuetext', minutes(replay.time) + (last ? `, after ${last.text}` : ''));
    this.rate.value = String(replay.rate); // none, if another program has chosen one that is not in the list
    element('clock').textContent = `${minutes(replay.time)} / ${minutes(replay.duration)}`;
    this.showMarks(replay);
  }

  private showMarks({ marks, duration }: ReplayText) {
    const text = JSON.stringify([marks, duration]);
    if (text === this.marks) return;
    this.marks = text;
    element('marks').replaceChildren(...marks.map(({ time, text }) => {
      const mark = made('i', '', text.startsWith('phase') ? 'phase' : '', `${minutes(time)}: ${text}`);
      mark.style.left = `${(100 * time) / duration}%`;
      return mark;
    }));
  }

  private goTo(time?: number) {
    this.seeking = false;
    if (time !== undefined) this.send(this.replay?.playing ?? false, time);
  }

  private send(play: boolean, time?: number) {
    if (!this.drive.driving) return this.say('Take control to move in the recording.');
    const bytes = new ArrayBuffer(24), view = new DataView(bytes);
    view.setUint8(0, 5);
    view.setUint8(1, (play ? 1 : 0) | (time === undefined ? 0 : 2));
    view.setFloat64(8, Number(this.rate.value) || this.replay?.rate || 1, true);
    view.setFloat64(16, time ?? 0, true);
    this.stream.send(bytes);
  }
}
