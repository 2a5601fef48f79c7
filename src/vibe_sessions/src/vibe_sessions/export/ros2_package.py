"""vibe_msgs as a package of ROS 2, from the same definitions, with a rule for ros1_bridge."""

import argparse
import os
import re
import sys

import rospkg

from .definitions import ros2_text

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(vibe_msgs)

find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
find_package(builtin_interfaces REQUIRED)
find_package(geometry_msgs REQUIRED)
find_package(std_msgs REQUIRED)

file(GLOB INTERFACES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS msg/*.msg srv/*.srv)
rosidl_generate_interfaces(${PROJECT_NAME} ${INTERFACES} DEPENDENCIES builtin_interfaces geometry_msgs std_msgs)

ament_export_dependencies(rosidl_default_runtime)
install(FILES mapping_rules.yaml DESTINATION share/${PROJECT_NAME})
ament_package()
"""
RULES = "-\n  ros1_package_name: 'vibe_msgs'\n  ros2_package_name: 'vibe_msgs'\n"  # names of types and fields are the same
XML = (('format="2"', 'format="3"'), ("catkin", "ament_cmake"), ("message_generation", "rosidl_default_generators"),
       ("message_runtime", "rosidl_default_runtime"), ("  <depend>", "  <depend>builtin_interfaces</depend>\n  <depend>"),
       ("</package>", "  <member_of_group>rosidl_interface_packages</member_of_group>\n  <export>\n    <build_type>ament_cmake"
        "</build_type>\n    <ros1_bridge mapping_rules=\"mapping_rules.yaml\"/>\n  </export>\n</package>"))  # fmt: skip


def files_of(source):
    """Contents by path: the definitions, and what builds them."""
    files = {"CMakeLists.txt": CMAKE, "mapping_rules.yaml": RULES}
    for folder in ("msg", "srv"):
        for name in sorted(os.listdir(os.path.join(source, folder))):
            with open(os.path.join(source, folder, name), encoding="utf-8") as file:
                parts = re.split(r"^---\n", file.read(), flags=re.MULTILINE)
            files[folder + "/" + name] = "---\n".join(ros2_text("vibe_msgs/" + name.split(".")[0], part) for part in parts)
    with open(os.path.join(source, "package.xml"), encoding="utf-8") as file:
        files["package.xml"] = file.read()
    for old, new in XML:
        files["package.xml"] = files["package.xml"].replace(old, new, 1 if old == "  <depend>" else -1)
    return files


def main(words=None):
    made = argparse.ArgumentParser(prog="rosrun vibe_sessions ros2_messages", description=__doc__, allow_abbrev=False)
    made.add_argument("folder", metavar="DIR", help="a new folder: src/vibe_msgs of a workspace of ROS 2")
    folder = made.parse_args(words).folder
    try:
        files = files_of(rospkg.RosPack().get_path("vibe_msgs"))
        os.makedirs(folder)
        for path, text in files.items():
            os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
            with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
                file.write(text)
    except (OSError, rospkg.ResourceNotFound) as error:
        print("ros2_messages: cannot write the package to '{}' ({}); give a new folder, and source devel/setup.bash".format(
            folder, error), file=sys.stderr)  # fmt: skip
        return 2
    return 0
