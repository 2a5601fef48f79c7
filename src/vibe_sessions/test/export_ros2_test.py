"""Messages of ROS 2: the bytes of each type, its definition, and the package of vibe_msgs."""

import io
import os
import random
import re
import struct
import unittest

import geometry_msgs.msg
import rospkg
import sensor_msgs.msg
import std_msgs.msg
import tf2_msgs.msg
import vibe_msgs.msg
import yaml
from random_messages import content, random_message

from vibe_sessions.export import ros2_package
from vibe_sessions.export.cdr import CODES, HEAD, Transcoder
from vibe_sessions.export.definitions import fields_of, ros2_definition, structure

PACKAGES = (vibe_msgs.msg, sensor_msgs.msg, geometry_msgs.msg, std_msgs.msg, tf2_msgs.msg)
TYPES = [kind for package in PACKAGES for kind in vars(package).values() if isinstance(kind, type)]
ROS2_NAME = re.compile("[a-z](_?[a-z0-9]+)*_?[a-z0-9]*$")


class Cdr:
    """Reads what is written: each value at a multiple of its size, from the end of the encapsulation on."""

    def __init__(self, data, types):
        self.data, self.at, self.types = data[len(HEAD) :], 0, types

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
        fields = [field for field in self.types[kind] if (kind, field.name) != ("std_msgs/Header", "seq")]
        if not self.types[kind]:
            self.number("B")
        return [self.array(field) if field.array else self.value(field.kind) for field in fields]

    def array(self, field):
        count = field.length()
        return [self.value(field.kind) for _ in range(self.number("I") if count is None else count)]


def raw(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class BytesTest(unittest.TestCase):
    def test_every_type_is_the_same_when_it_is_read_again(self):
        dice = random.Random(1)
        for kind in TYPES:
            transcoder = Transcoder(kind._type, kind._full_text)
            for _ in range(5):
                message = random_message(kind, dice)
                reader = Cdr(transcoder(raw(message)), structure(kind._type, kind._full_text))
                # by words: NaN is equal to itself, and -0.0 is not 0.0
                self.assertEqual(repr(reader.value(kind._type)), repr(content(message)), kind._type)
                self.assertEqual(reader.at, len(reader.data), kind._type)

    def test_bytes_that_do_not_fit_are_refused(self):
        dice = random.Random(2)
        for kind in (vibe_msgs.msg.SutureArray, vibe_msgs.msg.TissueTopology, sensor_msgs.msg.JointState):
            data, transcoder = raw(random_message(kind, dice)), Transcoder(kind._type, kind._full_text)
            for wrong in (data[:-1], data[: len(data) // 2], data + b"\0"):
                self.assertRaises(struct.error, transcoder, wrong)


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
        fields = {field.name: field.unit for field in fields_of("x/Y", "# Depth [m].\nfloat64 a\nfloat64 b\n# Of [1, 2].\nuint8 c\nuint8 d # [N]\n")}
        self.assertEqual(fields, {"a": "m", "b": "m", "c": "", "d": "N"})


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
                ours = [field.name for field in fields_of("vibe_msgs/X", file.read())]
            fields = fields_of("vibe_msgs/X", self.files[path])
            self.assertEqual([field.name for field in fields], ours, path)  # ros1_bridge maps equal names
            for field in fields:
                self.assertRegex(field.name, ROS2_NAME, path)
                self.assertNotIn(field.kind, ("time", "duration", "char", "vibe_msgs/Header"), path)

    def test_every_type_has_a_rule_and_is_built(self):
        rules = yaml.safe_load(self.files["mapping_rules.yaml"])
        named = ["{}/{}".format("srv" if "ros1_service_name" in rule else "msg", rule.get("ros1_message_name") or rule["ros1_service_name"])
                 for rule in rules]  # fmt: skip
        self.assertEqual(sorted(named), sorted(path[:-4] for path in self.definitions))
        for path in self.definitions:
            self.assertIn('"{}"'.format(path), self.files["CMakeLists.txt"])


if __name__ == "__main__":
    unittest.main()
