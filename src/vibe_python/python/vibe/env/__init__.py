"""Environments for learning, in the interface of Gymnasium (`pip install gymnasium`, or without it: the same classes).

    from vibe.env import Environment, VectorEnvironment

    environment = Environment("Reach")
    observation, info = environment.reset(seed=1)
    observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())

Observation, a dictionary of float32: joints (7,) [m], [rad]; tip (3,) [m] and direction (3,) of the view, in world;
wrench (6,) on the tool in its own axes [N], [N m]; goal (3,) in world and to_goal (3,) in the axes of the tip [m]; wall
(48, 3), places of the wall [m]; what the task adds; on request depth, label, normal and colour of a camera. Action: shares
from -1 to 1 of the joint speeds, and buttons. The tasks, each a class that says what is rewarded:
"""

from . import tasks as _tasks  # noqa: F401 - each of its classes adds itself to TASKS
from .environment import Environment, VectorEnvironment
from .episodes import TASKS, Task
from .expert import Expert
from .goals import GoalEnvironment
from .organs import BREATHING, HELD_OUT, TRAINING

globals().update(TASKS)
__all__ = ["BREATHING", "Environment", "Expert", "GoalEnvironment", "HELD_OUT", "TASKS", "TRAINING", "Task", "VectorEnvironment", *TASKS]
__doc__ = (__doc__ or "") + "".join(f"\n    {name:11}{task.summary()}" for name, task in TASKS.items()) + "\n"
