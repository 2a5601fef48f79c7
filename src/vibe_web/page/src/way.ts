// The way of the hand that holds the handle, as axes of the drive: all of it counts. Ways are in times of a key [s].

const kLag = 0.3; // way that waits to be done, at most: the scope must not go on for longer after a hand that rests

export class Way {
  hand = [0, 0]; // since it took the handle
  private waits = [0, 0];
  private axes = [0, 0];

  begin() {
    this.hand.fill(0);
    this.end();
  }

  /** The hand has let go: what waits is not done any more. */
  end() {
    this.waits.fill(0);
    this.axes.fill(0);
  }

  add(way: number[]) {
    way.forEach((part, joint) => {
      this.hand[joint] += part;
      this.waits[joint] += part;
    });
  }

  /** The axes that were told last have been obeyed for this time, but no longer than a page may be silent [s]. */
  told(seconds: number, silence: number) {
    this.axes.forEach((axis, joint) => (this.waits[joint] -= axis * Math.min(seconds, silence)));
  }

  /** Axes, -1 to 1, until the next message or frame. */
  next(seconds: number, silence: number): number[] {
    this.waits.forEach((wait, joint) => {
      this.waits[joint] = Math.min(kLag, Math.max(-kLag, wait));
      this.axes[joint] = Math.min(1, Math.max(-1, this.waits[joint] / Math.min(seconds, silence)));
    });
    return this.axes;
  }
}
