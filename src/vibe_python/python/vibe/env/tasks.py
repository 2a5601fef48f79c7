"""The tasks. Lengths in metres; rewards of a step are the sum of what `reward` says, -0.01, -0.02 per newton above 2 N
of force on the tool, and 10 when the episode succeeds. All weights are design choices."""

import numpy as np

import vibe

from .episodes import Task
from .expert import Cinching, Inspecting, Pursuing, Reaching, Retracting


class Reach(Task):
    """The tip within 3 mm of a place on the inside of the wall (the success of arXiv 2509.00319)."""

    name = "Reach"
    reward = "1 per centimetre that the tip comes nearer"
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

    def expert(self, seed):
        return Reaching()


class Inspect(Task):
    """60 % of the wall's area seen (`Simulation.sees()`), looked for after every action. The goal of the observation has no
    meaning here."""

    name = "Inspect"
    reward = "10 times the share of the area that is seen anew"
    seconds = 30.0
    share = 0.6
    further = {"seen": ((1,), "share of the area that was seen")}
    has_place = False

    def begun(self, slot):
        self.mask = getattr(self, "mask", [None] * self.count)
        self.covered = getattr(self, "covered", np.zeros(self.count))
        self.area = getattr(self, "area", [None] * self.count)
        model = self.organ[slot].model
        area = np.where(model.end == 0, model.area, 0)
        self.area[slot] = area / area.sum()
        self.mask[slot] = np.zeros(len(area), bool)
        self.covered[slot] = 0
        self._see(slot)

    def _see(self, slot):
        self.mask[slot] |= self.simulation[slot].sees(self.mask[slot])
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

    def expert(self, seed):
        return Inspecting() if self.mode == "joints" else None


APPROACH = "1 per centimetre that the tip comes nearer, until it is within 2 cm"


class _Procedure(Task):
    """Tasks with all seven joints and the six buttons; insufflate stays pressed. Subclasses have a `protocol` for the
    trainee, in which {along} and {around} are the goal's."""

    rate = 60
    joints = vibe.JOINTS
    buttons = True
    seconds = 90.0
    tolerance = 10e-3
    further = {"holds": ((4,), "whether the helix grips, the arm is closed, the needle is on the arm, and loaded")}

    @property
    def speeds(self):
        return self.speeds_of(0)

    def speeds_of(self, slot):
        return self.organ[slot].joint_speeds  # of its scope

    def observe_further(self, seen):
        rows = []
        for simulation in self.simulation:
            now = simulation.procedure()
            rows.append([now["grips"], now["arm_closed"], now["needle_on_arm"], now["needle_loaded"]])
        return {"holds": np.array(rows, float)}

    def expert(self, seed):
        return Pursuing(seed)

    def reachable(self, model, position, outward, joints):
        return True  # it need not be from straight ahead

    def approach(self, before, after):
        """APPROACH."""
        far = np.maximum(np.linalg.norm(before["goal"] - before["tip"], axis=1), 0.02)
        near = np.maximum(np.linalg.norm(after["goal"] - after["tip"], axis=1), 0.02)
        return 100 * (far - near)

    def near_goal(self, slot, kind, seen):
        """Whether an event of this kind happened near the goal."""
        return any(event.kind == kind and event.particle >= 0 and np.linalg.norm(
            self.simulation[slot].positions[event.particle] - seen["goal"][slot]) <= self.tolerance
            for event in self.events[slot])


class Mark(_Procedure):
    """A mark by argon plasma within 10 mm of a place."""

    name = "Mark"
    reward = f"{APPROACH}; -1 for every burn"
    seconds = 40.0
    protocol = "goals:\n  - mark: {{along: {along}, around: {around} rad}}\n"

    def judge(self, before, after):
        success = np.array([self.near_goal(slot, "mark", after) for slot in range(self.count)])
        burns = np.array([sum(event.kind == "burn" for event in events) for events in self.events])
        return self.approach(before, after) - burns, success


