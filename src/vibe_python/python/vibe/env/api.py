"""Gymnasium's interface: the package if it is installed (`pip install gymnasium`, 1.0 or later), otherwise the few of
its classes that the environments here use, with the same names and meanings. `REAL` says which."""

import numpy as np

try:
    import gymnasium
    from gymnasium import Env, spaces
    from gymnasium.vector import VectorEnv

    try:
        from gymnasium.vector import AutoresetMode
    except ImportError:  # before 1.1
        AutoresetMode = None
    REAL = True
except ImportError:
    gymnasium = None
    AutoresetMode = None
    REAL = False

    class Env:
        """gymnasium.Env."""

        metadata = {"render_modes": []}
        render_mode = None
        spec = None
        np_random = None

        @property
        def unwrapped(self):
            return self

        def reset(self, *, seed=None, options=None):
            if seed is not None or self.np_random is None:
                self.np_random, self.np_random_seed = np.random.default_rng(seed), seed

        def close(self):
            pass

        def has_wrapper_attr(self, name):
            return hasattr(self, name)

        def get_wrapper_attr(self, name):
            return getattr(self, name)

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.close()

    class VectorEnv(Env):
        """gymnasium.vector.VectorEnv."""

        closed = False

        def close(self, **keywords):
            if not self.closed:
                self.close_extras(**keywords)
                self.closed = True

        def _add_info(self, infos, info, slot):
            for name, value in info.items():
                if isinstance(value, dict) and name != "final_obs":
                    infos[name] = self._add_info(infos.get(name, {}), value, slot)
                else:
                    kind = type(value) if isinstance(value, (bool, int, float, np.number)) else object
                    infos.setdefault(name, np.full(self.num_envs, None, object) if kind is object else np.zeros(self.num_envs, kind))
                    infos[name][slot] = value
                infos.setdefault(f"_{name}", np.zeros(self.num_envs, bool))[slot] = True
            return infos

    class _Space:
        def __init__(self, shape, dtype, seed=None):
            self.shape, self.dtype = shape, None if dtype is None else np.dtype(dtype)
            self.seed(seed)

        def seed(self, seed=None):
            self._random = np.random.default_rng(seed)
            return seed

    class _Box(_Space):
        """gymnasium.spaces.Box."""

        def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
            shape = np.shape(low) if shape is None else tuple(shape)
            self.low = np.broadcast_to(np.asarray(low, dtype), shape).copy()
            self.high = np.broadcast_to(np.asarray(high, dtype), shape).copy()
            super().__init__(shape, dtype, seed)

        def sample(self):
            low, high = np.maximum(self.low, -1e3), np.minimum(self.high, 1e3)
            if self.dtype.kind in "iu":
                return self._random.integers(self.low, self.high, endpoint=True).astype(self.dtype)
            return self._random.uniform(low, high).astype(self.dtype)

        def __eq__(self, other):
            return isinstance(other, _Box) and (self.shape, self.dtype) == (other.shape, other.dtype) and \
                np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high)

        def contains(self, x):
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

        __contains__ = contains

    class _Dict(_Space):
        """gymnasium.spaces.Dict."""

        def __init__(self, spaces, seed=None):
            self.spaces = dict(spaces)
            super().__init__(None, None, seed)

        def seed(self, seed=None):
            for k, space in enumerate(getattr(self, "spaces", {}).values()):
                space.seed(None if seed is None else seed + k)
            return seed

        def sample(self):
            return {name: space.sample() for name, space in self.spaces.items()}

        def contains(self, x):
            return set(x) == set(self.spaces) and all(self.spaces[name].contains(x[name]) for name in x)

        __contains__ = contains

        def __getitem__(self, name):
            return self.spaces[name]

        def __iter__(self):
            return iter(self.spaces)

        def __len__(self):
            return len(self.spaces)

        def __eq__(self, other):
            return isinstance(other, _Dict) and self.spaces == other.spaces

        def keys(self):
            return self.spaces.keys()

        def values(self):
            return self.spaces.values()

        def items(self):
            return self.spaces.items()

    class spaces:  # noqa: N801 - the name of the module that it stands for
        Box, Dict = _Box, _Dict


def batched(space, count):
    """The space of `count` of them side by side."""
    if REAL:
        from gymnasium.vector.utils import batch_space

        return batch_space(space, count)
    if isinstance(space, spaces.Dict):
        return spaces.Dict({name: batched(part, count) for name, part in space.spaces.items()})
    return spaces.Box(np.stack([space.low] * count), np.stack([space.high] * count), dtype=space.dtype)
