"""Messages of ROS 2: the bytes of each type, its definition, and the package of vibe_msgs."""

import importlib.util
import io
import os
import random
import re
import struct
import unittest
import xml.etree.ElementTree

import geometry_msgs.msg
import rospkg
import sensor_msgs.msg
import std_msgs.msg
import tf2_msgs.msg
import vibe_msgs.msg
import yaml
from random_messages import content, random_message

from vibe_sessions.export import ros2_package
from vibe_sessions.export.cdr import HEAD, Encoder
from vibe_sessions.export.definitions import fields_of, parts_of, ros2_definition

PACKAGES = (vibe_msgs.msg, sensor_msgs.msg, geometry_msgs.msg, std_msgs.msg, tf2_msgs.msg)
TYPES = [kind for package in PACKAGES for kind in vars(package).values() if isinstance(kind, type)]
CODES = {"bool": "?", "byte": "b", "char": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i",
         "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d"}  # fmt: skip
ROS2_NAME = re.compile("[a-z](_?[a-z0-9]+)*_?[a-z0-9]*$")


class Cdr:
    """Reads what is written: each value at a multiple of its size, from the end of the encapsulation on."""

    def __init__(self, data, kind):
        self.data, self.at = data[len(HEAD) :], 0
        parts = parts_of(kind._type, kind._full_text)
        self.types = {name: re.findall(r"^ *([\w/]+?)(?:\[(\d*)(\]))? +(\w+) *(?:#.*)?$", text, re.MULTILINE) for name, text in parts.items()}

    def number(self, code):
        size = struct.calcsize("<" + code)
        self.at += -self.at % size + size
        return struct.unpack_from("<" + code, self.data, self.at - size)[0]

    def value(self, kind):
        if kind in CODES:
            return bool(self.number("B")) if kind == "bool" else self.number(CODES[kind])
        if kind in ("time", "duration"):
            return [self.number("i"), self.number("I")]
        if kind == "string":
            size = self.number("I")
            self.at += size
            assert self.data[self.at - 1] == 0
            return self.data[self.at - size : self.at - 1].decode()
        if "/" not in kind:
            kind = "std_msgs/Header" if kind == "Header" else next(name for name in self.types if name.endswith("/" + kind))
        if not self.types[kind]:
            self.number("B")
        return [self.array(base, count) if is_array else self.value(base) for base, count, is_array, name in self.types[kind]
                if (kind, name) != ("std_msgs/Header", "seq")]  # fmt: skip

    def array(self, base, count):
        return [self.value(base) for _ in range(int(count) if count else self.number("I"))]


class BytesTest(unittest.TestCase):
    def test_every_type_is_the_same_when_it_is_read_again(self):
        dice = random.Random(1)
        for kind in TYPES:
            encoder = Encoder(kind._type, kind._full_text)
            for _ in range(5):
                message, data = random_message(kind, dice), io.BytesIO()
                message.serialize(data)
                reader = Cdr(encoder.encode(data.getvalue()), kind)
                # by words: NaN is equal to itself, and -0.0 is not 0.0
                self.assertEqual(repr(reader.value(kind._type)), repr(content(message)), kind._type)
                self.assertEqual(reader.at, len(reader.data), kind._type)
                for cut in dice.sample(range(len(data.getvalue())), min(2, len(data.getvalue()))):
                    with self.assertRaises(struct.error, msg=kind._type):
                        encoder.encode(data.getvalue()[:cut])


class DefinitionTest(unittest.TestCase):
    def test_spelling(self):
        text = ros2_definition("a_msgs/B", "Header header\nchar K  # one\ntime someTime\nduration[] d\nC[2] c\nstring X=a # b\n"
                               "byte y=1\n====\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\n====\nMSG: a_msgs/C\nbool b\n")  # fmt: skip
        first = text.split("=====")[0].splitlines()
        self.assertEqual(first, ["std_msgs/Header header", "uint8 k  # one", "builtin_interfaces/Time some_time",
                                 "builtin_interfaces/Duration[] d", "a_msgs/C[2] c", 'string X="a # b"', "byte Y=1"])  # fmt: skip
        self.assertEqual(sorted(re.findall("^MSG: (.*)", text, re.MULTILINE)),
                         ["a_msgs/C", "builtin_interfaces/Duration", "builtin_interfaces/Time", "std_msgs/Header"])  # fmt: skip
        self.assertNotIn("seq", text)

    def test_units(self):
        fields = fields_of("x/Y", "# Depth [m].\nfloat64 a\nfloat64 b\n# Of [1, 2].\nuint8 c\nuint8 d # [N]\n")
        self.assertEqual({name: unit for name, (_, unit) in fields.items()}, {"a": "m", "b": "m", "c": "", "d": "N"})


