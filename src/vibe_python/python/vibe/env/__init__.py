"""Environments for learning, in the interface of Gymnasium (`pip install gymnasium`, or without it: the same classes).

    from vibe.env import Environment, VectorEnvironment

    environment = Environment("Reach")
    observation, info = environment.reset(seed=1)
    observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())

Tasks: Reach, Inspect, Mark, Bite, SutureSet. Observation, a dictionary of float32: joints (7,) [m], [rad]; tip (3,) [m]
and direction (3,) of the view, in world; wrench (6,) on the tool in its own axes [N], [N m]; goal (3,) in world and
to_goal (3,) in the axes of the tip [m]; wall (48, 3), places of the wall [m]; on request depth, label, normal and colour
of a camera. Action: shares from -1 to 1 of the joint speeds, and buttons. What is rewarded: the docstring of each task.
"""

from . import api
from .environment import Environment, VectorEnvironment
from .expert import Expert
from .organs import BREATHING, HELD_OUT, TRAINING
from .tasks import Bite, Inspect, Mark, Reach, SutureSet, TASKS

__all__ = ["BREATHING", "Bite", "Environment", "Expert", "HELD_OUT", "Inspect", "Mark", "Reach", "SutureSet", "TASKS", "TRAINING",
           "VectorEnvironment"]

if api.REAL:
    for _name in TASKS:
        _id = f"vibe/{_name}-v0"
        if _id not in api.gymnasium.registry:
            api.gymnasium.register(_id, entry_point="vibe.env:Environment", kwargs={"task": _name})
