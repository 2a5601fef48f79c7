"""Definitions of messages as a bag has them: their fields with units, and the same in the spelling of ROS 2."""

import json
import re

LINE = re.compile(r"^\s*([A-Za-z][\w/]*)(\[\d*\])?\s+([A-Za-z]\w*)\s*(=\s*(.*?)\s*)?(#.*)?$")
STRING_CONSTANT = re.compile(r"^\s*(string)()\s+([A-Za-z]\w*)\s*(=\s*(.*))()$")  # a # belongs to its value
PRIMITIVES = {"bool", "byte", "char", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32",
              "float64", "string", "time", "duration"}  # fmt: skip
COUNTED = PRIMITIVES - {"float32", "float64"}  # have the unit behind them only, if any
SYMBOL = r"(?:[mu]?m|[nmu]?s|N|J|W|[mkh]?Pa|mmHg|Hz|rad|deg|k?g|px|mL|L|V|A|K|%)(?:\^-?\d)?"
UNIT = re.compile(r"\[((?:1/)?{0}(?:[ */]{0})*)\]".format(SYMBOL))  # and neither [k] of an array nor a number of literature
PAIRS = ({"m", "rad"}, {"N", "N m"}, {"m/s", "rad/s"}, {"N/m", "N m/rad"}, {"N s/m", "N m s/rad"})  # of joints that slide or turn
ROS2_TYPES = {"time": "builtin_interfaces/Time", "duration": "builtin_interfaces/Duration", "char": "uint8"}


def full_name(kind, package):
    if kind in PRIMITIVES or "/" in kind:
        return kind
    return "std_msgs/Header" if kind == "Header" else package + "/" + kind


def parts_of(datatype, definition):
    """Text by type, of the type itself and of all that it holds."""
    first, *others = re.split(r"^=+\s*\nMSG: *", definition, flags=re.MULTILINE)
    return {datatype: first, **{name.strip(): text for name, _, text in (other.partition("\n") for other in others)}}


def unit_in(words):
    """What a comment says in brackets; nothing where it names several units, of which a reader has to find the right one."""
    found = list(dict.fromkeys(UNIT.findall(words)))
    return " or ".join(found) if len(found) < 2 or set(found) in PAIRS else ""


def fields_of(datatype, text, arrays=False):
    """(type, unit) by name, without constants. The comment above fields, or behind one, tells the unit in brackets; that above
    counts for the numbers up to the next comment or constant. With `arrays` a type says whether it is one, as float64[3]."""
    fields, words, is_old = {}, "", True
    for line in text.splitlines():
        found = LINE.match(line)
        if found is None:
            words = line if is_old or not line.strip() else words + line
        elif found[4]:
            words = ""
        else:
            unit = unit_in(found[6] or "") or unit_in("" if found[1] in COUNTED else words)
            fields[found[3]] = full_name(found[1], datatype.split("/")[0]) + (found[2] or "" if arrays else ""), unit
        is_old = found is not None
    return fields


def ros2_name(name):
    """A name of a field: small letters, digits and single underscores."""
    apart = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    return re.sub("__+", "_", apart).strip("_")


def ros2_text(datatype, text):
    """The same definition, comments included, in the spelling of ROS 2; its header has no sequence number."""
    lines = []
    for line in text.splitlines():
        found = STRING_CONSTANT.match(line) or LINE.match(line)
        if found is None:
            lines.append(line)
        elif (datatype, found[3]) != ("std_msgs/Header", "seq"):
            kind = full_name(found[1], datatype.split("/")[0])
            name = found[3].upper() if found[4] else ros2_name(found[3])
            value = "=" + (json.dumps(found[5], ensure_ascii=False) if kind == "string" else found[5]) if found[4] else ""
            comment = "  " + found[6] if found[6] else ""
            lines.append("{}{} {}{}{}".format(ROS2_TYPES.get(kind, kind), found[2] or "", name, value, comment))
    return "\n".join(lines).strip("\n") + "\n"


def ros2_definition(datatype, definition):
    """With all that it holds, as `ros2msg` in a file."""
    parts = {name: ros2_text(name, text) for name, text in parts_of(datatype, definition).items()}
    for name in ("builtin_interfaces/Time", "builtin_interfaces/Duration"):
        if any(name in text for text in parts.values()):
            parts[name] = "int32 sec\nuint32 nanosec\n"
    return parts.pop(datatype) + "".join("{}\nMSG: {}\n{}".format("=" * 80, *part) for part in parts.items())