class Bite(_Procedure):
    """One bite through the wall within 10 mm of a place."""

    name = "Bite"
    reward = f"{APPROACH}; 1 when the helix takes hold; -1 for every bite elsewhere and every slip"
    protocol = "goals:\n  - bite: {{along: {along}, around: {around} rad}}\n"

    def judge(self, before, after):
        success = np.array([self.near_goal(slot, "bite", after) for slot in range(self.count)])
        elsewhere = np.array([sum(event.kind in ("bite", "slip") for event in events) for events in self.events])
        holds = after["grips"] & ~before["grips"]
        return self.approach(before, after) + holds - np.maximum(elsewhere - success, 0), success


def _cinched_sets(threads):
    """The middles of the sets of seven bites that are cinched and recognised as U."""
    return [np.mean(thread["bites"], axis=0) for thread in threads
            if thread["stage"] == "cinched" and thread["technique"] == "u" and len(thread["bites"]) >= 7]


class SutureSet(_Procedure):
    """A suture set of seven bites with its middle within 20 mm of a place, with T-tag and cinch, that is cinched and recognised
    as U."""

    name = "SutureSet"
    reward = f"{APPROACH}; 1 for every bite"
    seconds = 240.0
    tolerance = 20e-3
    around = (-0.3, 0.3)
    protocol = ("goals:\n  - suture_set: {{pattern: u, bites: 7, along: {along}, around: {around} rad, "
                "length: 15 mm, width: 60 mm}}\n")

    def judge(self, before, after):
        bites = np.array([sum(event.kind == "bite" for event in events) for events in self.events])
        success = np.array([any(event.kind == "cinched" for event in events) for events in self.events])
        for slot in np.flatnonzero(success):
            middles = _cinched_sets(self.simulation[slot].threads())
            success[slot] = any(np.linalg.norm(middle - after["goal"][slot]) <= self.tolerance for middle in middles)
        return self.approach(before, after) + bites, success


class Sleeve(_Procedure):
    """Six sets along the body as the trainee plans them, each of seven bites, cinched and recognised as U. The goal of the
    observation has no meaning here."""

    name = "Sleeve"
    reward = "1 for every bite, 10 for every set"
    seconds = 1200.0
    sets = 6
    protocol = "goals:\n  - sleeve: {{sets: 6}}\n"

    def judge(self, before, after):
        bites, cinched = (np.array([sum(event.kind == kind for event in events) for events in self.events]) for kind in ("bite", "cinched"))
        made, success = np.zeros(self.count), np.zeros(self.count, bool)
        for slot in np.flatnonzero(cinched):
            threads = self.simulation[slot].threads()
            made[slot] = len(_cinched_sets(threads[-cinched[slot]:]))
            success[slot] = len(_cinched_sets(threads)) >= self.sets
        return bites + 10.0 * made, success


class Retract(_Procedure):
    """A fold of the wall that the helix holds within 20 mm of a place, drawn with a force of 1 to 2 N on the tool for 3 s."""

    name = "Retract"
    reward = f"{APPROACH}; 1 when the helix takes hold there, 1 per second within the band; -1 for every slip and every bite"
    seconds = 40.0
    tolerance = 20e-3  # with which the helix takes hold 10 to 15 mm beside where the trainee wants the needle
    band = (1.0, 2.0)  # [N]
    hold = 3.0  # [s]
    further = {**_Procedure.further, "held": ((1,), "how long the force has been within the band [s]")}
    protocol = Bite.protocol

    def begun(self, slot):
        self.held = getattr(self, "held", np.zeros(self.count))
        self.there = getattr(self, "there", np.zeros(self.count, bool))  # the grip is near the place
        self.held[slot], self.there[slot] = 0, False

    def judge(self, before, after):
        takes = np.array([self.near_goal(slot, "grab", after) for slot in range(self.count)])
        faults = np.array([sum(event.kind in ("slip", "bite") for event in events) for events in self.events])
        self.there = (self.there | takes) & after["grips"]
        force = np.linalg.norm(after["wrench"][:, :3], axis=1)
        within = self.there & (force >= self.band[0]) & (force <= self.band[1])
        self.held = np.where(within, self.held + 1 / self.rate, 0)
        return self.approach(before, after) + takes + within / self.rate - faults, self.held >= self.hold - 1e-9

    def observe_further(self, seen):
        return {**super().observe_further(seen), "held": self.held[:, None]}

    def expert(self, seed):
        return Retracting(seed)


