"""Episodes side by side: what the single and the vector environment share, so that both have the same bits."""

import copy
import difflib
import functools
import importlib
import inspect
import math

import numpy as np

import vibe

from . import organs as _organs
from .api import REAL, gymnasium, spaces
from .settings import FAR, PICTURES, STRONG, camera_of, is_number, organs_of, pictures_of, range_of, whole
from .tip import TIP_SPEED, tip_motion
from .variation import Variation

INSUFFLATE = vibe.BUTTONS.index("insufflate")
SUCCESS = 10.0  # reward of an episode that succeeds
FORCE_FREE = 2.0  # force on the tool that costs nothing [N]; twice the mean of the first session of the README
GOALS = 64  # per start, drawn once
WALL_POINTS = 48  # places of the wall that an observation holds

#: name to class, of every task that has been defined
TASKS = {}


class Task:
    """What an environment asks for. Subclasses say which actions there are, what is observed besides, what is rewarded
    and when an episode ends; an instance holds the episodes of `count` slots as arrays with a row per slot. A subclass
    that gives itself a name is in TASKS and, where the package is installed, in the registry of Gymnasium. Its docstring
    says what the goal is; docs/python.md has the table that is made from all of this."""

    name = ""
    reward = ""  #: what is rewarded, in words
    further = {}  #: observations of the task: name to (shape, meaning)
    has_place = True  #: the goal of the observation is a place of the wall, which pictures from outside mark
    seconds = 10.0  #: simulated time until an episode is truncated
    rate = 20  #: actions per simulated second
    rate_of_steps = 20  #: steps per simulated second, at least, where `step_period` does not say it
    joints = vibe.JOINTS[:4]  #: that actions move
    speeds = np.array([0.05, 1.0, 1.0, 1.0])  #: of the joints at action 1 [m/s], [rad/s]
    buttons = False  #: whether the action ends with the six buttons, pressed above 0
    sections = {}  #: values of the scene, by section, beside those that environments are given
    along, around = (0.3, 0.72), (-1.2, 1.2)  #: uniform distribution of the goal: share of the axis, angle around it [rad]

    def __init_subclass__(cls, **keywords):
        super().__init_subclass__(**keywords)
        if vars(cls).get("name"):
            _register(cls)

    def __init__(self, count=1, *, particles=1000, organs=_organs.TRAINING, action="joints", threads=1, camera=None,
                 pictures=None, tool=False, breathing=None, motion=None, step_period=None, max_episode_steps=None, scene=None, vary=None, tolerance=None,
                 along=None, around=None):
        if not isinstance(action, str) or action not in ("joints", "tip"):
            raise vibe.Error(f"'action' is {vibe._shown(action)}; use 'joints' or 'tip'.")
        for setting, grade, known in (("breathing", breathing, _organs.BREATHING), ("motion", motion, _organs.MOTION)):
            if grade is not None and (not isinstance(grade, str) or grade not in known):
                raise vibe.Error(f"'{setting}' is {vibe._shown(grade)}; use {', '.join(known)}, or None.")
        if action == "tip" and not self.moves_tip_only():
            raise vibe.Error(f"The task {self.name} moves more than the tip; use action='joints'.")
        if not is_number(self.rate) or not self.rate > 0:
            raise vibe.Error(f"'rate' of the task {self.name} is {vibe._shown(self.rate)}; give the actions per second.")
        self.along = range_of("along", self.along if along is None else along, 0, 1)
        self.around = range_of("around", self.around if around is None else around, -2 * math.pi, 2 * math.pi)
        self.tolerance = self._tolerance(tolerance)
        self.count, self.particles = whole("count", count, 1, 65536), whole("particles", particles, 100, 1000000)
        self.organs, self.breathing, self.motion = organs_of(organs), breathing, motion
        self.mode, self.threads, self.camera = action, whole("threads", threads, 1, 1024), camera_of(camera)
        self.pictures, self.tool = pictures_of(pictures, tool, self.camera), bool(tool)
        self.step_period = self._period(step_period)
        self.length = self.steps_of_episode() if max_episode_steps is None else whole("max_episode_steps", max_episode_steps, 1, 10**9)
        self.variation = Variation(count, scene, vary, {"breathing": breathing, "motion": motion}, self.sections)
        for sections in self.variation.scenes():  # what no scene has is refused before any episode
            for organ in dict.fromkeys([self.organs[0], *(organ for organ in self.organs if isinstance(organ, str))]):
                _organs.load(organ, 100, self.step_period, sections)
        self.simulation = [None] * count
        self.organ = [None] * count
        self.random = [np.random.default_rng(k) for k in range(count)]
        self.triangle = np.zeros((count, 1 + WALL_POINTS))  # of the goal, then of other places of the wall
        self.weight = np.full((count, 1 + WALL_POINTS, 3), 1 / 3)
        self.place = [None] * count  # of the goal: (along, around)
        self.seen = None
        self.taken = np.zeros(count, int)  # actions of the episode
        self.events = [[] for _ in range(count)]
        self.best_force = np.zeros(count)
        self.closed = False

    def _tolerance(self, tolerance):
        """The task's, or that of the setting [m]."""
        known = getattr(self, "tolerance", None)
        if tolerance is None:
            return known
        if known is None:
            raise vibe.Error(f"The task {self.name} has no tolerance; leave it out.")
        if not is_number(tolerance) or not 1e-4 <= tolerance <= 0.1:
            raise vibe.Error(f"'tolerance' is {vibe._shown(tolerance)}; give a distance from 0.0001 to 0.1 m.")
        return float(tolerance)

    @property
    def time(self):
        """Simulated time since the beginning of the episode (count,) [s]."""
        return self.taken / self.rate

    def _period(self, period):
        """Simulated time per step [s], of which a whole number makes up an action; None: an action, at most 1/20 s."""
        if period is None:
            return 1 / (self.rate * max(1, math.ceil(self.rate_of_steps / self.rate)))
        steps = 1 / (self.rate * period) if is_number(period) and 1e-4 <= period <= 0.1 else 0
        if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
            raise vibe.Error(f"'step_period' is {vibe._shown(period)}; give a whole part of an action of 1/{self.rate} s, such as "
                             f"{1 / self.rate:.5g}, or None.")
        return float(period)

    @classmethod
    def moves_tip_only(cls):
        """Whether an action may be the tip's velocity."""
        return len(cls.joints) <= 4 and not cls.buttons

    @classmethod
    def steps_of_episode(cls):
        """Actions until an episode is truncated."""
        return max(1, round(cls.seconds * cls.rate))

    @classmethod
    def _defaults(cls):
        """{keyword: its default} of all constructors of the class."""
        return {name: parameter.default for base in reversed(cls.__mro__) if "__init__" in vars(base) and base is not object
                for name, parameter in inspect.signature(base.__init__).parameters.items()
                if parameter.kind is parameter.KEYWORD_ONLY and name != "threads"}

    @classmethod
    def shown_settings(cls, settings):
        """All settings as a text that is the same for equal ones, however they were written."""
        return _shown_alike({**cls._defaults(), **settings})

    @classmethod
    def check_settings(cls, settings):
        """Raises vibe.Error for a keyword that no constructor of the class takes."""
        known = cls._defaults()
        for name in settings:
            if name not in known:
                near = difflib.get_close_matches(name, known, 1)
                raise vibe.Error(f"An environment has no '{name}'; " + (f"did you mean '{near[0]}'?" if near else
                                                                       f"it has {', '.join(sorted(known))}."))

    @classmethod
    def summary(cls):
        """The goal: the docstring in one line."""
        return " ".join((cls.__doc__ or "").split())

    # --- spaces

    @functools.cached_property
    def action_space(self):
        size = 3 if self.mode == "tip" else len(self.joints) + (len(vibe.BUTTONS) if self.buttons else 0)
        return spaces.Box(-1.0, 1.0, (size,), np.float32)

    @functools.cached_property
    def observation_space(self):
        def box(*shape, low=-FAR, high=FAR, dtype=np.float32):
            return spaces.Box(low, high, shape, dtype)

        parts = {
            "joints": box(len(vibe.JOINTS)), "tip": box(3), "direction": box(3, low=-1.001, high=1.001),
            "wrench": box(6, low=-STRONG, high=STRONG), "goal": box(3),
            "to_goal": box(3), "wall": box(WALL_POINTS, 3),
        }
        if self.camera:
            for name in self.pictures:
                channels, dtype, low, high = PICTURES[name]
                parts[name] = box(self.camera[1], self.camera[0], *channels, low=low, high=high, dtype=dtype)
        for name, declared in self.further.items():
            if not isinstance(declared, tuple) or len(declared) != 2 or not isinstance(declared[0], tuple):
                raise vibe.Error(f"'further' of the task {self.name} has {vibe._shown(declared)} for '{name}'; give (shape, meaning).")
            parts[name] = box(*declared[0], low=-STRONG, high=STRONG)
        return spaces.Dict(parts)

    # --- episodes

    def begin(self, slot, random, choices=None):
        """A new episode in one slot: draws stomach, start and goal, but for what chosen() has found."""
        self._check_open()
        choices = choices or {}
        if "phase" in choices and not self.breathing and not self.motion:
            raise vibe.Error("'phase' is chosen for a stomach that does not breathe or move; leave it out, or name a 'breathing' or 'motion'.")
        self.random[slot] = random
        stomach = self.organs[random.integers(len(self.organs))]
        scene = vibe._overrides(self.variation.begin(slot, random, choices.get("varied", {}))) or "{}"
        organ = _organs.organ(choices.get("organ", stomach), self.particles, self.breathing, self.step_period, scene, self.motion)
        self._use(slot, organ)
        start = choices.get("start", int(random.integers(len(organ.starts))))
        phases = organ.starts[start]
        phase = random.integers(len(phases)) if self.breathing or self.motion else 0
        self.simulation[slot].restore(phases[choices.get("phase", phase)])
        self._set_goal(slot, organ, start, int(random.integers(GOALS)), choices.get("goal"))
        triangles = len(organ.model.triangles)
        self.triangle[slot, 1:] = (np.arange(WALL_POINTS) * triangles) // WALL_POINTS
        self.taken[slot] = 0
        self.best_force[slot] = 0
        self.events[slot] = []
        self.seen = None
        self.begun(slot)

    def _use(self, slot, organ):
        """A simulation of this organ in a slot."""
        if self.organ[slot] is organ:
            return
        if self.simulation[slot] is not None:
            self.organ[slot].give(self.simulation[slot])
        self.organ[slot], self.simulation[slot] = organ, organ.take()

    def _set_goal(self, slot, organ, start, number, place):
        """A place, or one of the goals of a start, which are found when first asked for: that takes ten times as long as a
        step."""
        if place is not None:
            self.triangle[slot, 0], self.weight[slot, 0], _ = organ.target(*place)
            self.place[slot] = tuple(place)
            return
        key = (type(self), self.along, self.around, start, number)
        if key not in organ.goals:
            organ.goals[key] = self._draw_goal(organ, self.simulation[slot].joints, [21, start, number])
        self.place[slot], self.triangle[slot, 0], self.weight[slot, 0] = organ.goals[key]

    def _draw_goal(self, organ, joints, seed):
        random = np.random.default_rng(seed)
        one_place = self.along[0] == self.along[1] and self.around[0] == self.around[1]  # which is chosen, not drawn
        for _ in range(100):
            place = random.uniform(*self.along), random.uniform(*self.around)
            triangle, weight, position = organ.target(*place)
            if one_place or self.reachable(organ.model, position, organ.anatomy.outward(triangle, weight), joints):
                return place, triangle, weight
        raise vibe.Error(f"The scope reaches none of 100 goals with 'along' {self.along} and 'around' {self.around} in {organ.name}; "
                         "give wider ranges, or choose the goal by reset(options={'goal': (along, around)}).")

    def reachable(self, model, position, outward, joints):
        """Whether the scope can bring its tip there, as far as its joints go."""
        return joints_at(model, position, outward, joints) is not None

    def begun(self, slot):
        """For subclasses: what begins with an episode."""

    #: what no episode changes; everything else that an instance holds is the state of its episodes
    _constant = {"count", "particles", "organs", "tolerance", "along", "around", "breathing", "motion", "mode", "threads", "camera",
                 "pictures", "tool", "step_period", "length", "closed", "action_space", "observation_space", "seen", "events"}

    def state(self):
        """Everything that the episodes are in the midst of, as a dictionary that can be pickled; but the events of the last action."""
        self._check_open()
        found = {name: value for name, value in vars(self).items() if name not in self._constant}
        found["simulation"] = [simulation and simulation.snapshot() for simulation in self.simulation]
        return copy.deepcopy(found)

    def set_state(self, state):
        """Back to what state() gave, of a task with the same settings."""
        self._check_open()
        state = copy.deepcopy(state)
        snapshots, organs = state.pop("simulation"), state.pop("organ")
        for slot, organ in enumerate(organs):
            if organ is not None:
                self._use(slot, organ)
                self.simulation[slot].restore(snapshots[slot])
        vars(self).update(state)
        self.seen, self.events = None, [[] for _ in range(self.count)]

    # --- steps

    def advance(self, actions):
        """One action (count, numbers) in every slot, of numbers(). Returns rewards, terminated and truncated (count,)."""
        self._check_open()
        if any(simulation is None for simulation in self.simulation):
            raise vibe.Error("The environment has not begun; call reset() first.")
        self.seen = None  # whoever has the simulation may have restored it
        before = self.current()
        if self.variation.vary:
            actions = self.variation.arrived(actions, self.rate, 3 if self.mode == "tip" else len(self.joints))
        joints = before["joints"].copy()
        joints[:, : len(self.joints)] += self._speed(actions) * np.array([self.speeds_of(slot) for slot in range(self.count)]) / self.rate
        buttons = np.zeros((self.count, len(vibe.BUTTONS)))
        if self.buttons:
            buttons[:] = actions[:, len(self.joints):] > 0
        buttons[:, INSUFFLATE] = 1
        self.events = vibe.step_all(self.simulation, joints, buttons, self._steps(), self.threads)
        self.taken += 1
        self.seen = self.look()
        force = np.linalg.norm(self.seen["wrench"][:, :3], axis=1)
        self.best_force = np.maximum(self.best_force, force)
        reward, success = self._judged(before)
        reward = reward - 0.01 - 0.02 * np.maximum(force - FORCE_FREE, 0) + SUCCESS * success
        return reward, success, ~success & (self.taken >= self.length)

    def _judged(self, before):
        """What judge() says, or vibe.Error if it cannot be meant."""
        said = self.judge(before, self.seen)
        pair = isinstance(said, tuple) and len(said) == 2
        reward, success = map(np.asarray, said) if pair else (None, None)
        if not pair or reward.shape != (self.count,) or reward.dtype.kind not in "biuf" or \
                success.shape != (self.count,) or success.dtype != bool:
            raise vibe.Error(f"judge() of the task {self.name} gives {vibe._shown(said)}; give rewards and successes, arrays of "
                             f"{self.count} numbers and {self.count} times True or False.")
        if not np.isfinite(reward).all():
            raise vibe.Error(f"judge() of the task {self.name}: the reward is {reward[~np.isfinite(reward)][0]}; give finite numbers.")
        return reward.astype(float), success

    def _steps(self):
        return max(1, round(1 / (self.rate * self.organ[0].model.step_period)))

    def speeds_of(self, slot):
        """The joint speeds of a slot at action 1."""
        return self.speeds

    def _speed(self, actions):
        """Joint speeds as shares of the greatest, from shares of them or from the tip's velocity in its own axes."""
        if self.mode == "joints":
            return actions[:, : len(self.joints)]
        shares = np.zeros((self.count, len(self.joints)))
        for slot, simulation in enumerate(self.simulation):
            shares[slot] = tip_motion(simulation.jacobian, simulation.tip_pose, TIP_SPEED * actions[slot], self.speeds_of(slot))
        return shares

    def judge(self, before, after):
        """For subclasses: (reward, success) of a step, each (count,)."""
        raise NotImplementedError

    # --- what is seen

    def look(self):
        """Of every slot: joints, tip, direction, turn, wrench, goal, wall; world, SI."""
        found = vibe.observe_all(self.simulation)
        pose = found["tip_pose"]
        place = vibe.wall_points(self.simulation, self.triangle, self.weight)
        return {"joints": found["joints"], "tip": pose[:, :3, 3], "turn": pose[:, :3, :3],
                "direction": pose[:, :3, 0], "wrench": found["wrench"], "goal": place[:, 0], "wall": place[:, 1:],
                "grips": found["grips"]}

    def current(self):
        """What look() says of the present; looked up once."""
        self.seen = self.seen or self.look()
        return self.seen

    def observe(self):
        """The observation of every slot, as float32."""
        seen = self.current()
        parts = {name: seen[name] for name in ("joints", "tip", "direction", "wrench", "goal", "wall")}
        parts["to_goal"] = np.einsum("nij,ni->nj", seen["turn"], seen["goal"] - seen["tip"])
        parts.update(self._further(seen))
        parts = {name: np.array(value, np.float32) for name, value in parts.items()}  # copies: a task goes on with its own
        if self.camera:
            wanted = {"normals": "normal" in self.pictures, "colour": "colour" in self.pictures, "tool": self.tool}
            seen = [simulation.camera(*self.camera, **wanted)
                    for simulation in self.simulation]
            parts.update({name: np.nan_to_num(np.stack([one[name] for one in seen]), nan=0.0) for name in self.pictures})
        return parts

    def _further(self, seen):
        """What observe_further() says, or vibe.Error if it is not what `further` declares."""
        found = self.observe_further(seen)
        for name in {**self.further, **found}:
            if name not in self.further:
                raise vibe.Error(f"The task {self.name}: the observation '{name}' is not in the space; add it to 'further'.")
            shape = (self.count, *self.further[name][0])
            if np.shape(found.get(name)) != shape:
                raise vibe.Error(f"The task {self.name}: the observation '{name}' is not of its space, which has the shape {shape}; "
                                 "give that by observe_further().")
        return found

    def observe_further(self, seen):
        """For subclasses: the arrays of `further`."""
        return {}

    def measures(self, slot):
        """What `info` says of a slot."""
        return {"organ": self.organ[slot].name, "time": float(self.time[slot]),
                "max_force": float(self.best_force[slot]), "events": [event.kind for event in self.events[slot]],
                **({"varied": dict(self.variation.values[slot])} if self.variation.vary else {})}

    def expert(self, seed):
        """For subclasses: a policy with reset(task) and action(task, observation) that shows how it is done, or None."""

    def close(self):
        for organ, simulation in zip(self.organ, self.simulation):
            if simulation is not None:
                organ.give(simulation)
        self.simulation = [None] * self.count
        self.organ = [None] * self.count
        self.closed = True

    def _check_open(self):
        if self.closed:
            raise vibe.Error("The environment is closed; make another one.")


