"""What ROS 2's own tools find in exports: rosidl parses the definitions, colcon builds them, Fast CDR reads and writes the bytes.
Called by scripts/test.d/ros2.sh with a folder, in which it makes a workspace.

Debian has the generators, but no package of interfaces besides. Those that vibe_msgs needs are made here of the definitions of
ROS 1, as an export writes them.
"""

import io
import json
import os
import random
import subprocess
import sys

import rospkg
from geometry_msgs.msg import Vector3, Vector3Stamped
from export_ros2_test import TYPES
from random_messages import content, random_message

from vibe_sessions.export import ros2_package
from vibe_sessions.export.cdr import HEAD, Encoder
from vibe_sessions.export.definitions import fields_of, parts_of, ros2_definition

PACKAGE = """<package format="3"><name>{name}</name><version>1.0.0</version><description>For a test.</description>
<maintainer email="nobody@example.org">nobody</maintainer><license>BSD-3-Clause</license>
<buildtool_depend>ament_cmake</buildtool_depend>{depends}<member_of_group>rosidl_interface_packages</member_of_group>
<export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject({name} {languages})\nfind_package(ament_cmake REQUIRED)\n{body}ament_package()\n"
INTERFACES = """find_package(rosidl_default_generators REQUIRED)
file(GLOB INTERFACES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} msg/*.msg)
rosidl_generate_interfaces(${PROJECT_NAME} ${INTERFACES}"""
GENERATORS = ("rosidl_cmake rosidl_adapter rosidl_generator_c rosidl_generator_cpp rosidl_typesupport_introspection_c "
              "rosidl_typesupport_introspection_cpp")  # fmt: skip
JUDGE = """add_executable(judge {source})
find_package(rosidl_typesupport_introspection_cpp REQUIRED)
target_link_libraries(judge rosidl_typesupport_introspection_cpp::rosidl_typesupport_introspection_cpp fastcdr dl)
install(TARGETS judge DESTINATION bin)
"""


def write(folder, files):
    for path, text in files.items():
        os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
        with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
            file.write(text)


def package(name, body, depends=(), languages="NONE"):
    tags = "".join("<depend>{}</depend>".format(each) for each in depends)
    return {name + "/package.xml": PACKAGE.format(name=name, depends=tags),
            name + "/CMakeLists.txt": CMAKE.format(name=name, languages=languages, body=body)}  # fmt: skip


def interfaces():
    """Files of the packages of all types but vibe_msgs, as they are in the schemas of an MCAP file."""
    texts = {}
    for kind in TYPES:
        texts.update(parts_of(kind._type, ros2_definition(kind._type, kind._full_text)))
    files = {}
    for name in sorted({kind.split("/")[0] for kind in texts} - {"vibe_msgs"}):
        own = {kind: text for kind, text in texts.items() if kind.startswith(name + "/")}
        fields = (kind for each in own.items() for kind, _ in fields_of(*each).values())
        depends = sorted({kind.split("/")[0] for kind in fields if "/" in kind} - {name})
        body = "".join("find_package({} REQUIRED)\n".format(each) for each in depends) + INTERFACES
        body += (" DEPENDENCIES " + " ".join(depends) if depends else "") + ")\n"
        files.update(package(name, body, ["rosidl_default_generators", *depends], "C CXX"))
        files.update({"{}/msg/{}.msg".format(*kind.split("/")): text for kind, text in own.items()})
    return files


def build(folder):
    """The workspace: vibe_msgs as rosrun vibe_sessions ros2_messages writes it, and what it needs."""
    source, judge = os.path.join(folder, "src"), os.path.join(os.path.dirname(os.path.abspath(__file__)), "ros2_judge.cpp")
    vibe_msgs = ros2_package.files_of(rospkg.RosPack().get_path("vibe_msgs"))
    write(source, {"vibe_msgs/" + path: text for path, text in vibe_msgs.items()})
    write(source, interfaces())
    write(source, package("rosidl_default_generators", "ament_export_dependencies({})\n".format(GENERATORS)))
    write(source, package("rosidl_default_runtime", ""))
    write(source, package("judge", JUDGE.format(source=judge), languages="CXX"))
    subprocess.run(["colcon", "build", "--merge-install", "--cmake-args", "-DBUILD_TESTING=OFF"], cwd=folder, check=True)
    return [path for path in vibe_msgs if path.endswith((".msg", ".srv"))]


def generated(folder, paths):
    """The interfaces that are installed are those that were written."""
    with open(os.path.join(folder, "install/share/ament_index/resource_index/rosidl_interfaces/vibe_msgs"), encoding="utf-8") as file:
        there = file.read().split()
    assert set(paths) <= set(there), set(paths) - set(there)
    print("vibe_msgs: {} messages and services".format(len(paths)))


def messages():
    dice = random.Random(4)
    for kind in TYPES:
        encoder = Encoder(kind._type, kind._full_text)
        for _ in range(5):
            message, data = random_message(kind, dice), io.BytesIO()
            message.serialize(data)
            yield kind._type, content(message), encoder.encode(data.getvalue()).hex()


def judged(folder, sent):
    """(bytes, content) of each (type, bytes)"""
    lines = "".join("{} {} {}\n".format(*kind.split("/"), data) for kind, data in sent)
    environment = {**os.environ, "LD_LIBRARY_PATH": os.path.join(folder, "install/lib")}
    ended = subprocess.run([os.path.join(folder, "install/bin/judge")], input=lines, env=environment, capture_output=True, encoding="utf-8")
    assert ended.returncode == 0, ended.stderr
    return [line.partition(" ")[::2] for line in ended.stdout.splitlines()]


def compare(folder):
    """Each message that an export writes is read with the content that it had, and written again to the same bytes."""
    sent = list(messages())
    said = judged(folder, [(kind, data) for kind, _, data in sent])
    assert len(said) == len(sent) == 5 * len(TYPES)
    for (kind, wanted, data), (bytes_there, found) in zip(sent, said):
        assert repr(json.loads(found)) == repr(wanted), "{}: {} became {}".format(kind, wanted, found)  # NaN and -0.0, too
        assert bytes_there == data, "{}: {} is {} there".format(kind, data, bytes_there)
    print("{} messages of {} types".format(len(sent), len(TYPES)))


def control(folder):
    """The bytes of ROS 1, without gaps, are another message there."""
    message, data = Vector3Stamped(vector=Vector3(1, 2, 3)), io.BytesIO()
    message.header.frame_id = "world"
    message.serialize(data)
    sent = [(HEAD + data.getvalue()[4:]).hex(), Encoder(message._type, message._full_text).encode(data.getvalue()).hex()]
    found = [json.loads(content)[1] for _, content in judged(folder, [(message._type, each + 8 * "00") for each in sent])]
    assert found[0] != [1, 2, 3] == found[1], found


if __name__ == "__main__":
    workspace = sys.argv[1]
    generated(workspace, build(workspace))
    compare(workspace)
    control(workspace)
