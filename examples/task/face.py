"""A task of one's own for vibe.env: `Environment("face:Face")`, or `import face` and `Environment("Face")`."""

import numpy as np

from vibe.env import Task


class Face(Task):
    """The camera turned until a place on the wall is within 5 degrees of the middle of its picture."""

    name = "Face"
    reward = "1 per 0.1 rad that the camera turns towards the place"
    further = {"angle": ((1,), "between the view and the place [rad]")}
    tolerance = np.radians(5)

    def angle(self, seen):
        apart = seen["goal"] - seen["tip"]
        along = np.einsum("ni,ni->n", apart, seen["direction"])
        return np.arccos(np.clip(along / np.linalg.norm(apart, axis=1), -1, 1))

    def observe_further(self, seen):
        return {"angle": self.angle(seen)[:, None]}

    def judge(self, before, after):
        return 10 * (self.angle(before) - self.angle(after)), self.angle(after) <= self.tolerance
