"""Policies that show how the tasks are done, for demonstrations and as a reference."""

from __future__ import annotations

from typing import Any

import numpy as np

import vibe

from .settings import whole
from .tip import TIP_SPEED, tip_motion


class Expert:
    """Actions for an Environment, by the policy that its task has for itself: Task.expert(). Call reset() after every reset
    of the environment."""

    def __init__(self, environment: Any, seed: int = 1) -> None:
        environment = getattr(environment, "unwrapped", environment)
        task = getattr(environment, "task", None)
        if getattr(task, "count", None) != 1:
            raise vibe.Error(f"An expert acts in an Environment, and this is {vibe._shown(environment)}; give a single one.")
        whole("seed", seed, 0, 2**64 - 1)
        self._begun = False
        self._policy = task.expert(seed)
        if self._policy is None:
            raise vibe.Error(f"There is no expert for the task {task.name} with action={task.mode!r}.")
        self.environment, self._seed = environment, seed

    def __repr__(self):
        return f"Expert(seed={self._seed})"

    def reset(self) -> None:
        self._policy.reset(self.environment.task)
        self._begun = True

    def action(self, observation: dict[str, np.ndarray]) -> np.ndarray:
        if not self._begun:
            raise vibe.Error("The expert has not begun; call its reset() after that of the environment.")
        task = self.environment.task
        if not isinstance(observation, dict) or not {"tip", "achieved_goal"} & set(observation):
            raise vibe.Error(f"The observation is {vibe._shown(observation)}; give what reset() or step() of the environment gave.")
        if "tip" not in observation:  # of a GoalEnvironment
            observation = {name: value[0] for name, value in task.observe().items()}
        return self._policy.action(task, observation).astype(np.float32)


def _shares(task, speed):
    """Shares of the joint speeds that move the tip with a speed in its own axes [m/s]."""
    simulation = task.simulation[0]
    return tip_motion(simulation.jacobian, simulation.tip_pose, speed, task.speeds)


class Reaching:
    """The tip goes straight to the goal, and gives way to a force."""

    def reset(self, task):
        pass

    def action(self, task, observation):
        apart = observation["to_goal"].astype(float)
        force = observation["wrench"][:3].astype(float)
        speed = apart / max(np.linalg.norm(apart), 1e-9) * min(TIP_SPEED, 3 * np.linalg.norm(apart))
        if np.linalg.norm(force) > 3:
            speed = TIP_SPEED / 4 * force / np.linalg.norm(force)
        return np.clip(speed / TIP_SPEED, -1, 1) if task.mode == "tip" else _shares(task, speed)


