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
    line: int = 0


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
        result = Map()
        for key, _, node in self.items(self.root, "a map", KEYS):
            if key == "scene":
                result.scene = self.address(node, key)
            elif key == "lead":
                result.lead = self.quantity(node, key, "s")[0]
            elif key == "time":
                result.time = self.source(node, key, "s", ("from", "unit"))
            elif key == "interpolation":
                result.interpolation = self.scalar(node, key)
                if result.interpolation not in ("linear", "hold"):
                    self.fail(node, f"the interpolation '{node.value}' is neither linear nor hold.")
            elif key == "joints":
                known = ("from", "unit", "sign", "scale", "offset", "start")
                result.joints = {name: self.source(inner, name, JOINTS[name], known)
                                 for name, _, inner in self.items(node, "'joints'", JOINTS)}
            else:
                result.buttons = {name: self.source(inner, name, "1", ("from", "above"))
                                  for name, _, inner in self.items(node, "'buttons'", BUTTONS)}
        if not any(source.column for source in result.joints.values()):
            self.fail(self.root, "no joint has a column; add `joints: {insertion: {from: COLUMN, unit: mm}}`.")
        if not 0 <= result.lead <= 600:
            self.fail(self.root, "'lead' must be from 0 to 600 s.")
        return result

    def source(self, node, name, unit, known):
        """`30 deg`, or {from: COLUMN, ...}."""
        made = Source(line=node.start_mark.line + 1)
        if isinstance(node, yaml.ScalarNode):
            made.offset = self.quantity(node, name, unit)[0]
            return made
        for key, _, inner in self.items(node, f"'{name}'", known):
            if key == "from":
                made.column = self.scalar(inner, key)
            elif key == "unit":
                made.unit, factor = inner.value, self.unit(inner, name, unit)
                made.factor *= factor
            elif key == "sign":
                if self.scalar(inner, key) not in ("1", "+1", "-1"):
                    self.fail(inner, f"the sign '{inner.value}' of '{name}' is neither 1 nor -1.")
                made.factor *= int(inner.value)
            elif key == "scale":
                made.factor *= self.quantity(inner, key, "1")[0]
            elif key == "above":
                made.offset = -self.quantity(inner, key, "1")[0]
            else:
                setattr(made, key, self.quantity(inner, key, unit)[0])
        if not made.column:
            self.fail(node, f"'{name}' lacks the key 'from', the name of a column; add it.")
        return made

    def unit(self, node, name, unit):
        try:
            factor, dimension = unit_of(self.scalar(node, "unit"))
        except UnitError as error:
            self.fail(node, f"'{name}' {error}.")
        if dimension != unit:
            self.fail(node, f"'{node.value}' is no unit of '{name}', which is in {unit}.")
        return factor


def read_map(file):
    """Raises SessionError: one sentence with file and line."""
    return _Reader(file, "a map").read()
