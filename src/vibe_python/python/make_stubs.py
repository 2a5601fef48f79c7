#!/usr/bin/env python3
"""Usage: make_stubs.py MODULE FILE
Writes vibe/_core.pyi from the signatures and docstrings of a module that is built; the build does it."""

import importlib.util
import inspect
import os
import re
import sys

HEAD = '''# Made by make_stubs.py of vibe_python from the module; do not edit.
from typing import Any, Optional
from numpy import ndarray
'''
TYPES = [
    (r"vibe\._core\.|_core\.|vibe\.", ""), (r"numpy\.ndarray\[[^\]]*\]|numpy\.ndarray", "ndarray"),
    (r"\bhandle\b", "Any"), (r"\bobject\b", "Any"), (r"List\[", "list["), (r"Dict\[", "dict["), (r"Tuple\[", "tuple["),
    (r"\bDict\b", "dict[str, Any]"),
]
PROPERTY = re.compile(r"(New array|View|Dictionary)")


def plain(text):
    for pattern, word in TYPES:
        text = re.sub(pattern, word, text)
    return text


def signature(function, name):
    """`(self, x: float) -> int`, from the first line of a docstring of pybind11."""
    line = (function.__doc__ or "").split("\n", 1)[0]
    if not line.startswith(name + "("):
        return "(*args: Any, **kwargs: Any) -> Any"
    found = plain(line[len(name):])
    found = re.sub(r"\*\*kwargs", "**kwargs: Any", found)
    return re.sub(r"\(self: \w+", "(self", found)


def property_type(value):
    documentation = value.__doc__ or ""
    line = (value.fget.__doc__ or "").split("\n", 1)[0]
    if PROPERTY.match(documentation):
        return "dict[str, tuple[float, float, float]]" if documentation.startswith("Dict") else "ndarray"
    found = re.search(r"-> (.*)$", line)
    return plain(found.group(1)) if found else "Any"


def body(documentation, indent):
    text = (documentation or "").strip()
    text = text.split("\n\n", 1)[1].strip() if re.match(r"\w+\(.*\) -> ", text) and "\n\n" in text else text
    if not text or re.match(r"\w+\(.*\) -> [^\n]*$", text):
        return [indent + "..."]
    return [indent + line if line else "" for line in ('"""' + text + '"""').split("\n")]


def is_shown(name, member):
    """What pybind11 makes of every class by itself is not."""
    own = name in ("__init__", "__enter__", "__exit__") and not (member.__doc__ or "").startswith("Initialize self")
    return callable(member) and (own or not name.startswith("_"))


def class_stub(cls):
    base = cls.__bases__[0]
    inherits = "" if base.__name__ == "pybind11_object" else f"({base.__name__})"
    lines = ["", "", f"class {cls.__name__}{inherits}:"] + body(cls.__doc__, "    ")
    for name, member in sorted(vars(cls).items()):
        if isinstance(member, property):
            lines += ["    @property", f"    def {name}(self) -> {property_type(member)}:"]
            lines += body(member.__doc__, "        ")
        elif is_shown(name, member):
            lines += [f"    def {name}{signature(member, name)}:"] + body(member.__doc__, "        ")
    return lines


def stubs(module):
    lines = HEAD.split("\n")
    for name, member in sorted(vars(module).items()):
        if name.startswith("_"):
            continue
        if isinstance(member, tuple):
            lines += [f"{name}: tuple[str, ...]"]
        elif inspect.isclass(member) and issubclass(member, Exception):
            lines += ["", "", f"class {name}(RuntimeError):"] + body(member.__doc__, "    ")
    classes = [member for member in vars(module).values() if inspect.isclass(member)]
    for member in sorted((c for c in classes if not issubclass(c, Exception)), key=lambda c: (len(c.__mro__), c.__name__)):
        lines += class_stub(member)
    for name, member in sorted(vars(module).items()):
        if not name.startswith("_") and not inspect.isclass(member) and callable(member):
            lines += ["", "", f"def {name}{signature(member, name)}:"] + body(member.__doc__, "    ")
    return "\n".join(lines) + "\n"


def main(module, file):
    spec = importlib.util.spec_from_file_location("vibe._core", module)  # without what vibe imports besides
    core = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(core)
    with open(file + ".part", "w", encoding="utf-8") as out:
        out.write(stubs(core))
    os.replace(file + ".part", file)


if __name__ == "__main__":
    main(*sys.argv[1:])