class Inspecting:
    """The camera turns to where most is unseen for the least turning, keeps 6 cm from it, and gives way to a force. All
    numbers are design choices, found by trying."""

    apart = 0.06  # of the lens from what it looks at [m]
    cone = np.cos(0.8)  # half of what the camera sees about its axis
    sight = 0.1  # [m]
    decay = 0.03  # of the worth of what is farther than the camera sees [m]
    patience, rest = 1.5, 15.0  # after which a place is left, and looked for again [s]
    gentle = 1.0  # force that it gives way to [N]
    pressed, freeing = 1.0, 1.5  # after which it draws back, and for how long [s]

    def reset(self, task):
        self.target, self.until, self.touched, self.free = None, 0.0, 0.0, 0.0
        self.later = np.zeros(len(task.mask[0]))  # simulated time from which a particle is looked for

    def action(self, task, observation):
        simulation = task.simulation[0]
        now, force = simulation.time, observation["wrench"][:3].astype(float)
        if np.linalg.norm(force) <= self.gentle:
            self.touched = now
        if now > self.touched + self.pressed:
            self.touched, self.free = now + self.freeing, now + self.freeing
        if now < self.free:  # out, and straight
            return np.clip(np.array([-1, 0, *-simulation.joints[2:4]]), -1, 1)
        centre = simulation.positions
        if self.target is not None and now > self.until:
            self.later[np.linalg.norm(centre - centre[self.target], axis=1) < 0.02] = now + self.rest
        if self.target is None or task.mask[0][self.target] or now > self.until:
            self._choose(task, simulation, centre)
        return self._look_at(task, simulation, centre[self.target], force)

    def _choose(self, task, simulation, centre):
        """The unseen particle about which most is unseen, for the angle that the camera has to turn."""
        apart = centre - simulation.tip_pose[:3, 3]
        distance = np.linalg.norm(apart, axis=1)
        unseen = np.flatnonzero(~task.mask[0] & (self.later <= simulation.time))
        if len(unseen) == 0:
            unseen = np.flatnonzero(~task.mask[0])
        direction = (apart / distance[:, None])[unseen]
        worth = task.area[0][unseen] * np.exp(-np.maximum(distance[unseen] - self.sight, 0) / self.decay)
        gain = (direction @ direction.T > self.cone) @ worth
        turn = np.arccos(np.clip(direction @ simulation.tip_pose[:3, 0], -1, 1))
        self.target, self.until = unseen[np.argmax(gain / (0.5 + turn))], simulation.time + self.patience

    def _look_at(self, task, simulation, place, force):
        """Damped least squares of the two speeds of turning to the place, and of that along the view, or, where the wall
        presses, of those along its force."""
        to_tip = simulation.tip_pose[:3, :3].T
        apart = to_tip @ (place - simulation.tip_pose[:3, 3])
        distance = np.linalg.norm(apart)
        axis = np.cross([1, 0, 0], apart / distance)
        turn = axis / max(np.linalg.norm(axis), 1e-9) * min(2 * np.arccos(np.clip(apart[0] / distance, -1, 1)), 1.5)
        jacobian = simulation.jacobian * task.speeds
        turning, moving = (to_tip @ jacobian[3:])[1:], 10 * (to_tip @ jacobian[:3])
        if np.linalg.norm(force) > self.gentle:
            rows, speed = np.vstack([0.3 * turning, moving]), TIP_SPEED * force / np.linalg.norm(force)
            wanted = np.concatenate([0.3 * turn[1:], 10 * speed])
        else:
            rows = np.vstack([turning, moving[:1]])
            wanted = np.append(turn[1:], 10 * np.clip(2 * (distance - self.apart), -TIP_SPEED, TIP_SPEED))
        shares = rows.T @ np.linalg.solve(rows @ rows.T + 0.05**2 * np.eye(len(rows)), wanted)
        return shares / max(1.0, np.abs(shares).max())


class Pursuing:
    """The trainee of the library with the skill of an expert, which looks and pursues the goal of the task's protocol."""

    def __init__(self, seed):
        self.seed = seed

    def reset(self, task):
        along, around = task.place[0]
        text = "name: expert\nskill: {like: expert, look_time: 0 s}\n" + task.protocol.format(along=along, around=around)
        self.trainee = vibe.Trainee(task.organ[0].model, text, seed=self.seed)

    def action(self, task, observation):
        simulation = task.simulation[0]
        wanted = self.trainee.next(simulation)
        joints = np.array([wanted[name] for name in vibe.JOINTS])
        shares = (joints - simulation.joints) * task.rate / task.speeds
        buttons = [1.0 if wanted[name] else -1.0 for name in vibe.BUTTONS]
        return np.clip(np.concatenate([shares, buttons]), -1, 1)


class Retracting(Pursuing):
    """The trainee until the helix holds as well as it can; then the scope is drawn back until the force is in the middle of
    the band. The gain is a design choice."""

    gain = 0.01  # [m/s/N]

    def reset(self, task):
        super().reset(task)
        self.turned = False

    def action(self, task, observation):
        self.turned = self.turned or any(event.kind == "helix turned" for event in task.events[0])
        if not self.turned:
            return super().action(task, observation)
        pull = np.mean(task.band) - np.linalg.norm(observation["wrench"][:3])
        action = np.concatenate([np.zeros(len(vibe.JOINTS)), -np.ones(len(vibe.BUTTONS))])
        action[0] = np.clip(-self.gain * pull / task.speeds[0], -1, 1)
        action[len(vibe.JOINTS) + vibe.BUTTONS.index("helix_grab")] = 1
        return action


class Cinching:
    """T-tag; then the thread is drawn until its tension is what `wanted` says of a task [N], or as far as it goes."""

    patience = 20.0  # for the tension [s]

    def __init__(self, wanted):
        self.wanted = wanted

    def reset(self, task):
        self.tagged, self.drawn = False, False

    def action(self, task, observation):
        action = np.concatenate([np.zeros(len(vibe.JOINTS)), -np.ones(len(vibe.BUTTONS))])
        self.drawn = self.drawn or task.tensions()[0] >= self.wanted(task) or task.time[0] > self.patience
        if not self.drawn:
            action[len(vibe.JOINTS) + vibe.BUTTONS.index("cinch" if self.tagged else "t_tag")] = 1
        self.tagged = True
        return action
