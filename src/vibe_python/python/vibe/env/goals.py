"""Reaching as libraries of hindsight replay want it: what was achieved, what is desired, and a reward that follows from both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

import vibe

from .api import REAL, gymnasium, spaces
from .environment import Environment, with_settings
from .settings import FAR, PICTURES, STRONG, Settings, places
from .tasks import Reach

if TYPE_CHECKING:
    from typing_extensions import Unpack


class GoalEnvironment(Environment):
    """Reach, or a task that derives from it, in the form of GoalEnv of Gymnasium-Robotics, which replay buffers with
    hindsight ask for (Andrychowicz 2017, arXiv 1707.01495). Arguments, snapshots and the rest are those of Environment.

    Observation: achieved_goal (3,), the tip, and desired_goal (3,), the place on the wall, in world [m]; observation (n,),
    everything else in the order of `parts`, each flattened; and pictures under their own names. Reward: 0 where the tip is
    within the task's tolerance of the inside of the wall, otherwise -1; the episode then ends.
    """

    @with_settings
    def __init__(self, task: Union[str, type[Reach]] = "Reach", *, render_mode: Optional[str] = None, view: str = "endoscope",
                 **settings: Unpack[Settings]) -> None:
        super().__init__(task, render_mode=render_mode, view=view, **settings)
        if not isinstance(self.task, Reach):
            raise vibe.Error(f"The task {self.task.name} does not end at a place that the tip reaches; give Reach, or one that derives from it.")
        boxes = self.observation_space.spaces
        #: names of what `observation` holds, in this order
        self.parts = [name for name in boxes if name not in PICTURES and name not in ("goal", "to_goal")]
        low, high = (np.concatenate([getattr(boxes[name], end).ravel() for name in self.parts]) for end in ("low", "high"))
        self.observation_space = spaces.Dict({
            "observation": spaces.Box(np.maximum(low, -STRONG), np.minimum(high, STRONG), dtype=np.float32),
            **{name: spaces.Box(-FAR, FAR, (3,), np.float32) for name in ("achieved_goal", "desired_goal")},
            **{name: box for name, box in boxes.items() if name in PICTURES}})

    def _seen(self):
        seen, info = super()._seen()
        return {"observation": np.concatenate([seen[name].ravel() for name in self.parts]), "achieved_goal": seen["tip"],
                "desired_goal": seen["goal"], **{name: value for name, value in seen.items() if name in PICTURES}}, info

    def step(self, action: Any) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
        seen, _, terminated, truncated, info = super().step(action)
        return seen, 0.0 if terminated else -1.0, terminated, truncated, info

    def compute_terminated(self, achieved_goal: Any, desired_goal: Any, info: Any = None) -> np.ndarray:
        """Whether the goals are reached: arrays (..., 3) of places, of which the radius of the present organ's wall, 1.2 mm
        within 1 %, is taken off. Returns bool (...)."""
        achieved, desired = places("achieved_goal", achieved_goal), places("desired_goal", desired_goal)
        self._check_begun()
        apart = np.linalg.norm(achieved - desired, axis=-1)
        return apart - self.task.organ[0].model.particle_radius <= self.task.tolerance

    def compute_truncated(self, achieved_goal: Any, desired_goal: Any, info: Any = None) -> np.ndarray:
        """False (...): what an episode has achieved does not cut it off."""
        places("desired_goal", desired_goal)
        return np.zeros(places("achieved_goal", achieved_goal).shape[:-1], bool)

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: Any = None) -> np.ndarray:
        """0 where compute_terminated(), otherwise -1: float (...)."""
        return np.where(self.compute_terminated(achieved_goal, desired_goal), 0.0, -1.0)


if REAL and "vibe/ReachGoal-v0" not in gymnasium.registry:
    gymnasium.register("vibe/ReachGoal-v0", entry_point="vibe.env:GoalEnvironment", max_episode_steps=Reach.steps_of_episode())
