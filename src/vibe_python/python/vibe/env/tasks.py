"""The tasks. Lengths in metres; rewards of a step are the sum of what is named here, -0.01, -0.02 per newton above 2 N
of force on the tool, and 10 when the episode succeeds. All weights are design choices."""

import numpy as np

import vibe

from .episodes import Task


class Reach(Task):
    """Bring the tip to a place on the wall: within 3 mm of the inside of the wall (the success of arXiv 2509.00319).
    Rewarded: 1 per centimetre that the tip comes nearer. Ten seconds."""

    name = "Reach"
    tolerance = 3e-3

    def distance(self, seen):
        """Of the tip from the inside of the wall at the goal [m]; kept with what is seen."""
        if "distance" not in seen:
            radius = np.array([organ.model.particle_radius for organ in self.organ])
            seen["distance"] = np.maximum(np.linalg.norm(seen["goal"] - seen["tip"], axis=1) - radius, 0)
        return seen["distance"]

    def judge(self, before, after):
        far, near = self.distance(before), self.distance(after)
        return 100 * (far - near), near <= self.tolerance

    def measures(self, slot):
        return {**super().measures(slot), "distance": float(self.distance(self.current())[slot])}


class Inspect(Task):
    """Look at the wall: a picture of 64 x 64 pixels is taken after every action, and the triangles in it that are not
    farther than 0.1 m count as seen. Rewarded: 10 times the share of the wall's area that is seen anew. Success: 60 %
    of it. Thirty seconds; the goal of the observation has no meaning here."""

    name = "Inspect"
    seconds = 30.0
    share = 0.6
    sight = 0.1
    further = {"seen": (1,)}

    def begun(self, slot):
        self.mask = getattr(self, "mask", [None] * self.count)
        self.covered = getattr(self, "covered", np.zeros(self.count))
        self.area = getattr(self, "area", [None] * self.count)
        model = self.organ[slot].model
        corner = model.rest_positions[model.triangles]
        area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
        self.area[slot] = area / area.sum()
        self.mask[slot] = np.zeros(len(area), bool)
        self.covered[slot] = 0
        self._see(slot)

    def _see(self, slot):
        picture = self.simulation[slot].camera(64, 64, 2.0)
        near = (picture["triangle"] >= 0) & (np.nan_to_num(picture["depth"], nan=np.inf) <= self.sight)
        self.mask[slot][picture["triangle"][near]] = True
        self.covered[slot] = self.area[slot][self.mask[slot]].sum()

    def judge(self, before, after):
        known = self.covered.copy()
        for slot in range(self.count):
            self._see(slot)
        return 10 * (self.covered - known), self.covered >= self.share

    def observe_further(self, seen):
        return {"seen": self.covered[:, None]}

    def measures(self, slot):
        return {**super().measures(slot), "seen": float(self.covered[slot])}


class _Procedure(Task):
    """Tasks with all seven joints, at the speeds of the URDF, and the six buttons; insufflate stays pressed."""

    rate = 60
    speeds = np.array([0.15, 3.14, 3.14, 3.14, 0.1, 25.0, 0.1])
    buttons = True
    seconds = 90.0
    tolerance = 10e-3
    further = {"holds": (4,)}

    def observe_further(self, seen):
        rows = []
        for simulation in self.simulation:
            now = simulation.procedure()
            rows.append([now["grips"], now["arm_closed"], now["needle_on_arm"], now["needle_loaded"]])
        return {"holds": np.array(rows, float)}

    def reachable(self, model, position, outward, joints):
        return True  # it need not be from straight ahead

    def approach(self, before, after):
        """1 per centimetre that the tip comes nearer, until it is within 2 cm."""
        far = np.maximum(np.linalg.norm(before["goal"] - before["tip"], axis=1), 0.02)
        near = np.maximum(np.linalg.norm(after["goal"] - after["tip"], axis=1), 0.02)
        return 100 * (far - near)

    def near_goal(self, slot, kind, seen):
        """Whether an event of this kind happened near the goal."""
        return any(event.kind == kind and event.particle >= 0 and np.linalg.norm(
            self.simulation[slot].positions[event.particle] - seen["goal"][slot]) <= self.tolerance
            for event in self.events[slot])


class Mark(_Procedure):
    """Mark a place with the argon beam, within 10 mm. Rewarded: approach; -1 for every burn."""

    name = "Mark"
    seconds = 40.0
    protocol = "goals:\n  - mark: {{along: {along}, around: {around} rad}}\n"

    def judge(self, before, after):
        success = np.array([self.near_goal(slot, "mark", after) for slot in range(self.count)])
        burns = np.array([sum(event.kind == "burn" for event in events) for events in self.events])
        return self.approach(before, after) - burns, success


class Bite(_Procedure):
    """One bite through the wall within 10 mm of a place. Rewarded: approach; 1 when the helix takes hold; -1 for every
    bite elsewhere and every slip."""

    name = "Bite"
    protocol = "goals:\n  - bite: {{along: {along}, around: {around} rad}}\n"

    def judge(self, before, after):
        success = np.array([self.near_goal(slot, "bite", after) for slot in range(self.count)])
        elsewhere = np.array([sum(event.kind in ("bite", "slip") for event in events) for events in self.events])
        holds = after["grips"] & ~before["grips"]
        return self.approach(before, after) + holds - np.maximum(elsewhere - success, 0), success


class SutureSet(_Procedure):
    """A suture set of seven bites in the shape of a U around a place, with T-tag and cinch. Rewarded: approach; 1 for
    every bite. Success: cinched, and recognised as U."""

    name = "SutureSet"
    seconds = 240.0
    around = (-0.3, 0.3)
    protocol = ("goals:\n  - suture_set: {{pattern: u, bites: 7, along: {along}, around: {around} rad, "
                "length: 15 mm, width: 60 mm}}\n")

    def judge(self, before, after):
        bites = np.array([sum(event.kind == "bite" for event in events) for events in self.events])
        success = np.array([any(event.kind == "cinched" for event in events) for events in self.events])
        for slot in np.flatnonzero(success):
            success[slot] = any(t["stage"] == "cinched" and t["technique"] == "u" for t in self.simulation[slot].threads())
        return self.approach(before, after) + bites, success


TASKS = {task.name: task for task in (Reach, Inspect, Mark, Bite, SutureSet)}


def task_of(task):
    if isinstance(task, type) and issubclass(task, Task):
        return task
    if not isinstance(task, str) or task not in TASKS:
        raise vibe.Error(f"There is no task {vibe._shown(task)}; use one of {', '.join(TASKS)}.")
    return TASKS[task]
