"""What may be given to environments: each value is checked, and what cannot be taken is refused in one sentence."""

import inspect
from typing import Any, Optional, Sequence, Tuple, TypedDict, Union

import numpy as np

import vibe

from . import organs as _organs

#: greatest numbers of observations, far beyond what occurs: [m], [rad]; [N], [N m]; of depths [m]
FAR, STRONG, DEEP = 100.0, 1000.0, 10.0
#: pictures that an observation may hold: channels, type, least and greatest value
PICTURES = {"depth": ((), np.float32, 0, DEEP), "label": ((), np.uint8, 0, 7), "normal": ((3,), np.float32, -1, 1),
            "colour": ((3,), np.uint8, 0, 255)}


class Settings(TypedDict, total=False):
    """The keywords of every environment and their types; Environment says what they mean. A task may have further ones."""

    particles: int
    organs: Sequence[Union[str, Tuple[str, float]]]
    action: str
    camera: Optional[Tuple[int, int, float]]
    pictures: Optional[Sequence[str]]
    tool: bool
    breathing: Optional[str]
    motion: Optional[str]
    step_period: Optional[float]
    max_episode_steps: Optional[int]
    scene: Optional[dict[str, Any]]
    vary: Optional[dict[str, Sequence[Any]]]
    tolerance: Optional[float]
    along: Optional[Tuple[float, float]]
    around: Optional[Tuple[float, float]]


def named(constructor, of):
    """A constructor of an environment, whose signature shows the keywords of Settings with the defaults of the constructor `of`."""
    own, known = inspect.signature(constructor), inspect.signature(of).parameters
    keywords = [known[name].replace(annotation=kind) for name, kind in Settings.__annotations__.items()]
    *others, further = own.parameters.values()
    constructor.__signature__ = own.replace(parameters=[*others, *keywords, further.replace(annotation=Any)])
    return constructor


def whole(name, value, least, most):
    """A whole number within a range, or vibe.Error."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise vibe.Error(f"'{name}' is {vibe._shown(value)}; give a whole number from {least} to {most}.")
    return int(value)


def numbers(action, shape):
    """An action of this shape as a new array of float from -1 to 1, or vibe.Error."""
    given = vibe._array_of(action)
    if given.dtype.kind not in "biuf":
        raise vibe.Error(f"The action is {vibe._shown(action)}; give an array of numbers from -1 to 1.")
    if given.shape != shape:
        raise vibe.Error(f"The action has the shape {given.shape}; give one of the shape {shape}.")
    if not np.isfinite(given).all():
        raise vibe.Error("The action holds a value that is not finite; give numbers from -1 to 1.")
    return np.minimum(np.maximum(given.astype(float), -1), 1)


def places(name, value):
    """Places (..., 3) as an array of float, or vibe.Error."""
    found = vibe._array_of(value)
    if found.dtype.kind not in "iuf" or found.shape[-1:] != (3,) or not np.isfinite(found).all():
        raise vibe.Error(f"'{name}' is {vibe._shown(value)}; give places (..., 3), finite numbers [m].")
    return found.astype(float)


def is_number(value):
    """Whether it is one that a float holds; True and False are none."""
    try:
        return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool) and bool(np.isfinite(float(value)))
    except OverflowError:
        return False


def organs_of(organs):
    """Pairs (shape, scale) and scene files as a tuple."""
    pairs = tuple(organs) if isinstance(organs, (list, tuple)) else ()
    if not pairs:
        raise vibe.Error("'organs' is empty or no list; give pairs (shape, scale), such as vibe.env.TRAINING, or scene files.")
    for pair in pairs:
        if isinstance(pair, str) and pair:
            continue
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or pair[0] not in _organs.SHAPES or not is_number(pair[1]):
            raise vibe.Error(f"'organs' holds {vibe._shown(pair)}; give pairs of a shape ({', '.join(_organs.SHAPES)}) and a scale, "
                             "or scene files.")
    return tuple(pair if isinstance(pair, str) else tuple(pair) for pair in pairs)


def camera_of(camera):
    if camera is None:
        return None
    if not isinstance(camera, (list, tuple)) or len(camera) != 3 or not is_number(camera[2]) or not 0.01 < camera[2] < 3.1:
        raise vibe.Error(f"'camera' is {vibe._shown(camera)}; give (width, height, field of view from 0.01 to 3.1 rad), or None.")
    return whole("camera[0]", camera[0], 1, 4096), whole("camera[1]", camera[1], 1, 4096), float(camera[2])


def pictures_of(pictures, tool, camera):
    """Which pictures the camera gives, as a tuple of names."""
    if not isinstance(tool, (bool, np.bool_)) or tool and camera is None:
        raise vibe.Error(f"'tool' is {vibe._shown(tool)}; give True or False, and with True a camera=(width, height, field of view).")
    if pictures is None:
        return ("depth", "label")
    if camera is None:
        raise vibe.Error("'pictures' is given without a camera; add camera=(width, height, field of view).")
    names = tuple(pictures) if isinstance(pictures, (list, tuple)) else ()
    if not names or not all(isinstance(name, str) and name in PICTURES for name in names) or len(set(names)) < len(names):
        raise vibe.Error(f"'pictures' is {vibe._shown(pictures)}; give a list of some of {', '.join(PICTURES)}, each once.")
    return names


def range_of(name, pair, least, most):
    if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not all(map(is_number, pair)) or not least <= pair[0] <= pair[1] <= most:
        raise vibe.Error(f"'{name}' is {vibe._shown(pair)}; give (least, greatest), from {least:.4g} to {most:.4g}.")
    return tuple(pair)


#: what reset(options=...) may choose instead of drawing it
CHOICES = {"organ": "a pair (shape, scale), or a scene file", "varied": "a dictionary of values of what 'vary' names", "start": f"a whole number below {_organs.STARTS}", "goal": "(share of the axis from 0 to 1, angle around it [rad])",
           "phase": f"a whole number below {_organs.PHASES}, of a stomach that breathes or moves"}


def chosen(options, further=()):
    """What of the next episode is not drawn: options of reset() without those that `further` names; or vibe.Error."""
    if options is None:
        return {}
    if not isinstance(options, dict):
        raise vibe.Error(f"'options' is {vibe._shown(options)}; give a dictionary, or None.")
    wrong = [name for name in options if name not in CHOICES and name not in further]
    if wrong:
        raise vibe.Error(f"'options' has no {vibe._shown(wrong[0])}; it may choose {', '.join([*CHOICES, *further])}.")
    found = {name: value for name, value in options.items() if name in CHOICES}
    if "organ" in found:
        found["organ"], = organs_of([found["organ"]])
    for name, count in (("start", _organs.STARTS), ("phase", _organs.PHASES)):
        if name in found:
            whole(name, found[name], 0, count - 1)
    if not isinstance(found.get("varied", {}), dict):
        raise vibe.Error(f"'varied' is {vibe._shown(found['varied'])}; give a dictionary of values of what 'vary' names.")
    goal = found.get("goal", (0, 0))
    if not isinstance(goal, (list, tuple)) or len(goal) != 2 or not all(map(is_number, goal)) or not 0 <= goal[0] <= 1:
        raise vibe.Error(f"'goal' is {vibe._shown(goal)}; give (share of the axis from 0 to 1, angle around it [rad]).")
    return found
