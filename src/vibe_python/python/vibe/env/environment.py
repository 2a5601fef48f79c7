"""The environments: one episode at a time, and many at once."""

import os

import numpy as np

import vibe

from . import api
from .episodes import numbers, task_of, whole


def _generator(seed):
    if seed is not None:
        whole("seed", seed, 0, 2**64 - 1)
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))


class Environment(api.Env):
    """One episode at a time, with the interface of gymnasium.Env.

    task       a name in vibe.env.TASKS, MODULE:NAME of one that a module of yours defines, or a class
    particles  of the wall: 1,000 by default (docs/python.md says what that costs in accuracy)
    organs     (shape, scale) of the stomachs that reset() draws from, uniformly; vibe.env.TRAINING, vibe.env.HELD_OUT
    action     'joints': shares of the greatest joint speeds, then the buttons; 'tip': of the tip's velocity, in tasks
               that move nothing else
    camera     (width, height, field of view [rad]): adds pictures to the observation, (height, width) each, 0 where
               nothing is seen
    pictures   which: of 'depth' float32 [m], 'label' uint8, 'normal' (.., 3) float32 and 'colour' (.., 3) uint8, as
               vibe.Simulation.camera() has them; depth and label by default
    step_period
               simulated time per step [s], a whole part of that of an action; None: one step per action. Shorter steps
               are slower and more accurate (docs/python.md)
    breathing  None (still), 'slight', 'moderate' or 'strong': the diaphragm moves the stomach (vibe.env.BREATHING)

    reset(seed) draws stomach, start and goal; the same seed gives the same episode, to the bit. Steps after an episode
    has ended raise vibe.Error.
    """

    metadata = {"render_modes": []}

    def __init__(self, task="Reach", *, render_mode=None, **settings):
        if render_mode is not None:
            raise vibe.Error("The environment draws no pictures; leave render_mode out, or observe "
                             "camera=(64, 64, 1.7), pictures=['colour'].")
        self.render_mode = None
        self.task = task_of(task)(1, **settings)
        self.observation_space, self.action_space = self.task.observation_space, self.task.action_space
        self._random = None
        self._ended = True

    @property
    def simulation(self):
        """The vibe.Simulation of the episode."""
        return self.task.simulation[0]

    def _row(self, parts):
        return {name: value[0] for name, value in parts.items()}

    def reset(self, *, seed=None, options=None):
        if seed is not None or self._random is None:
            self._random = _generator(seed)
        if api.REAL:
            super().reset(seed=seed)
        self.task.begin(0, self._random)
        self._ended = False
        return self._row(self.task.observe()), self.task.measures(0)

    def step(self, action):
        if self.task.closed:
            raise vibe.Error("The environment is closed; make another one.")
        if self._ended:
            raise vibe.Error("The episode has ended, or none has begun; call reset().")
        reward, success, truncated = self.task.advance(numbers(action)[None])
        self._ended = bool(success[0] or truncated[0])
        info = {**self.task.measures(0), "is_success": bool(success[0])}
        return self._row(self.task.observe()), float(reward[0]), bool(success[0]), bool(truncated[0]), info

    def close(self):
        self.task.close()


class VectorEnvironment(api.VectorEnv):
    """Many episodes at once, with the interface of gymnasium.vector.VectorEnv: one call steps all of them, in threads of
    C++, and the models are shared. An episode has the bits that it has alone. Arguments: as Environment, and

    count      of episodes side by side
    threads    that step them; default: the cores that the process may use
    autoreset  'next_step' (default): the call after the end of an episode ignores its action and resets it;
               'same_step': it is reset at once, and its last observation is in info['final_obs'];
               'disabled': reset(options={'reset_mask': ...}) resets it
    """

    metadata = {"render_modes": []}

    def __init__(self, task="Reach", count=8, *, threads=None, autoreset="next_step", **settings):
        if not isinstance(autoreset, str) or autoreset not in ("next_step", "same_step", "disabled"):
            raise vibe.Error(f"'autoreset' is {vibe._shown(autoreset)}; use 'next_step', 'same_step' or 'disabled'.")
        threads = len(os.sched_getaffinity(0)) if threads is None else threads
        self.task = task_of(task)(count, threads=threads, **settings)
        self.num_envs, self.autoreset, self.render_mode = count, autoreset, None
        self.single_observation_space, self.single_action_space = self.task.observation_space, self.task.action_space
        self.observation_space = api.batched(self.single_observation_space, count)
        self.action_space = api.batched(self.single_action_space, count)
        if api.AutoresetMode is not None:
            self.metadata = {**self.metadata, "autoreset_mode": api.AutoresetMode[autoreset.upper()]}
        self._random = [None] * count
        self._ended = np.ones(count, bool)

    def reset(self, *, seed=None, options=None):
        """seed: one number, from which slot k gets seed + k; a list of one per slot; None."""
        seeds = [None] * self.num_envs if seed is None else \
            list(seed) if isinstance(seed, (list, tuple, np.ndarray)) and np.ndim(seed) == 1 else \
            [whole("seed", seed, 0, 2**63) + k for k in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise vibe.Error(f"There are {len(seeds)} seeds for {self.num_envs} episodes; give one each.")
        if options is not None and not isinstance(options, dict):
            raise vibe.Error(f"'options' is {vibe._shown(options)}; give a dictionary, or None.")
        mask = np.asarray((options or {}).get("reset_mask", True))
        if mask.dtype != bool or mask.shape not in ((), (self.num_envs,)):
            raise vibe.Error(f"'reset_mask' has the shape {mask.shape}; give {self.num_envs} times True or False.")
        for slot in np.flatnonzero(np.broadcast_to(mask, self.num_envs)):
            if seeds[slot] is not None or self._random[slot] is None:
                self._random[slot] = _generator(seeds[slot])
            self._begin(slot)
        return self.task.observe(), self._info(np.zeros(self.num_envs, bool))

    def _begin(self, slot):
        self.task.begin(slot, self._random[slot])
        self._ended[slot] = False

    def _info(self, success):
        rows = [self.task.measures(slot) for slot in range(self.num_envs)]
        info = {name: np.array([row[name] for row in rows], float) for name in ("time", "max_force")}
        return {**info, "is_success": success, "organ": [row["organ"] for row in rows],
                "events": [row["events"] for row in rows]}

    def step(self, actions):
        ended = self._ended.copy()
        if ended.any() and self.autoreset != "next_step":
            raise vibe.Error("An episode has ended, or none has begun; call reset() first.")
        actions = numbers(actions).copy()
        if ended.any() and actions.shape == (self.num_envs,) + self.single_action_space.shape:
            actions[ended] = 0
        reward, success, truncated = self.task.advance(actions)
        for slot in np.flatnonzero(ended):  # their step did not count
            self._begin(slot)
            reward[slot], success[slot], truncated[slot] = 0, False, False
        self._ended = success | truncated
        info = self._info(success)
        seen = self.task.observe()
        if self.autoreset == "same_step" and self._ended.any():
            over = np.flatnonzero(self._ended)
            info.update(final_obs=np.full(self.num_envs, None, object), _final_obs=self._ended.copy())
            for slot in over:
                info["final_obs"][slot] = {name: value[slot].copy() for name, value in seen.items()}
                self._begin(slot)
            seen = self.task.observe()
        return seen, reward, success, truncated, info

    def close(self, **_):
        self.task.close()
