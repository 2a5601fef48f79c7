"""YAML files as users write them: every fault is one sentence with file and line."""
import difflib
import os

import yaml

from vibe_sessions import regression_units as units
from vibe_sessions.headless import SessionError


def nearest(word, known):
    found = difflib.get_close_matches(word, known, n=1, cutoff=0.5)
    return f"; did you mean '{found[0]}'?" if found else "; known are " + ", ".join(sorted(known)[:8]) + "."


class YamlFile:
    """A file that is read key by key. `what`: "a regression", for what is none."""

    def __init__(self, file, what):
        self.file = file
        try:
            with open(file, encoding="utf-8") as stream:
                self.text = stream.read()
            self.root = yaml.compose(self.text, Loader=yaml.SafeLoader)
        except OSError as error:
            raise SessionError(f"{file}: cannot be read: {error.strerror}.") from None
        except RecursionError:
            raise SessionError(f"{file}: this is not {what}: its lists or maps are nested too deeply.") from None
        except yaml.reader.ReaderError as error:
            line = self.text.count("\n", 0, error.position) + 1
            raise SessionError(f"{file}:{line}: this is not YAML: {error.reason}.") from None
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            mark = getattr(error, "problem_mark", None)
            line = f":{mark.line + 1}" if mark else ""
            problem = getattr(error, "problem", "not UTF-8")
            raise SessionError(f"{file}{line}: this is not YAML: {problem}.") from None

    def fail(self, node, sentence):
        line = node.start_mark.line + 1 if node is not None else 1
        raise SessionError(f"{self.file}:{line}: {sentence}")

    def items(self, node, what, known=()):
        """(key, key node, value node) of a map, each key once, and one of those that are known if any are."""
        if not isinstance(node, yaml.MappingNode):
            self.fail(node, f"{what} must be a map of keys and values.")
        seen = set()
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                self.fail(key, "a key must be a word.")
            if key.value in seen:
                self.fail(key, f"'{key.value}' is there twice; remove one.")
            if known and key.value not in known:
                self.fail(key, f"unknown key '{key.value}' of {what}" + nearest(key.value, known))
            seen.add(key.value)
            yield key.value, key, value

    def scalar(self, node, what):
        if not isinstance(node, yaml.ScalarNode):
            self.fail(node, f"'{what}' must be a single value.")
        return node.value

    def quantity(self, node, what, unit):
        try:
            return units.parse(self.scalar(node, what), unit)
        except units.UnitError as error:
            self.fail(node, f"'{node.value}' of '{what}' {error}.")

    def address(self, node, what):
        """A path relative to this file, which must exist; package:// stays."""
        path = self.scalar(node, what)
        if path.startswith("package://"):
            return path
        path = os.path.join(os.path.dirname(os.path.abspath(self.file)), path)
        if not os.path.isfile(path):
            self.fail(node, f"there is no {what} '{node.value}'; paths are relative to this file.")
        return os.path.normpath(path)