@unittest.skipUnless(importlib.util.find_spec("rosidl_adapter"), "python3-rosidl is not installed")
class RosidlTest(unittest.TestCase):
    """What the parser of ROS 2 itself finds."""

    def assert_fields(self, found, text, what):
        kinds = {field.name: str(field.type) for field in found.fields}
        wanted = {name: kind for name, (kind, _) in fields_of(what, text, arrays=True).items()}
        self.assertEqual(list(kinds), list(wanted), what)
        for name, kind in wanted.items():
            self.assertEqual(kinds[name].rpartition("/")[2], kind.rpartition("/")[2], what)

    def test_schemas_of_every_type(self):
        from rosidl_adapter.parser import parse_message_string

        for kind in TYPES:
            for name, text in parts_of(kind._type, ros2_definition(kind._type, kind._full_text)).items():
                self.assert_fields(parse_message_string(*name.split("/"), text), text, name)

    def test_the_package(self):
        from rosidl_adapter.parser import parse_message_string, parse_service_string

        for path, text in ros2_package.files_of(rospkg.RosPack().get_path("vibe_msgs")).items():
            name = os.path.basename(path)[:-4]
            if path.startswith("msg/"):
                self.assert_fields(parse_message_string("vibe_msgs", name, text), text, "vibe_msgs/" + name)
            elif path.startswith("srv/"):
                found, halves = parse_service_string("vibe_msgs", name, text), ("\n" + text).split("\n---\n")
                self.assert_fields(found.request, halves[0], "vibe_msgs/" + name)
                self.assert_fields(found.response, halves[1], "vibe_msgs/" + name)


class PackageTest(unittest.TestCase):
    def setUp(self):
        self.source = rospkg.RosPack().get_path("vibe_msgs")
        self.files = ros2_package.files_of(self.source)
        self.definitions = [path for path in self.files if path.endswith((".msg", ".srv"))]

    def test_every_field_has_its_own_name_there(self):
        there = sorted(folder + "/" + name for folder in ("msg", "srv") for name in os.listdir(os.path.join(self.source, folder)))
        self.assertEqual(sorted(self.definitions), there)
        for path in self.definitions:
            with open(os.path.join(self.source, path), encoding="utf-8") as file:
                parts = file.read().split("\n---\n")
            for part, there in zip(parts, self.files[path].split("\n---\n")):
                fields = fields_of("vibe_msgs/X", there)
                self.assertEqual(list(fields), list(fields_of("vibe_msgs/X", part)), path)  # ros1_bridge maps equal names
                for name, (kind, _) in fields.items():
                    self.assertRegex(name, ROS2_NAME, path)
                    self.assertNotIn(kind, ("time", "duration", "char", "vibe_msgs/Header"), path)

    def test_what_builds_it(self):
        self.assertEqual(yaml.safe_load(self.files["mapping_rules.yaml"]), [{"ros1_package_name": "vibe_msgs", "ros2_package_name": "vibe_msgs"}])
        kinds = [kind for path in self.definitions for kind, _ in fields_of("vibe_msgs/X", self.files[path]).values()]
        package = xml.etree.ElementTree.fromstring(self.files["package.xml"])
        depends = [each.text for each in package if each.tag.endswith("depend")]
        for name in {kind.split("/")[0] for kind in kinds if "/" in kind} - {"vibe_msgs"}:
            self.assertIn(name, depends)
            self.assertIn("find_package({} REQUIRED)".format(name), self.files["CMakeLists.txt"])
        self.assertEqual(package.attrib["format"], "3")
        self.assertNotIn("catkin", self.files["package.xml"])


if __name__ == "__main__":
    unittest.main()
