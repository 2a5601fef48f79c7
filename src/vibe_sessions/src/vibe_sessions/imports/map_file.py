"""The map of an import: which column moves which joint, in which unit. See docs/import.md."""
import dataclasses

import yaml

from vibe_sessions.regression_units import UnitError, unit_of
from vibe_sessions.yaml_file import YamlFile

JOINTS = {"insertion": "m", "rotation": "rad", "tip_up_down": "rad", "tip_left_right": "rad", "helix_advance": "m",
          "helix_rotation": "rad", "needle_driver": "m"}
BUTTONS = ("apc_pedal", "helix_grab", "needle", "t_tag", "cinch", "insufflate")
KEYS = ("scene", "time", "interpolation", "lead", "joints", "buttons")


@dataclasses.dataclass
class Source:
    """Where the values of a joint or button come from, and what they become."""

    column: str = ""  # "": always `offset`
    factor: float = 1.0  # of the unit, the scale and the sign
    offset: float = 0.0  # SI
    start: float = None  # SI, of the first value instead of the offset
    unit: str = ""  # as written


@dataclasses.dataclass
class Map:
    scene: str = "package://vibe_core/scenes/stomach.yaml"
    time: Source = dataclasses.field(default_factory=lambda: Source("time"))
    interpolation: str = "linear"
    lead: float = 0.0  # at least, before the motion [s]
    joints: dict = dataclasses.field(default_factory=dict)  # {name: Source}
    buttons: dict = dataclasses.field(default_factory=dict)  # {name: Source}; pressed while the value is above 0


class _Reader(YamlFile):
    def read(self):
        made = Map()
        for key, _, node in self.items(self.root, "a map", KEYS):
            if key == "scene":
                made.scene = self.address(node, key)
            elif key == "lead":
                made.lead = self.quantity(node, key, "s")[0]
            elif key == "interpolation":
                made.interpolation = self.one_of(node, key, ("linear", "hold"))
            elif key == "time":
                made.time = self.source(node, key, "s", ("from", "unit"))
            elif key == "joints":
                known = ("from", "unit", "sign", "scale", "offset", "start")
                made.joints = {name: self.source(inner, name, JOINTS[name], known) for name, _, inner in self.items(node, "'joints'", JOINTS)}
            else:
                made.buttons = {name: self.source(inner, name, "1", ("from", "above")) for name, _, inner in self.items(node, "'buttons'", BUTTONS)}
        if not any(source.column for source in made.joints.values()):
            self.fail(self.root, "no joint has a column; add `joints: {insertion: {from: COLUMN, unit: mm}}`.")
        if not 0 <= made.lead <= 600:
            self.fail(self.root, "'lead' must be from 0 to 600 s.")
        return made

    def one_of(self, node, what, words):
        if self.scalar(node, what) not in words:
            self.fail(node, f"the {what} '{node.value}' is neither {' nor '.join(words)}.")
        return node.value

    def source(self, node, name, unit, known):
        """`30 deg`, or {from: COLUMN, ...}."""
        if isinstance(node, yaml.ScalarNode):
            return Source(offset=self.quantity(node, name, unit)[0])
        given = {key: inner for key, _, inner in self.items(node, f"'{name}'", known)}
        if "from" not in given or not self.scalar(given["from"], "from"):
            self.fail(node, f"'{name}' lacks the key 'from', the name of a column; add it.")
        value = lambda key, of: self.quantity(given[key], key, of)[0] if key in given else None  # noqa: E731
        sign = -1 if "sign" in given and self.one_of(given["sign"], "sign", ("1", "-1")) == "-1" else 1
        scale = 1.0 if "scale" not in given else value("scale", "1")
        return Source(given["from"].value, sign * scale * self.unit(given.get("unit"), name, unit),
                      value("offset", unit) or -(value("above", "1") or 0.0), value("start", unit),
                      given["unit"].value if "unit" in given else "")

    def unit(self, node, name, unit):
        try:
            factor, dimension = unit_of(self.scalar(node, "unit")) if node is not None else (1.0, unit)
        except UnitError as error:
            self.fail(node, f"'{name}' {error}.")
        if dimension != unit:
            self.fail(node, f"'{node.value}' is no unit of '{name}', which is in {unit}.")
        return factor


def read_map(file):
    """Raises SessionError: one sentence with file and line."""
    return _Reader(file, "a map").read()
