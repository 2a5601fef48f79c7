"""Regressions as users write them: parsing and checking, with lines."""
import dataclasses
import math
import re

import yaml

from vibe_sessions.yaml_file import YamlFile, nearest

KEYS = ("scene", "script", "mesh", "seed", "duration", "expect")
LIMITS = ("value", "tolerance", "min", "max")


@dataclasses.dataclass
class Expectation:
    """A measure between two limits, all in SI."""

    name: str
    unit: str = ""  # as written
    value: float = None
    low: float = -math.inf
    high: float = math.inf
    tolerance: str = ""  # as written
    digest: str = None  # of the state, instead of the above
    place: tuple = None  # of the value in the text, for --update


@dataclasses.dataclass
class Regression:
    """What to run and what to expect."""

    file: str
    text: str
    scene: str = ""
    script: str = ""
    mesh: str = ""
    seed: int = None
    duration: float = 0.0
    expect: list = dataclasses.field(default_factory=list)


class _Reader(YamlFile):
    def __init__(self, file, known):
        """known: {measure: SI unit}"""
        super().__init__(file, "a regression")
        self.known = known

    def read(self):
        result, lists = Regression(self.file, self.text), None
        for key, key_node, node in self.items(self.root, "a regression"):
            if key in ("scene", "script", "mesh"):
                setattr(result, key, self.address(node, key))
            elif key == "seed":
                result.seed = self.seed(node)
            elif key == "duration":
                result.duration = self.quantity(node, key, "s")[0]
                if not result.duration > 0:
                    self.fail(node, "'duration' must be more than 0 s.")
            elif key == "expect":
                lists = node
            else:
                self.fail(key_node, f"unknown key '{key}'" + nearest(key, KEYS))
        for key, there in (("scene", result.scene), ("expect", lists)):
            if not there:
                self.fail(self.root, f"'{key}' is missing; add it.")
        result.expect = [self.expectation(*item) for item in self.items(lists, "'expect'")]
        if not result.expect:
            self.fail(lists, "'expect' is empty; name at least one measure.")
        return result

    def seed(self, node):
        if not re.fullmatch(r"\d{1,15}", self.scalar(node, "seed")):
            self.fail(node, f"the seed '{node.value}' is not a whole number from 0.")
        return int(node.value)

    def expectation(self, name, key, node):
        if name == "state_hash":
            return self.state_hash(node)
        if name not in self.known:
            self.fail(key, f"unknown measure '{name}'" + nearest(name, self.known))
        expected = Expectation(name)
        if isinstance(node, yaml.ScalarNode):
            return self.exact(expected, node)
        limits = dict((k, (n, v)) for k, n, v in self.items(node, f"'{name}'"))
        for word, (word_node, _) in limits.items():
            if word not in LIMITS:
                self.fail(word_node, f"unknown key '{word}' of '{name}'" + nearest(word, LIMITS))
        if "value" in limits:
            return self.around(expected, {k: v for k, (_, v) in limits.items()}, node)
        return self.between(expected, {k: v for k, (_, v) in limits.items()}, node)

    def state_hash(self, node):
        if not re.fullmatch(r"[0-9a-f]{16}", self.scalar(node, "state_hash")):
            self.fail(node, f"the state_hash '{node.value}' is not 16 hexadecimal digits in quotes.")
        return Expectation("state_hash", digest=node.value, place=(node.start_mark.index, node.end_mark.index))

    def exact(self, expected, node):
        """`bites: 3`"""
        if not re.fullmatch(r"-?\d+", node.value) or self.known[expected.name] != "1":
            self.quantity(node, expected.name, self.known[expected.name])
            self.fail(node, f"'{expected.name}' has no tolerance; write {{value: {node.value}, tolerance: 5 %}}.")
        expected.value = expected.low = expected.high = float(node.value)
        expected.place = (node.start_mark.index, node.end_mark.index)
        return expected

    def around(self, expected, limits, node):
        """{value: 1.2 N, tolerance: 5 %}"""
        unit = self.known[expected.name]
        if "tolerance" not in limits:
            self.fail(node, f"'{expected.name}' has no tolerance; add `tolerance: 5 %` or one in {unit}.")
        if "min" in limits or "max" in limits:
            self.fail(node, f"'{expected.name}' has both a value and limits; keep one of the two.")
        value, expected.unit = self.quantity(limits["value"], expected.name, unit)
        tolerance = self.tolerance(expected, limits["tolerance"], value, unit)
        expected.value, expected.low, expected.high = value, value - tolerance, value + tolerance
        expected.place = (limits["value"].start_mark.index, limits["value"].end_mark.index)
        expected.tolerance = limits["tolerance"].value
        return expected

    def tolerance(self, expected, node, value, unit):
        """In SI; in % it is relative to the value."""
        text = self.scalar(node, "tolerance")
        if not text.strip().endswith("%"):
            size = self.quantity(node, "tolerance", unit)[0]
        else:
            size = abs(value) * self.quantity(node, "tolerance", "1")[0]
            if value == 0:
                self.fail(node, f"{text} of 0 allows nothing for '{expected.name}'; write a tolerance in {unit}.")
        if size < 0:
            self.fail(node, f"the tolerance '{text}' is negative.")
        return size

    def between(self, expected, limits, node):
        """{min: 0.5 N, max: 2 N}"""
        if "min" not in limits and "max" not in limits:
            self.fail(node, f"'{expected.name}' has neither a value nor limits; write value and tolerance, or min, max.")
        if "tolerance" in limits:
            self.fail(node, f"'{expected.name}' has a tolerance but no value; limits need none.")
        for word in ("min", "max"):
            if word in limits:
                limit, expected.unit = self.quantity(limits[word], expected.name, self.known[expected.name])
                setattr(expected, "low" if word == "min" else "high", limit)
        if expected.low > expected.high:
            self.fail(node, f"'{expected.name}': min is above max; exchange them.")
        return expected


def read_regression(file, known):
    """Raises SessionError: one sentence with file and line."""
    return _Reader(file, known).read()
