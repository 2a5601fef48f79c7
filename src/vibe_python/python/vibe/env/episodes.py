"""Episodes side by side: what the single and the vector environment share, so that both have the same bits."""

import functools
import importlib
import math

import numpy as np

import vibe

from . import organs as _organs
from .api import REAL, gymnasium, spaces

INSUFFLATE = vibe.BUTTONS.index("insufflate")
SUCCESS = 10.0  # reward of an episode that succeeds
FORCE_FREE = 2.0  # force on the tool that costs nothing [N]; twice the mean of the first session of the README
GOALS = 64  # per start, drawn once
WALL_POINTS = 48  # places of the wall that an observation holds
#: pictures that an observation may hold: channels, type, least and greatest value
PICTURES = {"depth": ((), np.float32, 0, np.inf), "label": ((), np.uint8, 0, 5), "normal": ((3,), np.float32, -1, 1),
            "colour": ((3,), np.uint8, 0, 255)}


def whole(name, value, least, most):
    """A whole number within a range, or vibe.Error."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise vibe.Error(f"'{name}' is {vibe._shown(value)}; give a whole number from {least} to {most}.")
    return int(value)


def numbers(action):
    """An action as an array of float, or vibe.Error."""
    try:
        given = np.asarray(action)
        if given.dtype.kind in "biuf":
            return given.astype(float)
    except (TypeError, ValueError, OverflowError):
        pass
    raise vibe.Error(f"The action is {vibe._shown(action)}; give an array of numbers from -1 to 1.")


def _number(value):
    return isinstance(value, (int, float, np.integer, np.floating)) and np.isfinite(float(value))


def _pairs(organs):
    """Pairs (shape, scale) as a tuple of tuples."""
    pairs = tuple(organs) if isinstance(organs, (list, tuple)) else ()
    if not pairs:
        raise vibe.Error("'organs' is empty or no list; give pairs (shape, scale), such as vibe.env.TRAINING.")
    for pair in pairs:
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or pair[0] not in _organs.SHAPES or not _number(pair[1]):
            raise vibe.Error(f"'organs' holds {vibe._shown(pair)}; give pairs of a shape ({', '.join(_organs.SHAPES)}) and a scale.")
    return tuple(tuple(pair) for pair in pairs)


def _camera(camera):
    if camera is None:
        return None
    if not isinstance(camera, (list, tuple)) or len(camera) != 3 or not _number(camera[2]) or not 0.01 < camera[2] < 3.1:
        raise vibe.Error(f"'camera' is {vibe._shown(camera)}; give (width, height, field of view from 0.01 to 3.1 rad), or None.")
    return whole("camera[0]", camera[0], 1, 4096), whole("camera[1]", camera[1], 1, 4096), float(camera[2])


def _pictures(pictures):
    """Which pictures the camera gives, as a tuple of names."""
    names = tuple(pictures) if isinstance(pictures, (list, tuple)) else ()
    if not names or not all(isinstance(name, str) and name in PICTURES for name in names) or len(set(names)) < len(names):
        raise vibe.Error(f"'pictures' is {vibe._shown(pictures)}; give a list of some of {', '.join(PICTURES)}, each once.")
    return names


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
    seconds = 10.0  #: simulated time until an episode is truncated
    rate = 20  #: actions per simulated second
    rate_of_steps = 20  #: steps per simulated second, at least, where `step_period` does not say it
    joints = vibe.JOINTS[:4]  #: that actions move
    speeds = np.array([0.05, 1.0, 1.0, 1.0])  #: of the joints at action 1 [m/s], [rad/s]
    buttons = False  #: whether the action ends with the six buttons, pressed above 0
    along, around = (0.3, 0.72), (-1.2, 1.2)  #: uniform distribution of the goal: share of the axis, angle around it [rad]

    def __init_subclass__(cls, **keywords):
        super().__init_subclass__(**keywords)
        if vars(cls).get("name"):
            _register(cls)

    def __init__(self, count=1, *, particles=1000, organs=_organs.TRAINING, action="joints", threads=1, camera=None,
                 pictures=("depth", "label"), breathing=None, step_period=None):
        if not isinstance(action, str) or action not in ("joints", "tip"):
            raise vibe.Error(f"'action' is {vibe._shown(action)}; use 'joints' or 'tip'.")
        if breathing is not None and (not isinstance(breathing, str) or breathing not in _organs.BREATHING):
            raise vibe.Error(f"'breathing' is {vibe._shown(breathing)}; use {', '.join(_organs.BREATHING)}, or None.")
        if action == "tip" and not self.moves_tip_only():
            raise vibe.Error(f"The task {self.name} moves more than the tip; use action='joints'.")
        self.count, self.particles = whole("count", count, 1, 65536), whole("particles", particles, 100, 1000000)
        self.organs, self.breathing = _pairs(organs), breathing
        self.mode, self.threads, self.camera = action, whole("threads", threads, 1, 1024), _camera(camera)
        self.pictures, self.step_period = _pictures(pictures), self._period(step_period)
        self.simulation = [None] * count
        self.organ = [None] * count
        self.random = [np.random.default_rng(k) for k in range(count)]
        self.triangle = np.zeros((count, 1 + WALL_POINTS))  # of the goal, then of other places of the wall
        self.weight = np.full((count, 1 + WALL_POINTS, 3), 1 / 3)
        self.seen = None
        self.time = np.zeros(count)
        self.events = [[] for _ in range(count)]
        self.best_force = np.zeros(count)
        self.closed = False

    def _period(self, period):
        """Simulated time per step [s], of which a whole number makes up an action; None: an action, at most 1/20 s."""
        if period is None:
            return 1 / (self.rate * max(1, math.ceil(self.rate_of_steps / self.rate)))
        steps = 1 / (self.rate * period) if _number(period) and 1e-4 <= period <= 0.1 else 0
        if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
            raise vibe.Error(f"'step_period' is {vibe._shown(period)}; give a whole part of an action of 1/{self.rate} s, such as "
                             f"{1 / self.rate:.5g}, or None.")
        return float(period)

    @classmethod
    def moves_tip_only(cls):
        """Whether an action may be the tip's velocity."""
        return len(cls.joints) <= 4 and not cls.buttons

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
        def box(*shape, low=-np.inf, high=np.inf, dtype=np.float32):
            return spaces.Box(low, high, shape, dtype)

        parts = {
            "joints": box(len(vibe.JOINTS)), "tip": box(3), "direction": box(3), "wrench": box(6), "goal": box(3),
            "to_goal": box(3), "wall": box(WALL_POINTS, 3),
        }
        if self.camera:
            for name in self.pictures:
                channels, dtype, low, high = PICTURES[name]
                parts[name] = box(self.camera[1], self.camera[0], *channels, low=low, high=high, dtype=dtype)
        parts.update({name: box(*shape) for name, (shape, _) in self.further.items()})
        return spaces.Dict(parts)

    # --- episodes

    def begin(self, slot, random):
        """A new episode in one slot: draws stomach, start and goal."""
        self._check_open()
        self.random[slot] = random
        drawn = self.organs[random.integers(len(self.organs))]
        organ = _organs.organ(*drawn, self.particles, self.breathing, self.step_period)
        if self.organ[slot] is not organ:
            if self.simulation[slot] is not None:
                self.organ[slot].give(self.simulation[slot])
            self.organ[slot], self.simulation[slot] = organ, organ.take()
        start = int(random.integers(len(organ.starts)))
        phases = organ.starts[start]
        self.simulation[slot].restore(phases[random.integers(len(phases)) if self.breathing else 0])
        self._set_goal(slot, organ, start, int(random.integers(GOALS)))
        triangles = len(organ.model.triangles)
        self.triangle[slot, 1:] = (np.arange(WALL_POINTS) * triangles) // WALL_POINTS
        self.time[slot] = 0
        self.best_force[slot] = 0
        self.events[slot] = []
        self.seen = None
        self.begun(slot)

    def _set_goal(self, slot, organ, start, number):
        """One of the goals of a start, which are found when first asked for: that takes ten times as long as a step."""
        key = (type(self), self.along, self.around, start, number)
        if key not in organ.goals:
            organ.goals[key] = self._draw_goal(organ, self.simulation[slot].joints, [21, start, number])
        place, self.triangle[slot, 0], self.weight[slot, 0] = organ.goals[key]
        self.place = getattr(self, "place", [None] * self.count)
        self.place[slot] = place

    def _draw_goal(self, organ, joints, seed):
        random = np.random.default_rng(seed)
        for _ in range(100):
            place = random.uniform(*self.along), random.uniform(*self.around)
            triangle, weight, position = organ.target(*place)
            if self.reachable(organ.model, position, organ.anatomy.outward(triangle, weight), joints):
                break
        return place, triangle, weight

    def reachable(self, model, position, outward, joints):
        """Whether the scope can bring its tip there, as far as its joints go."""
        found = model.inverse_kinematics(position, outward, joints)
        return np.linalg.norm(model.forward_kinematics(found)[:3, 3] - position) < 1e-3

    def begun(self, slot):
        """For subclasses: what begins with an episode."""

    # --- steps

    def advance(self, actions):
        """One action in every slot. Returns rewards, terminated and truncated (count,)."""
        self._check_open()
        actions = np.asarray(actions, float)
        expected = (self.count,) + self.action_space.shape
        if actions.shape != expected:
            raise vibe.Error(f"The action has the shape {actions.shape}; give one of the shape {expected}.")
        if not np.isfinite(actions).all():
            raise vibe.Error("The action holds a value that is not finite; give numbers from -1 to 1.")
        if any(simulation is None for simulation in self.simulation):
            raise vibe.Error("The environment has not begun; call reset() first.")
        actions = np.minimum(np.maximum(actions, -1), 1)
        before = self.current()
        joints = before["joints"].copy()
        joints[:, : len(self.joints)] += self._speed(actions) * (self.speeds / self.rate)
        buttons = np.zeros((self.count, len(vibe.BUTTONS)))
        if self.buttons:
            buttons[:] = actions[:, len(self.joints):] > 0
        buttons[:, INSUFFLATE] = 1
        self.events = vibe.step_all(self.simulation, joints, buttons, self._steps(), self.threads)
        self.time += 1 / self.rate
        self.seen = self.look()
        force = np.linalg.norm(self.seen["wrench"][:, :3], axis=1)
        self.best_force = np.maximum(self.best_force, force)
        reward, success = self.judge(before, self.seen)
        reward = reward - 0.01 - 0.02 * np.maximum(force - FORCE_FREE, 0) + SUCCESS * success
        return reward, success, ~success & (self.time >= self.seconds - 1e-9)

    def _steps(self):
        return max(1, round(1 / (self.rate * self.organ[0].model.step_period)))

    def _speed(self, actions):
        """Joint speeds as shares of the greatest, from shares of them or from the tip's velocity in its own axes."""
        if self.mode == "joints":
            return actions[:, : len(self.joints)]
        shares = np.zeros((self.count, len(self.joints)))
        for slot, simulation in enumerate(self.simulation):
            speed = simulation.tip_pose[:3, :3] @ (TIP_SPEED * actions[slot])
            shares[slot] = tip_motion(simulation.jacobian, speed, self.speeds)
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
        parts.update(self.observe_further(seen))
        parts = {name: np.asarray(value, np.float32) for name, value in parts.items()}
        if self.camera:
            seen = [simulation.camera(*self.camera, normals="normal" in self.pictures, colour="colour" in self.pictures)
                    for simulation in self.simulation]
            parts.update({name: np.nan_to_num(np.stack([one[name] for one in seen]), nan=0.0) for name in self.pictures})
        return parts

    def observe_further(self, seen):
        """For subclasses: the arrays of `further`."""
        return {}

    def measures(self, slot):
        """What `info` says of a slot."""
        return {"organ": self.organ[slot].name, "time": float(self.time[slot]),
                "max_force": float(self.best_force[slot]), "events": [event.kind for event in self.events[slot]]}

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


def _register(task):
    """Makes a class known by its name. One of the same place is what it was before it was changed, as in a notebook."""
    known = TASKS.get(task.name, task)
    if (known.__module__, known.__qualname__) != (task.__module__, task.__qualname__):
        raise vibe.Error(f"{known.__module__} has a task {task.name!r}; give that of {task.__module__} another name.")
    TASKS[task.name] = task
    identifier = f"vibe/{task.name}-v0"
    if REAL and identifier not in gymnasium.registry:
        gymnasium.register(identifier, entry_point="vibe.env:Environment", kwargs={"task": task.name})


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


TIP_SPEED = 0.04  # of the tip at action 1 [m/s]


def tip_motion(jacobian, speed, limits, damping=2e-3):
    """Shares (4,) of the joint speeds that move the tip with a speed (3,) [m/s]: damped least squares in units of the
    limits, scaled down together where one would exceed its limit (Wampler 1986)."""
    scaled = jacobian[:3] * limits
    shares = scaled.T @ np.linalg.solve(scaled @ scaled.T + damping**2 * np.eye(3), speed)
    return shares / max(1.0, np.abs(shares).max())
