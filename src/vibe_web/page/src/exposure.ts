// The exposure of the endoscope's picture: AutoExposure of vibe_graphics/src/geometry/endoscope_optics.cpp, step by step,
// with the limits that the server tells.

import type { Lens } from './messages';

const kCloseEnough = 0.04; // of the target: close enough to show the first picture
const kTries = 4; // of the first picture
const kFollow = 0.3; // of what is missing, at most, from picture to picture

const clamp = (value: number, low: number, high: number) => Math.min(high, Math.max(low, value));

export class AutoExposure {
  gain: number;
  isLost = false; // the last picture should be taken again
  private time = NaN;
  private tries = 0;

  constructor(private numbers: Lens['exposure']) {
    this.gain = numbers.first;
  }

  /** Tells the mean level, 0 to 1, of the picture of this time [s] that was taken with `gain`. */
  see(level: number, time: number) {
    const { target, rate, gap, min, max } = this.numbers;
    const passed = time - this.time;
    const again = this.isLost && passed === 0;
    const fresh = !(passed >= 0 && passed <= gap) || again;
    this.tries = again ? this.tries + 1 : 0;
    let stops = 2 * Math.log2(target / Math.max(level, 0.01));
    if (!fresh) stops = clamp(kFollow * stops, -rate * passed, rate * passed);
    this.gain = clamp(this.gain * 2 ** stops, min, max);
    this.isLost = fresh && this.tries + 1 < kTries && Math.abs(level / target - 1) > kCloseEnough;
    this.time = time;
  }
}
