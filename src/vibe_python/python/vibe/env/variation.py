"""What reset() draws anew besides stomach, start and goal: values of the scene, and what happens to actions on their way."""

import copy

import numpy as np

import vibe

from .settings import is_number

OF_ACTIONS = ("action.delay", "action.noise")  # of actions [s]; standard deviation of the noise on their shares
MOST_OF_ACTIONS = 10.0  # of both: no action arrives in an episode of 10 s, none is heard in such noise
TAILS = 3.0  # standard deviations at which a normal distribution ends, so that its ends can be tried
#: keys of the scene for which environments have settings of their own
_SETTINGS = {"geometry.particles": "particles", "geometry.shape": "organs", "geometry.scale": "organs", "step_period": "step_period"}


class Variation:
    """Other values of a scene, of which some are drawn: `scene` are sections as vibe.load() takes them, `vary` is a
    dictionary from SECTION.KEY or one of OF_ACTIONS to a distribution in SI units, ('uniform', least, greatest), ('normal',
    mean, standard deviation) or ('choice', values). `moving` are the settings that make sections of the scene; `of_task` are
    sections that the task has, key by key, unless others are given. Raises vibe.Error for what is none of these."""

    def __init__(self, count, scene, vary, moving, of_task):
        if scene is not None and not isinstance(scene, dict):
            raise vibe.Error(f"'scene' is {vibe._shown(scene)}; give a dictionary of sections, such as {{'gas': {{'regulated_pressure': 900}}}}, "
                             "and scene files as 'organs'.")
        self.scene, self.vary = _merged(of_task, scene or {}), _distributions(vary)
        vibe._overrides(self.scene)  # refuses what no scene holds
        self.scene, self.vary = copy.deepcopy((self.scene, self.vary))  # what a caller does to his dictionaries later is no setting
        geometry = self.scene.get("geometry")
        for name in map(str, (*self.vary, *self.scene, *(f"geometry.{key}" for key in (geometry if isinstance(geometry, dict) else {})))):
            section = name.split(".")[0]
            if name in _SETTINGS or moving.get(section):
                raise vibe.Error(f"The environment has a setting of its own for '{name}'; use '{_SETTINGS.get(name, section)}'.")
            if name in self.vary and self.scene.get(section, {}) is None:
                raise vibe.Error(f"'vary' has '{name}', but 'scene' takes '{section}' away; leave one of the two out.")
        self.values = [{} for _ in range(count)]  # that were drawn
        self._sent = [[] for _ in range(count)]  # actions that have not arrived
        self._noise = [None] * count  # its generators

    def scenes(self):
        """Sections to try before any episode: with the ends of each distribution, its mean, all of its choices."""
        tried = [{name: value} for name, given in self.vary.items() if name not in OF_ACTIONS for value in _ends(given)]
        return [self._scene(values) for values in tried or [{}] * bool(self.scene)]

    def begin(self, slot, random, chosen):
        """Draws the values of an episode, but for those that are chosen. Returns the sections of its scene."""
        for name in chosen:
            if name not in self.vary:
                raise vibe.Error(f"'varied' of 'options' has {vibe._shown(name)}, which does not vary; give some of "
                                 f"{', '.join(self.vary) or 'nothing'}.")
            if name in OF_ACTIONS and not _is_of_actions(chosen[name]):
                raise vibe.Error(f"'{name}' of 'varied' is {vibe._shown(chosen[name])}; give a number from 0 to {MOST_OF_ACTIONS:g}.")
        drawn = {name: _drawn(given, random) for name, given in self.vary.items()}
        self.values[slot], self._sent[slot] = {**drawn, **chosen}, []
        self._noise[slot] = np.random.default_rng(random.integers(2**62)) if "action.noise" in self.vary else None
        return self._scene(self.values[slot])

    def arrived(self, actions, rate, shares):
        """What the joints get of actions (count, numbers), of which the first are shares of speeds: late, and with noise."""
        found = actions.copy()
        for slot, values in enumerate(self.values):
            late = round(values.get("action.delay", 0.0) * rate)
            self._sent[slot] = (self._sent[slot] + [actions[slot].copy()])[-1 - late:]
            found[slot] = self._sent[slot][0] if len(self._sent[slot]) > late else 0
            if values.get("action.noise"):
                found[slot, :shares] += values["action.noise"] * self._noise[slot].standard_normal(shares)
        return np.clip(found, -1, 1)

    def _scene(self, values):
        found = copy.deepcopy(self.scene)
        for name, value in values.items():
            if name not in OF_ACTIONS:
                *sections, key = name.split(".")
                place = found
                for section in sections:
                    place = place.setdefault(section, {})
                place[key] = value
        return found


def _merged(sections, others):
    """Sections with the keys of others, which count where both have one."""
    found = dict(sections)
    for name, value in others.items():
        found[name] = _merged(found[name], value) if isinstance(found.get(name), dict) and isinstance(value, dict) else value
    return found


def _is_of_actions(value):
    return is_number(value) and 0 <= value <= MOST_OF_ACTIONS


def _distributions(vary):
    if vary is None:
        return {}
    if not isinstance(vary, dict) or not all(isinstance(name, str) and "." in name for name in vary):
        raise vibe.Error(f"'vary' is {vibe._shown(vary)}; give a dictionary from SECTION.KEY to a distribution, such as "
                         "{'tissue.young_modulus': ('uniform', 8e4, 1.4e5)}.")
    for name, given in vary.items():
        if name.startswith("action.") and name not in OF_ACTIONS:
            raise vibe.Error(f"'vary' has {vibe._shown(name)}; of actions it may have {', '.join(OF_ACTIONS)}.")
        kind, of = (given[0], list(given[1:])) if isinstance(given, (list, tuple)) and given else (None, [])
        if kind == "choice" and len(of) == 1 and isinstance(of[0], (list, tuple)) and len(of[0]) > 0 and name not in OF_ACTIONS:
            continue
        if kind not in ("uniform", "normal") or len(of) != 2 or not all(map(is_number, of)) or of[1] < (of[0] if kind == "uniform" else 0):
            raise vibe.Error(f"'{name}' of 'vary' is {vibe._shown(given)}; give ('uniform', least, greatest), ('normal', mean, standard "
                             "deviation) or ('choice', [values]).")
        if name in OF_ACTIONS and not (kind == "uniform" and all(map(_is_of_actions, of))):
            raise vibe.Error(f"'{name}' of 'vary' is {vibe._shown(given)}; give ('uniform', least, greatest) of numbers from 0 to "
                             f"{MOST_OF_ACTIONS:g}.")
    return {name: tuple(given) for name, given in vary.items()}


def _ends(given):
    """What a distribution gives at most and at least; all of its choices."""
    kind, *of = given
    return of[0] if kind == "choice" else of if kind == "uniform" else [of[0] - TAILS * of[1], of[0] + TAILS * of[1]]


def _drawn(given, random):
    kind, *of = given
    if kind == "choice":
        return of[0][random.integers(len(of[0]))]
    return float(random.uniform(*of) if kind == "uniform" else of[0] + of[1] * np.clip(random.standard_normal(), -TAILS, TAILS))
