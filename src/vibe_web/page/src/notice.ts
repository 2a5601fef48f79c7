// What a person who looks on or drives has to know: the most important, in one sentence.

import type { HealthText } from './messages';

const kOld = 700; // age of a picture that a person who drives is warned of [ms]

export interface Facts {
  silence: number; // of the server [ms]
  health: HealthText;
  trouble: string; // why nothing moves
  driving: boolean;
  delay: number; // age of what is shown; NaN: unknown [ms]
  drawing: number; // part of it that drawing takes [ms]
  strangePad: string;
}

/** In few steps, because a screen reader reads each sentence that is new. */
function lasting(seconds: number): string {
  const told = [2, 5, 10, 30, 60, 120, 300, 600].reduce((most, each) => (each <= seconds ? each : most));
  return `for more than ${told} s`;
}

/** The sentence, empty if all is well, and whether what is shown is not what is. */
export function noticeOf({ silence, health, trouble, driving, delay, drawing, strangePad }: Facts): HealthText {
  const alarm = (text: string) => ({ text, alarm: true }), hint = (text: string) => ({ text, alarm: false });
  if (silence > 0) return alarm(`Nothing has come from the server ${lasting(silence / 1000)}; what was held is let go. Is its machine in reach?`);
  if (health.alarm) return health;
  if (driving && trouble) return alarm(trouble);
  if (driving && delay > kOld) {
    const cause = drawing > delay / 2 ? 'this device draws slowly' : 'the link is slow';
    return hint(`What you see is ${(Math.round(delay / 500) / 2).toFixed(1)} s old, because ${cause}; drive slowly.`);
  }
  if (driving && strangePad) return hint(`The browser does not know where the buttons of the gamepad '${strangePad}' are, so it does not drive; use another one, or the keys.`);
  return health;
}
