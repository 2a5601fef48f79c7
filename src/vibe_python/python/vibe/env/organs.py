"""Stomachs that episodes begin in: models, insufflated, with the scope at some places. Prepared when first asked for,
then kept for the process; all environments share them."""

import functools
import json
import os
import threading

import numpy as np

import vibe

SHAPES = ("sthenic", "j", "steer_horn")
SCALES = (0.92, 1.0, 1.08)
#: (shape, scale) of the stomachs that episodes draw from by default, and of those kept for evaluation
TRAINING = tuple((shape, scale) for shape in SHAPES for scale in SCALES)
HELD_OUT = (("sthenic", 0.96), ("sthenic", 1.04), ("j", 0.96), ("j", 1.04), ("steer_horn", 1.04))

#: rate [1/s] and amplitude [m] of the diaphragm. The centre of mass then has a standard deviation of 2.8, 5.8 and 8.8 mm:
#: the range of 18 volunteers (PMC10113698) and its middle. The rates are those of adults at rest.
BREATHING = {"slight": (12 / 60, 9.4e-3), "moderate": (16 / 60, 20e-3), "strong": (20 / 60, 30.5e-3)}

#: grade of the scene's section `motion`: waves, respiration unless `breathing` says it, heart (docs/motion.md)
MOTION = {"slight": 1.0, "moderate": 2.0, "strong": 3.0}

STARTS = 4  # places of the scope per stomach
PHASES = 8  # of a breath, or of the period of contraction waves, in which episodes begin
_WAVE = 1 / 0.0472  # period of contraction waves, as the scene has it by default [s]
_SETTLING = 3.0  # simulated time from the entry to the place [s]
_INSUFFLATION = 60.0  # at most [s]


def load(stomach, particles, step_period, sections):
    """The model of (shape, scale), or of a scene file, with other values of its keys."""
    sections = {**sections, "geometry": {**sections.get("geometry", {}), "particles": particles}}
    if isinstance(stomach, str):
        return vibe.load(stomach, render_surface=False, step_period=step_period, **sections)
    sections["geometry"].update(zip(("shape", "scale"), stomach))
    return vibe.load(render_surface=False, step_period=step_period, **sections)


class Organ:
    """One stomach: its model, the states that episodes begin with (by place of the scope and phase of what moves it), and
    simulations that are free at present. `stomach` is (shape, scale), or a scene file; `scene` a text of JSON: other
    values of its keys."""

    def __init__(self, stomach, particles, breathing, step_period, scene, motion):
        self._cycle = _WAVE if motion else None
        sections = json.loads(scene)
        if breathing:
            rate, amplitude = BREATHING[breathing]
            self._cycle = self._cycle or 1 / rate  # [s]
            sections["breathing"] = {"rate": rate, "amplitude": amplitude}
        if motion:
            sections["motion"] = {"grade": MOTION[motion]}
        self.model = load(stomach, particles, step_period, sections)
        self.name = stomach if isinstance(stomach, str) else "{} {:g}".format(*stomach)
        self.name += "".join(f", {grade} {what}" for what, grade in (("breathing", breathing), ("motion", motion)) if grade)
        self.joint_speeds = np.array([speed for _, _, speed in self.model.joint_limits.values()])  # greatest [m/s], [rad/s]
        self.goals = {}  # of tasks, by what they are drawn from; see Task
        self._key = stomach, particles, breathing, step_period, scene, motion
        self._begin_pool()
        simulation = self.take()
        self._insufflate(simulation)
        self.starts = [self._place(simulation, k) for k in range(STARTS)]
        simulation.restore(self.starts[0][0])
        self.anatomy = vibe.Anatomy(simulation)
        self.give(simulation)

    def _begin_pool(self):
        self._free, self._lock, self._process = [], threading.Lock(), os.getpid()

    def __deepcopy__(self, _):
        return self

    def __reduce__(self):
        return organ, self._key

    def take(self):
        """A simulation of this model, for one user."""
        if self._process != os.getpid():  # after a fork; those of the parent cannot be used here
            self._begin_pool()
        with self._lock:
            if self._free:
                return self._free.pop()
        return vibe.Simulation(self.model, metrics=False, impedance=False)

    def give(self, simulation):
        with self._lock:
            if self._process == os.getpid():
                self._free.append(simulation)

    def _insufflate(self, simulation):
        for _ in range(int(_INSUFFLATION / 0.5)):
            events = simulation.run(round(0.5 / self.model.step_period), insufflate=True)
            if any(event.kind == "pressure reached" for event in events):
                break
        self._insufflated = simulation.snapshot()

    def _place(self, simulation, number):
        """The scope between a third and a half of the way in, turned and bent a little."""
        random = np.random.default_rng([20, number])
        simulation.restore(self._insufflated)
        joints = simulation.joints
        joints[0] = random.uniform(0.08, 0.13)
        joints[1:4] = random.uniform([-1.0, -0.2, -0.3], [1.0, 0.6, 0.3])
        buttons = np.zeros((1, len(vibe.BUTTONS)))
        buttons[0, vibe.BUTTONS.index("insufflate")] = 1

        def wait(seconds):
            vibe.step_all([simulation], joints[None], buttons, round(seconds / self.model.step_period), 1)

        wait(_SETTLING)
        wait(_SETTLING / 3)
        if self._cycle is None:
            return [simulation.snapshot(prepared=True)]
        phases = []
        for _ in range(PHASES):
            wait(self._cycle / PHASES)
            phases.append(simulation.snapshot())
        return phases

    def target(self, along, around):
        """A place of the inside of the wall: triangle, weights (3,), and its position in the first start [m]."""
        triangle, weight = self.anatomy.at(along, around)
        inside = self.anatomy.position(triangle, weight)
        return triangle, weight, inside - self.model.particle_radius * self.anatomy.outward(triangle, weight)


@functools.lru_cache(maxsize=32)  # values that are drawn make ever new ones
def organ(stomach, particles, breathing=None, step_period=1 / 20, scene="{}", motion=None):
    return Organ(stomach, particles, breathing, step_period, scene, motion)
