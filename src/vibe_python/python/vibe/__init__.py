"""A simulator of endoscopic sleeve gastroplasty: a soft stomach under an endoscope with a suturing device.

    import vibe

    model = vibe.load()                                  # the default stomach, 3,618 particles
    simulation = vibe.Simulation(model)
    simulation.run(600, insertion=0.1, insufflate=True)  # ten seconds
    print(simulation.volume, simulation.tip_pose)        # [m^3], [m]

Units are SI, the frame is the world: x to the patient's front, y to the patient's left, z to the head. The same model
and the same inputs give the same bits. What is wrong raises vibe.Error: one sentence with the place and the remedy.

    load         a model from a scene file, with other values as keywords
    Simulation   a running simulation: step, run, follow, snapshot, restore; arrays, tool, contacts, threads, measures
    Trainee      pursues the goals of a protocol; Script: motions over time
    Anatomy      places of the wall by anatomical coordinates
    picture      what a simulation looks like, as an array; view: in a window
    vibe.env     environments for learning, in the interface of Gymnasium

docs/python.md of the repository is a tutorial.
"""

import importlib as _importlib
import json as _json
import os as _os
import sys as _sys


def _unloadable(error):
    """What a loader says, as a sentence with a remedy."""
    said, here = str(error), _os.path.dirname(__file__)
    if "already registered" in said:
        return f"Another copy of vibe is loaded in this process, beside that of {here}; import one of them."
    if "GLIBC" in said:
        return (f"The module vibe needs a newer library than the one that is found first ({said}); take its folder off LD_LIBRARY_PATH, or "
                "update it, such as by 'conda install libstdcxx-ng'.")
    if "No module named" in said and "_core" in said:
        return f"There is no module vibe._core for this Python, {_sys.version.split()[0]}, in {here}; install the wheel for it, or build it."
    return f"The module vibe cannot be loaded: {said}."


def _is_main_interpreter():
    """pybind11 waits for ever in another one."""
    for name in ("_interpreters", "_xxsubinterpreters"):  # the first from Python 3.13 on
        try:
            interpreters = _importlib.import_module(name)
        except ImportError:
            continue
        return interpreters.get_current() == interpreters.get_main()
    return True


if not _is_main_interpreter():
    raise ImportError("The module vibe works in the main interpreter of a process only; use threads or processes instead.")
try:
    from ._core import (
        BUTTONS,
        JOINTS,
        Anatomy,
        Error,
        Event,
        InputSource,
        Model,
        Script,
        Simulation,
        Snapshot,
        Trainee,
        build_model as _build_model,
        measure_units,
        observe_all,
        recognise_technique,
        step_all,
        wall_points,
    )
except ImportError as error:
    raise ImportError(_unloadable(error)) from None
import numpy as _numpy  # not before the interpreter is looked at

from ._pictures import picture, view

__version__ = "1.0.0"
__all__ = [
    "BUTTONS", "JOINTS", "Anatomy", "Error", "Event", "InputSource", "Model", "Script", "Simulation", "Snapshot",
    "Trainee", "load", "measure_units", "observe_all", "picture", "recognise_technique", "step_all", "view", "wall_points",
]

DEFAULT_SCENE = "package://vibe_core/scenes/stomach.yaml"


def _shown(value):
    """A value in the sentence of an error: as Python writes it, or its type where that is long."""
    text = ascii(value)
    return text if len(text) <= 60 and "<" not in text else type(value).__name__


def _array_of(value):
    """A value as an array; what makes none, as lists of unequal length, as an empty one of objects."""
    try:
        return _numpy.asarray(value)
    except (TypeError, ValueError, OverflowError):
        return _numpy.empty(0, object)


def _plain(value):
    """What json does not know: numbers and arrays of numpy, and paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "__fspath__"):
        return _os.fspath(value)
    raise Error(f"An override is a {type(value).__name__}; give numbers, texts, lists and dictionaries.")


def _without(value):
    """None as the word that takes a section away."""
    if isinstance(value, dict):
        return {name: _without(part) for name, part in value.items()}
    return "none" if value is None else value


def _overrides(sections):
    sections = _without(sections)
    try:
        return _json.dumps(sections, default=_plain, allow_nan=False) if sections else ""
    except ValueError:
        raise Error("An override holds a number that is not finite, or itself; give numbers in SI units.") from None
    except TypeError:
        raise Error("An override has a key that is not a text; give the names of keys.") from None


def _file(name, value):
    path = value if isinstance(value, str) else getattr(value, "__fspath__", lambda: None)()
    if not isinstance(path, str) or not path or "\0" in path:
        raise Error(f"'{name}' is {_shown(value)}; give the name of a file or package://PACKAGE/file.")
    return path


def load(scene=DEFAULT_SCENE, *, mesh=None, **sections):
    """The model of a scene file, with other values for some of its keys.

    scene     a file or package://PACKAGE/file (docs/scenes.md); default: the stomach of 3,618 particles
    mesh      a surface file (OBJ, STL, PLY, glTF) as the organ instead of the scene's; Model.mesh_report says what was
              guessed of it
    sections  keys of the scene by section, in SI units or with a unit:
              load(geometry={"particles": 1000}, gas={"regulated_pressure": "8 mmHg"}, seed=2); None takes a section away:
              load(gravity=None)

    Takes 0.2 to 1 s, tens of seconds for a mesh; Ctrl+C ends it. Raises Error for an unknown key or a value outside of its range;
    a UserWarning says what may not be meant, such as a gravity that does not act on the wall.
    """
    return _build_model(_file("scene", scene), _overrides(sections), "" if mesh is None else _file("mesh", mesh))
