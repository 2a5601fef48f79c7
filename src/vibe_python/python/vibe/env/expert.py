"""Policies that show how the tasks are done, for demonstrations and as a reference."""

import numpy as np

import vibe

from .episodes import TIP_SPEED, tip_motion
from .tasks import Reach


class Expert:
    """Actions for an Environment. Reach: the tip goes straight to the goal, and backs off while the force is above 3 N.
    Mark, Bite, SutureSet: the trainee of the library with the skill of an expert, which looks and pursues the goal.
    Call reset() after every reset of the environment."""

    def __init__(self, environment, seed=1):
        self.environment, self.seed = environment, seed
        self.trainee = None

    def reset(self):
        task = self.environment.task
        if not hasattr(task, "protocol"):
            if not isinstance(task, Reach):
                raise vibe.Error(f"There is no expert for the task {task.name}.")
            return
        along, around = task.place[0]
        text = "name: expert\nskill: {like: expert, look_time: 0 s}\n" + task.protocol.format(along=along, around=around)
        self.trainee = vibe.Trainee(task.organ[0].model, text, seed=self.seed)

    def action(self, observation):
        task = self.environment.task
        return self._reach(task, observation) if self.trainee is None else self._trainee(task)

    def _reach(self, task, observation):
        simulation = task.simulation[0]
        apart = observation["to_goal"].astype(float)
        force = observation["wrench"][:3].astype(float)
        speed = apart / max(np.linalg.norm(apart), 1e-9) * min(TIP_SPEED, 3 * np.linalg.norm(apart))
        if np.linalg.norm(force) > 3:
            speed = TIP_SPEED / 4 * force / np.linalg.norm(force)
        if task.mode == "tip":
            return np.clip(speed / TIP_SPEED, -1, 1).astype(np.float32)
        shares = tip_motion(simulation.jacobian, simulation.tip_pose[:3, :3] @ speed, task.speeds)
        return shares.astype(np.float32)

    def _trainee(self, task):
        simulation = task.simulation[0]
        wanted = self.trainee.next(simulation)
        joints = np.array([wanted[name] for name in vibe.JOINTS])
        shares = (joints - simulation.joints) * task.rate / task.speeds
        buttons = [1.0 if wanted[name] else -1.0 for name in vibe.BUTTONS]
        return np.clip(np.concatenate([shares, buttons]), -1, 1).astype(np.float32)
