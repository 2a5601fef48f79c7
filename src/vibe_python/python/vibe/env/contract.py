"""What every task keeps, whoever wrote it: the tests of the library ask it of all tasks, those of a task of your own of it.

    from vibe.env import contract

    assert contract.broken("my_tasks:Hover") == []
"""

import copy
import pickle
import warnings

import numpy as np

import vibe

from . import api
from .environment import Environment, VectorEnvironment
from .settings import whole

SETTINGS = {"particles": 300, "organs": [("sthenic", 1.0)]}  # the least that prepares fast


def broken(task, actions=8, **settings):
    """One sentence for each thing that a task does not keep; random actions, with SETTINGS but for those given."""
    whole("actions", actions, 1, 10**6)
    settings = {**SETTINGS, **settings}
    environment = Environment(task, **settings)
    try:
        found = _refusals(environment, "before reset()") + _kept(environment, actions, settings)
    except vibe.Error as error:
        return [str(error)]
    environment.close()
    found += _refusals(environment, "after close()") + _gymnasium(task, **settings)
    return [f"{environment.task.name or type(environment.task).__name__}: {sentence}" for sentence in dict.fromkeys(found)]


def _kept(environment, actions, settings):
    """What an environment that works does not keep."""
    episode, found = _episode(environment, 5, actions)
    if _differ(episode, _episode(environment, 5, actions)[0]):
        found.append("the same seed gives another episode")
    environment.task.organ[0].goals.clear()  # as in another process
    if _differ(episode, _beside_others(type(environment.task), 5, actions, **settings)):
        found.append("an episode beside others is another one than alone")
    return found + _again(environment, actions) + _end(environment)


def _actions(space, seed, count):
    random = np.random.default_rng([41, seed])
    return random.uniform(-1, 1, (count,) + space.shape).astype(np.float32)


def _episode(environment, seed, count):
    """(observation, reward) of an episode's beginning, and what is wrong with it."""
    seen, _ = environment.reset(seed=seed)
    rows, found = [(seen, 0.0)], _unlike(environment, seen)
    for action in _actions(environment.action_space, seed, count):
        seen, reward, terminated, truncated, info = environment.step(action)
        rows.append((seen, reward))
        found += _unlike(environment, seen)
        if not np.isfinite(reward):
            found.append(f"the reward is {reward}")
        if type(terminated) is not bool or type(truncated) is not bool or "is_success" not in info:
            found.append("step() does not say by True or False whether the episode is over and has succeeded")
        if terminated or truncated:
            break
    return rows, found


def _again(environment, count):
    """What a planner does: the future from a snapshot, again after others, and in copies."""
    def future(one):
        return [one.step(action)[:2] for action in _actions(one.action_space, 9, count)]

    environment.reset(seed=8)
    future(environment)
    if environment._ended:
        return []
    snapshot = environment.snapshot()
    first = future(environment)
    others = {"restored": environment, "copied": copy.deepcopy(environment)}
    try:
        others["pickled"] = pickle.loads(pickle.dumps(environment))
    except (pickle.PicklingError, AttributeError):  # a task that is defined within a function
        pass
    found = []
    for name, other in others.items():
        other.restore(snapshot)
        if _differ(first, future(other)):
            found.append(f"a {name} environment has another future")
    return found


def _unlike(environment, seen):
    """What an observation has that is not of its space, or no number."""
    space = environment.observation_space
    found = [f"the observation '{name}' is not of its space" for name, part in space.spaces.items()
             if name not in seen or seen[name].dtype != part.dtype or not part.contains(seen[name])]
    found += [f"the observation '{name}' is not in the space" for name in set(seen) - set(space.spaces)]
    return found + [f"the observation '{name}' is not finite" for name in seen if not np.isfinite(seen[name]).all()]


def _beside_others(task, seed, count, **settings):
    """The same as _episode(), in the second of three slots that two threads step."""
    together = VectorEnvironment(task, 3, threads=2, autoreset="same_step", **settings)
    seen, _ = together.reset(seed=seed - 1)
    rows = [({name: value[1] for name, value in seen.items()}, 0.0)]
    for steps in zip(*(_actions(together.single_action_space, seed + k, count) for k in (-1, 0, 1))):
        seen, reward, terminated, truncated, info = together.step(np.stack(steps))
        over = terminated[1] or truncated[1]
        rows.append((info["final_obs"][1] if over else {name: value[1] for name, value in seen.items()}, float(reward[1])))
        if over:
            break
    together.close()
    return rows


def _differ(one, other):
    return len(one) != len(other) or any(
        a[1] != b[1] or any(not np.array_equal(a[0][name], b[0][name]) for name in a[0]) for a, b in zip(one, other))


def _end(environment):
    """The last action of an episode ends it."""
    environment.reset(seed=6)
    task = environment.task
    task.taken[:] = task.length - 1
    *_, terminated, truncated, _ = environment.step(np.zeros(environment.action_space.shape, np.float32))
    return _refusals(environment, "after the end") if terminated or truncated else ["an episode does not end in time"]


def _refusals(environment, when):
    try:
        environment.step(np.zeros(environment.action_space.shape, np.float32))
    except vibe.Error:
        return []
    return [f"step() {when} is taken"]


def _gymnasium(task, **settings):
    """What the checker of Gymnasium finds, where the package is installed."""
    if not api.REAL:
        return []
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        try:
            check_env(Environment(task, **settings), skip_render_check=True)
        except (AssertionError, UserWarning) as error:
            return [f"the checker of Gymnasium says: {error}"]
    return []
