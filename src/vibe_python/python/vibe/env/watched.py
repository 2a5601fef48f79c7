"""What wrappers do to an environment from which a set is recorded."""

import contextlib
import copy
import functools

import numpy as np

import vibe


class Watched:
    """An environment with its wrappers, for episode(): each of its calls has to reach the Environment within once and
    unchanged, and what that answers has to come back, because a set says how that Environment is made again."""

    def __init__(self, environment):
        self.unwrapped, self._levels = environment.unwrapped, [environment]
        while self._levels[-1] is not self.unwrapped:  # a wrapper of another kind than Gymnasium's is seen as one with those within
            self._levels.append(getattr(self._levels[-1], "env", self.unwrapped))

    def reset(self, seed):
        return self._call("reset", seed=seed)

    def step(self, action):
        return self._call("step", action)

    def _call(self, name, *given, **named):
        calls = [[] for _ in self._levels]
        with contextlib.ExitStack() as stack:
            for level, seen in zip(self._levels, calls):
                stack.enter_context(_noted(level, "reset", seen))
                stack.enter_context(_noted(level, "step", seen))
            found = getattr(self._levels[0], name)(*given, **named)
        for wrapper, outer, inner in zip(self._levels, calls, calls[1:]):
            changed = _changed(outer[0], inner)
            if changed:
                raise vibe.Error(f"The wrapper {type(wrapper).__name__} changes {changed}, and a set says how the Environment within it is made, "
                                 "not the wrapper; record without it, and change actions in the policy, the rest in training.")
        return *found[:-1], calls[-1][0][-1][-1]  # the info of the Environment, whose success counts


@contextlib.contextmanager
def _noted(environment, name, calls):
    """Meanwhile, (name, what was given, what was answered) of each call of a method, as it was before anybody changed it."""
    method, own = getattr(environment, name), {key: value for key, value in vars(environment).items() if key == name}

    @functools.wraps(method)  # checkers look at its signature
    def noted(*given, **named):
        before = copy.deepcopy((given, named))
        answer = method(*given, **named)
        calls.append((name, *before, (copy.deepcopy(answer[0]), *answer[1:])))
        return answer

    vars(environment)[name] = noted
    try:
        yield
    finally:
        del vars(environment)[name]
        vars(environment).update(own)


def _changed(outer, inner):
    """What differs between a call of a wrapper and those that it made of what is within, in words, or None."""
    if [call[0] for call in inner] != [outer[0]]:
        return "the number of steps"
    (name, given, named, answer), (_, given_within, named_within, answer_within) = outer, inner[0]
    if name == "reset" and _chosen(named) != _chosen(named_within):
        return "seed or options of reset()"
    if name == "step" and not _same_actions([*given, *named.values()], [*given_within, *named_within.values()]):
        return "actions"
    seen, within = answer[0], answer_within[0]
    if not (isinstance(seen, dict) and isinstance(within, dict) and set(seen) == set(within)) or not all(np.array_equal(seen[key], within[key]) for key in seen):
        return "observations"
    return "rewards or ends of episodes" if name == "step" and answer[1:3] != answer_within[1:3] else None


def _same_actions(one, other):
    return np.shape(one) == np.shape(other) and np.array_equal(np.clip(one, -1, 1), np.clip(other, -1, 1))  # as a set has them


def _chosen(named):
    return {key: value for key, value in named.items() if value is not None}