class _Sewn(_Procedure):
    """Tasks that begin with bites, which the trainee has made before: `sewing` is its protocol."""

    seconds = 30.0
    places = 2  # sets per start of a stomach; each takes seconds when it is first asked for

    def _set_goal(self, slot, organ, start, number, place):
        super()._set_goal(slot, organ, start, number % self.places, place)

    def begun(self, slot):
        simulation, made = self.simulation[slot], self.organ[slot].goals
        along, around = self.place[slot]
        key = type(self), simulation.hash(), along, around
        if key not in made:
            text = "name: sewing\nskill: {like: expert, look_time: 0 s}\n" + self.sewing.format(along=along, around=around)
            simulation.follow(vibe.Trainee(self.organ[slot].model, text, seed=1))
            made[key] = simulation.snapshot()
        simulation.restore(made[key])

    def tensions(self):
        """Of the thread, the greatest (count,) [N]."""
        return np.array([max([0.0, *(simulation.threads() or [{"tension": []}])[-1]["tension"]]) for simulation in self.simulation])


class Cinch(_Sewn):
    """The thread of a set of seven bites, after its T-tag, drawn to the tension that is asked for within 20 %, and cinched
    there. The goal of the observation is the middle of the set."""

    name = "Cinch"
    reward = "1 per newton that the tension comes nearer; -5 for every tear-out"
    around = SutureSet.around
    further = {**_Procedure.further, "tension": ((2,), "of the thread, and the one that is asked for [N]")}
    asked = (1.0, 2.5)  # uniform distribution [N]
    share = 0.2
    sewing = SutureSet.protocol.replace("width: 60 mm", "width: 60 mm, cinched: false")

    def begun(self, slot):
        super().begun(slot)
        self.wanted = getattr(self, "wanted", np.zeros(self.count))
        self.tension = getattr(self, "tension", np.zeros(self.count))
        self.wanted[slot], self.tension[slot] = self.random[slot].uniform(*self.asked), 0

    def judge(self, before, after):
        tension = self.tensions()
        nearer = np.abs(self.tension - self.wanted) - np.abs(tension - self.wanted)
        self.tension = tension
        torn = np.array([sum(event.kind == "tear-out" for event in events) for events in self.events])
        success = np.array([any(event.kind == "cinched" for event in events) for events in self.events])
        for slot in np.flatnonzero(success):
            drawn = self.simulation[slot].threads()[-1]["cinch_tension"]
            success[slot] = abs(drawn - self.wanted[slot]) <= self.share * self.wanted[slot]
        return nearer - 5.0 * torn, success

    def observe_further(self, seen):
        return {**super().observe_further(seen), "tension": np.stack([self.tension, self.wanted], axis=1)}

    def expert(self, seed):
        return Cinching(lambda task: 0.97 * task.wanted[0])


class StopBleeding(_Sewn):
    """A bleeding stopped: every one of four bites bleeds briskly, which T-tag and cinch end."""

    name = "StopBleeding"
    reward = "-1 per millilitre of blood"
    around = SutureSet.around
    sections = {"bleeding": {"mild_probability": 0.0, "brisk_probability": 1.0}}
    further = {**_Procedure.further, "blood": ((1,), "that was lost in the episode [mL]")}
    sewing = Cinch.sewing.replace("bites: 7", "bites: 4")

    def begun(self, slot):
        super().begun(slot)
        self.blood = getattr(self, "blood", np.zeros((self.count, 2)))  # lost in the episode; before it [mL]
        self.blood[slot] = 0, self._lost(slot)

    def _lost(self, slot):
        return 1e6 * self.simulation[slot].procedure()["blood_lost"]

    def judge(self, before, after):
        lost = self.blood[:, 0].copy()
        self.blood[:, 0] = [self._lost(slot) - self.blood[slot, 1] for slot in range(self.count)]
        return lost - self.blood[:, 0], np.array([any(event.kind == "cinched" for event in events) for events in self.events])

    def observe_further(self, seen):
        return {**super().observe_further(seen), "blood": self.blood[:, :1]}

    def expert(self, seed):
        return Cinching(lambda task: 1.0)
