"""The environments: one episode at a time, and many at once."""

from __future__ import annotations

import copy
import functools
import os
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

import vibe

from .. import _pictures
from . import api
from .episodes import Task, task_of
from .settings import Settings, chosen, named, numbers, whole

if TYPE_CHECKING:
    from typing_extensions import Unpack


def _generator(seed):
    if seed is not None:
        whole("seed", seed, 0, 2**64 - 1)
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))


with_settings = functools.partial(named, of=Task.__init__)


def _made(cls, task, settings, state, spaces):
    """An environment from what it was made of and what it is in the midst of, for pickle; spaces draw samples."""
    environment = cls(task, **settings)
    if state is not None:
        environment.restore(state)
    vars(environment).update(copy.deepcopy(spaces))
    return environment


class _Episodes:
    """What the single and the vector environment share: their task, and their state."""

    metadata = {"render_modes": ["rgb_array"]}
    _window = None  # of render_mode 'human'
    _torn = False  # a step was broken off
    _kind = "Environment"  # of which snapshots are

    def _prepare(self, task, settings, render_mode, view, **further):
        modes = self.metadata["render_modes"]
        if render_mode is not None and (not isinstance(render_mode, str) or render_mode not in modes):
            raise vibe.Error(f"'render_mode' is {vibe._shown(render_mode)}; use {', '.join(map(repr, modes))}, or None.")
        _pictures.check_view(view)
        kind = task_of(task)
        kind.check_settings(settings)
        self.task, self.render_mode, self._view = kind(**further, **settings), render_mode, view
        self._made_of, self._settings = task, copy.deepcopy(settings)  # what a caller does to his dictionaries later is no setting
        self.metadata = {**self.metadata, "render_fps": kind.rate}

    def snapshot(self) -> dict[str, Any]:
        """Everything that decides the future: episodes, clocks, goals, what was seen of the wall, random generators. It can be
        pickled, and restored any number of times; the futures are equal to the bit."""
        kind = type(self.task)
        return {**self._same(), "episodes": self.task.state(), **copy.deepcopy({name: getattr(self, name) for name in ("_random", "_ended")})}

    def _same(self):
        """What environments have in common that take snapshots of each other."""
        kind = type(self.task)
        return {"kind": self._kind, "task": f"{kind.__module__}.{kind.__qualname__}", "settings": self.task.shown_settings(self._settings),
                "number of episodes": self.task.count}

    def restore(self, snapshot: dict[str, Any]) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Back to a snapshot() of an environment of the same task and settings. Returns the observation and info, as reset()
        does, without events."""
        if not isinstance(snapshot, dict) or "episodes" not in snapshot:
            raise vibe.Error(f"The snapshot is {vibe._shown(snapshot)}; give one of snapshot() of an environment.")
        for name, here in self._same().items():
            if snapshot.get(name) != here:
                raise vibe.Error(f"The snapshot is of an environment with the {name} {snapshot.get(name)}, and this one has {here}; "
                                 "make one like that.")
        self.task.set_state(snapshot["episodes"])
        self._random, self._ended = copy.deepcopy((snapshot["_random"], snapshot["_ended"]))
        for slot, random in enumerate(self._random if isinstance(self._random, list) else [self._random]):
            if random is not None:
                self.task.random[slot] = random  # one generator, as reset() has it
        self._torn = False
        return self._seen()

    def _advance(self, actions):
        """What the task says of an action. One that is broken off, by Ctrl+C or an error of the task, ends the episodes, whose
        clocks and actions do not agree any more."""
        if self._torn:
            raise vibe.Error("The last step was broken off in its midst; call reset(), or restore() a snapshot.")
        self._torn = True
        found = self.task.advance(actions)
        self._torn = False
        return found

    def _spaces(self):
        return {name: value for name, value in vars(self).items() if name.endswith("_space")}

    def __deepcopy__(self, _):
        made = _made(*self.__reduce__()[1])
        made.spec = getattr(self, "spec", None)
        return made

    def _has_begun(self):
        return not self.task.closed and any(simulation is not None for simulation in self.task.simulation)

    def _check_begun(self):
        if not self._has_begun():
            raise vibe.Error("No episode has begun; call reset() first.")

    def _pictures(self):
        self._check_begun()
        marked = self._view == "outside" and self.task.has_place
        goals = self.task.look()["goal"] if marked else [None] * self.task.count
        return tuple(vibe.picture(simulation, self._view, goal=goal) for simulation, goal in zip(self.task.simulation, goals))

    def _rendered(self):
        if self.render_mode is None:
            raise vibe.Error("The environment was made without render_mode='rgb_array'; give that.")
        return self._pictures()


class Environment(_Episodes, api.Env):
    """One episode at a time, with the interface of gymnasium.Env.

    task       a name in vibe.env.TASKS, MODULE:NAME of one that a module of yours defines, or a class
    particles  of the wall: 1,000 by default (docs/python.md says what that costs in accuracy)
    organs     (shape, scale) of the stomachs, and scene files, that reset() draws from, uniformly; vibe.env.TRAINING,
               vibe.env.HELD_OUT
    action     'joints': shares of the greatest joint speeds, then the buttons; 'tip': of the tip's velocity, in tasks
               that move nothing else
    camera     (width, height, field of view [rad]): adds pictures to the observation, (height, width) each, 0 where
               nothing is seen
    pictures   which: of 'depth' float32 [m], 'label' uint8, 'normal' (.., 3) float32 and 'colour' (.., 3) uint8, as
               vibe.Simulation.camera() has them; depth and label by default
    tool       whether they show the suturing device and the threads
    step_period
               simulated time per step [s], a whole part of that of an action; None: one step per action. Shorter steps
               are slower and more accurate (docs/python.md)
    breathing  None (still), 'slight', 'moderate' or 'strong': the diaphragm moves the stomach (vibe.env.BREATHING)
    motion     None, 'slight', 'moderate' or 'strong': contraction waves, breath and heart of this grade; `breathing`, where it
               is given, is the breath's
    scene      other values of keys of the scene, by section, as vibe.load() takes them
    vary       what reset() draws anew, by SECTION.KEY of the scene, 'action.delay' [s] and 'action.noise' (standard
               deviation of the shares): ('uniform', least, greatest), ('normal', mean, standard deviation) or
               ('choice', values); info['varied'] says what was drawn. A scene with new values takes a second to prepare
    tolerance, along, around
               of the goal, instead of the task's
    max_episode_steps
               actions until an episode is truncated, instead of the task's
    render_mode
               None; 'rgb_array': render() gives a picture with device and threads; 'human': a window shows it after every
               reset() and step(), in simulated time (tkinter and a display are needed). Copies have no window
    view       of these pictures: 'endoscope', or 'outside': organ, scope and goal from before the patient

    reset(seed) draws stomach, start and goal; the same seed gives the same episode, to the bit. reset(options=...) chooses
    instead: {'organ': (shape, scale) or a scene file, 'start': 0 to 3, 'goal': (along, around), 'phase': 0 to 7,
    'varied': {name: value}}, which a curriculum can use; along is a share of the axis from 0 to 1, around an angle [rad].
    Steps after an episode has ended raise vibe.Error. snapshot(), restore(), copy.deepcopy() and pickle take a begun episode with them.
    """

    metadata = {"render_modes": ["rgb_array", "human"]}

    @with_settings
    def __init__(self, task: Union[str, type[Task]] = "Reach", *, render_mode: Optional[str] = None, view: str = "endoscope",
                 **settings: Unpack[Settings]) -> None:
        self._prepare(task, settings, render_mode, view)
        self.observation_space, self.action_space = self.task.observation_space, self.task.action_space
        self._random = None
        self._ended = True
        if render_mode == "human":
            self._window = _pictures.Window(f"vibe: {self.task.name}", lambda: self._pictures()[0])

    def __reduce__(self):
        settings = {**self._settings, "render_mode": None if self._window else self.render_mode, "view": self._view}
        return _made, (type(self), self._made_of, settings, self.snapshot() if self._has_begun() else None, self._spaces())

    def __repr__(self):
        return f"<vibe.env.Environment of {self.task.name or type(self.task).__name__}, {self.task.particles} particles>"

    @property
    def simulation(self) -> vibe.Simulation:
        """The vibe.Simulation of the episode."""
        self._check_begun()
        return self.task.simulation[0]

    def _seen(self):
        return {name: value[0] for name, value in self.task.observe().items()}, self.task.measures(0)

    def reset(self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        choices = chosen(options)
        if seed is not None or self._random is None:
            self._random = _generator(seed)
        super().reset(seed=None if seed is None else int(seed))
        self._ended = True  # until there is another episode
        self.task.begin(0, self._random, choices)
        self._ended = self._torn = False
        return self._show()

    def _show(self):
        if self._window:
            self._window.update(1 / self.task.rate)
        return self._seen()

    def render(self) -> Optional[np.ndarray]:
        """A picture of `view`, (480, 480, 3) uint8, with device and threads; None with render_mode='human', whose window shows it."""
        if self._window is None:
            return self._rendered()[0]
        self._check_begun()
        self._window.update()
        return None

    def _repr_png_(self):
        return _pictures.png(self._pictures()[0]) if self._has_begun() else None

    def step(self, action: Any) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        if self.task.closed:
            raise vibe.Error("The environment is closed; make another one.")
        if self._ended:
            raise vibe.Error("The episode has ended, or none has begun; call reset().")
        reward, success, truncated = self._advance(numbers(action, self.action_space.shape)[None])
        self._ended = bool(success[0] or truncated[0])
        seen, info = self._show()
        return seen, float(reward[0]), bool(success[0]), bool(truncated[0]), {**info, "is_success": bool(success[0])}

    def close(self) -> None:
        self.task.close()
        if self._window:
            self._window.close()


class VectorEnvironment(_Episodes, api.VectorEnv):
    """Many episodes at once, with the interface of gymnasium.vector.VectorEnv: one call steps all of them, in threads of
    C++, and the models are shared. An episode has the bits that it has alone. Arguments: as Environment, and

    count      of episodes side by side; gymnasium.make_vec() calls it num_envs
    threads    that step them; default: the cores that the process may use
    autoreset  'next_step' (default): the call after the end of an episode ignores its action and resets it;
               'same_step': it is reset at once, and its last observation is in info['final_obs'];
               'disabled': reset(options={'reset_mask': ...}) resets it
    """

    _kind = "VectorEnvironment"

    @with_settings
    def __init__(self, task: Union[str, type[Task]] = "Reach", count: int = 8, *, num_envs: Optional[int] = None, threads: Optional[int] = None,
                 autoreset: str = "next_step", render_mode: Optional[str] = None, view: str = "endoscope",
                 **settings: Unpack[Settings]) -> None:
        if not isinstance(autoreset, str) or autoreset not in ("next_step", "same_step", "disabled"):
            raise vibe.Error(f"'autoreset' is {vibe._shown(autoreset)}; use 'next_step', 'same_step' or 'disabled'.")
        count = count if num_envs is None else num_envs
        self._prepare(task, settings, render_mode, view, count=count, threads=len(os.sched_getaffinity(0)) if threads is None else threads)
        self._threads = threads
        self.num_envs, self.autoreset = count, autoreset
        self.single_observation_space, self.single_action_space = self.task.observation_space, self.task.action_space
        self.observation_space = api.batched(self.single_observation_space, count)
        self.action_space = api.batched(self.single_action_space, count)
        if api.AutoresetMode is not None:
            self.metadata = {**self.metadata, "autoreset_mode": api.AutoresetMode[autoreset.upper()]}
        self._random = [None] * count
        self._ended = np.ones(count, bool)

    def __reduce__(self):
        settings = {**self._settings, "count": self.num_envs, "threads": self._threads, "autoreset": self.autoreset,
                    "render_mode": self.render_mode, "view": self._view}
        return _made, (type(self), self._made_of, settings, self.snapshot() if self._has_begun() else None, self._spaces())

    def reset(self, *, seed: Optional[Union[int, Sequence[Optional[int]]]] = None, options: Optional[dict[str, Any]] = None) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """seed: one number, from which slot k gets seed + k; a list of one per slot; None. options: as those of Environment,
        for every slot, and 'reset_mask': which slots (count,) bool."""
        seeds = [None] * self.num_envs if seed is None else \
            list(seed) if isinstance(seed, (list, tuple, np.ndarray)) and np.ndim(seed) == 1 else \
            [whole("seed", seed, 0, 2**63) + k for k in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise vibe.Error(f"There are {len(seeds)} seeds for {self.num_envs} episodes; give one each.")
        choices = chosen(options, ["reset_mask"])
        mask = np.asarray((options or {}).get("reset_mask", True))
        if mask.dtype != bool or mask.shape not in ((), (self.num_envs,)) or not mask.any():
            raise vibe.Error(f"'reset_mask' is {vibe._shown(mask)}; give {self.num_envs} times True or False, at least one of them True.")
        if any(random is None and not now for random, now in zip(self._random, np.broadcast_to(mask, self.num_envs))):
            raise vibe.Error("'reset_mask' leaves out an episode that has never begun; reset all of them first.")
        super().reset(seed=int(seed) if isinstance(seed, (int, np.integer)) else None)
        for slot in np.flatnonzero(np.broadcast_to(mask, self.num_envs)):
            if seeds[slot] is not None or self._random[slot] is None:
                self._random[slot] = _generator(seeds[slot])
            self._begin(slot, choices)
        self._torn = self._torn and not mask.all()
        return self._seen()

    def _begin(self, slot, choices=None):
        self._ended[slot] = True  # until there is another episode
        self.task.begin(slot, self._random[slot], choices)
        self._ended[slot] = False

    def _seen(self):
        return self.task.observe(), self._info([self.task.measures(slot) for slot in range(self.num_envs)])

    def _info(self, rows):
        """As Gymnasium has it: an array per name, and a mask of the slots that say it."""
        info = {}
        for slot, row in enumerate(rows):
            info = self._add_info(info, row, slot)
        return info

    def render(self) -> tuple[np.ndarray, ...]:
        """A picture per slot, as Environment.render()."""
        return self._rendered()

    def step(self, actions: Any) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        ended = self._ended.copy()
        if ended.any() and self.autoreset != "next_step":
            raise vibe.Error("An episode has ended, or none has begun; call reset() first.")
        actions = numbers(actions, (self.num_envs,) + self.single_action_space.shape)
        actions[ended] = 0
        reward, success, truncated = self._advance(actions)
        for slot in np.flatnonzero(ended):  # their step did not count
            self._begin(slot)
            reward[slot], success[slot], truncated[slot] = 0, False, False
        self._ended = success | truncated
        rows = [self.task.measures(slot) if ended[slot] else {**self.task.measures(slot), "is_success": bool(success[slot])}
                for slot in range(self.num_envs)]
        seen = self.task.observe()
        if self.autoreset == "same_step" and self._ended.any():
            for slot in np.flatnonzero(self._ended):
                final = {name: value[slot].copy() for name, value in seen.items()}
                self._begin(slot)
                rows[slot] = {"final_obs": final, "final_info": rows[slot], **self.task.measures(slot)}
            seen = self.task.observe()
        return seen, reward, success, truncated, self._info(rows)

    def close_extras(self, **_):
        self.task.close()