def joints_at(model, position, outward, joints):
    """Joints (7,) with the tip within 1 mm of a position, found from others, or None. From any side: four joints reach no place
    in just any direction, so that the one asked for follows the one found."""
    for _ in range(10):
        joints = model.inverse_kinematics(position, outward, joints)
        pose = model.forward_kinematics(joints)
        if np.linalg.norm(pose[:3, 3] - position) < 1e-3:
            return joints
        outward = pose[:3, 0]
    return None


def _shown_alike(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name!r}: {_shown_alike(value[name])}" for name in sorted(value, key=str)) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "(" + ", ".join(map(_shown_alike, value)) + ")"
    return repr(value.item() if isinstance(value, np.generic) else value)


def _register(task):
    """Makes a class known by its name. One of the same place is what it was before it was changed, as in a notebook."""
    known = TASKS.get(task.name, task)
    if (known.__module__, known.__qualname__) != (task.__module__, task.__qualname__):
        raise vibe.Error(f"{known.__module__} has a task {task.name!r}; give that of {task.__module__} another name.")
    TASKS[task.name] = task
    identifier = f"vibe/{task.name}-v0"
    if REAL and identifier not in gymnasium.registry:
        gymnasium.register(identifier, entry_point="vibe.env:Environment", vector_entry_point="vibe.env:VectorEnvironment",
                           max_episode_steps=task.steps_of_episode(), kwargs={"task": task.name})


def task_of(task):
    """The class of a task: itself, its name, or MODULE:NAME, which imports the module that defines it, as Gymnasium does."""
    if isinstance(task, type) and issubclass(task, Task):
        return task
    name = task
    if isinstance(task, str) and ":" in task:
        module, name = task.split(":", 1)
        try:
            importlib.import_module(module)
        except ImportError as error:
            raise vibe.Error(f"The task {vibe._shown(task)} cannot be had ({error}); name a module that can be imported.") from None
    if not isinstance(name, str) or name not in TASKS:
        raise vibe.Error(f"There is no task {vibe._shown(name)}; use one of {', '.join(TASKS)}.")
    return TASKS[name]
