"""vibe_msgs as a package of ROS 2, from the same definitions, with rules for ros1_bridge."""

import argparse
import os
import re
import sys

import rospkg

from .definitions import LINE, ros2_text

NAME = "vibe_msgs"
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name})

find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
{find}
rosidl_generate_interfaces(${{PROJECT_NAME}}
{files}
  DEPENDENCIES {dependencies})

ament_export_dependencies(rosidl_default_runtime)
install(FILES mapping_rules.yaml DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
PACKAGE = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>{version}</version>
  <description>Messages and services of ViBE, in ROS 2; made of those of ROS 1.</description>
  <maintainer email="maintainers@vibe-ros.example.org">ViBE maintainers</maintainer>
  <license>BSD-3-Clause</license>

  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
{depend}
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>

  <export>
    <build_type>ament_cmake</build_type>
    <ros1_bridge mapping_rules="mapping_rules.yaml"/>
  </export>
</package>
"""
RULE = """-
  ros1_package_name: '{name}'
  ros1_{kind}_name: '{type}'
  ros2_package_name: '{name}'
  ros2_{kind}_name: '{type}'
"""


def files_of(source):
    """Contents by path: the definitions, and what builds them."""
    files = {}
    for folder in ("msg", "srv"):
        for name in sorted(os.listdir(os.path.join(source, folder))):
            with open(os.path.join(source, folder, name), encoding="utf-8") as file:
                parts = re.split(r"^---\n", file.read(), flags=re.MULTILINE)
            kind = NAME + "/" + name.split(".")[0]
            files[folder + "/" + name] = "---\n".join(ros2_text(kind, part) for part in parts)
    with open(os.path.join(source, "package.xml"), encoding="utf-8") as file:
        version = re.search("<version>(.*)</version>", file.read())[1]
    dependencies = sorted(packages_in(files.values()) - {NAME})
    files["CMakeLists.txt"] = CMAKE.format(
        name=NAME, files="\n".join('  "{}"'.format(path) for path in sorted(files)), dependencies=" ".join(dependencies),
        find="".join("find_package({} REQUIRED)\n".format(each) for each in dependencies))  # fmt: skip
    files["package.xml"] = PACKAGE.format(
        name=NAME, version=version, depend="\n".join("  <depend>{}</depend>".format(each) for each in dependencies))  # fmt: skip
    files["mapping_rules.yaml"] = "".join(
        RULE.format(name=NAME, kind="service" if path.startswith("srv") else "message", type=path[4:-4])
        for path in sorted(files) if path.endswith((".msg", ".srv")))  # fmt: skip
    return files


def packages_in(texts):
    """Whose messages are in these definitions."""
    kinds = [found[1] for text in texts for found in map(LINE.match, text.splitlines()) if found]
    return {kind.split("/")[0] for kind in kinds if "/" in kind}


def main(words=None):
    made = argparse.ArgumentParser(prog="rosrun vibe_sessions ros2_messages", description=__doc__, allow_abbrev=False)
    made.add_argument("folder", metavar="DIR", help="a folder that is new: of the package, as src/vibe_msgs of a workspace of ROS 2")
    arguments = made.parse_args(words)
    try:
        source = rospkg.RosPack().get_path(NAME)
        os.makedirs(arguments.folder)
        for path, text in files_of(source).items():
            os.makedirs(os.path.dirname(os.path.join(arguments.folder, path)), exist_ok=True)
            with open(os.path.join(arguments.folder, path), "w", encoding="utf-8") as file:
                file.write(text)
    except (OSError, rospkg.ResourceNotFound) as error:
        print("ros2_messages: cannot write the package to '{}' ({}); give a new folder, and source devel/setup.bash".format(
            arguments.folder, error), file=sys.stderr)  # fmt: skip
        return 2
    print("{}: {} of {}".format(arguments.folder, NAME, source))
    return 0
