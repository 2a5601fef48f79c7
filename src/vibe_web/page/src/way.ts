// The way of the hand that holds the handle, as axes of the drive. All of it counts; what a picture that takes too long,
// or a hand that is too fast, leaves undone is summed up, so that it can be told. Ways are in times of a key [s].

const kLag = 0.3; // way that waits to be done, at most: longer the scope must not go on after a hand that rests

export class Way {
  lost = [0, 0];
  private waits = [0, 0];
  private axes = [0, 0];

  begin() {
    this.end();
    this.lost.fill(0);
  }

  /** The hand has let go: what waits is not done any more. */
  end() {
    this.waits.forEach((wait, joint) => (this.lost[joint] += Math.abs(wait)));
    this.waits.fill(0);
    this.axes.fill(0);
  }

  add(way: number[]) {
    way.forEach((part, joint) => (this.waits[joint] += part));
  }

  /** The axes that were told last have been obeyed for this time, but no longer than a page may be silent [s]. */
  told(seconds: number, silence: number) {
    this.axes.forEach((axis, joint) => (this.waits[joint] -= axis * Math.min(seconds, silence)));
  }

  /** Axes, -1 to 1, until the next message or frame. */
  next(seconds: number, silence: number): number[] {
    this.waits.forEach((wait, joint) => {
      const kept = Math.min(kLag, Math.max(-kLag, wait));
      this.lost[joint] += Math.abs(wait - kept);
      this.waits[joint] = kept;
      this.axes[joint] = Math.min(1, Math.max(-1, kept / Math.min(seconds, silence)));
    });
    return this.axes;
  }
}
