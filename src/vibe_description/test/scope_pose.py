"""Where the links of the endoscope are, from its URDF alone: forward kinematics for tests and pictures."""

import xml.etree.ElementTree as ElementTree

import numpy


def numbers(element, name, default="0 0 0"):
    return numpy.array([float(word) for word in (element.get(name, default) if element is not None else default).split()])


def turned(axis, angle):
    """Rotation about an axis (Rodrigues)."""
    x, y, z = axis / numpy.linalg.norm(axis)
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def pose(place=(0, 0, 0), turn=None):
    result = numpy.eye(4)
    result[:3, 3] = place
    if turn is not None:
        result[:3, :3] = turn
    return result


def origin_of(element):
    """Pose of an <origin>: roll, pitch, yaw about fixed axes."""
    roll, pitch, yaw = numbers(element, "rpy")
    turn = turned(numpy.array([0, 0, 1]), yaw) @ turned(numpy.array([0, 1, 0]), pitch) @ turned(numpy.array([1, 0, 0]), roll)
    return pose(numbers(element, "xyz"), turn)


class Scope:
    def __init__(self, urdf):
        self.root = ElementTree.fromstring(urdf)
        self.joints = {joint.get("name"): joint for joint in self.root.findall("joint")}
        self.parent_joint = {joint.find("child").get("link"): joint for joint in self.joints.values()}

    def value(self, joint, inputs):
        """Its own position where it has one, as robot_state_publisher does, else that of the joint it mimics."""
        mimic = joint.find("mimic")
        if mimic is None or joint.get("name") in inputs:
            return inputs.get(joint.get("name"), 0.0)
        return float(mimic.get("multiplier")) * inputs.get(mimic.get("joint"), 0.0) + float(mimic.get("offset", 0))

    def pose_of(self, link, inputs):
        """Pose of a link in the root link [m], with joints by name; those not named are zero."""
        joint = self.parent_joint.get(link)
        if joint is None:
            return numpy.eye(4)
        moved = numpy.eye(4)
        if joint.get("type") == "prismatic":
            moved[:3, 3] = numbers(joint.find("axis"), "xyz") * self.value(joint, inputs)
        elif joint.get("type") == "revolute":
            moved[:3, :3] = turned(numbers(joint.find("axis"), "xyz"), self.value(joint, inputs))
        return self.pose_of(joint.find("parent").get("link"), inputs) @ origin_of(joint.find("origin")) @ moved

    def arm(self, way):
        """Joints of needle arm and needle, on the arm, where the needle has gone this way [m]: two circles meet."""
        place = lambda joint: numbers(self.joints[joint].find("origin"), "xyz")[[0, 2]]
        hinge, opened = place("needle_arm_hinge"), place("needle_driver")
        bars = place("needle_arm_pin_mount"), place("needle_hook_pin_mount")
        point = opened + way * numbers(self.joints["needle_driver"].find("axis"), "xyz")[[0, 2]]
        across = point - hinge
        lengths, distance = [numpy.linalg.norm(bar) for bar in bars], numpy.linalg.norm(across)
        along = (lengths[0] ** 2 - lengths[1] ** 2 + distance**2) / (2 * distance)
        ahead = across / distance
        pin = hinge + along * ahead + numpy.sqrt(lengths[0] ** 2 - along**2) * numpy.array([ahead[1], -ahead[0]])
        about_y = lambda a, b: numpy.arctan2(a[1] * b[0] - a[0] * b[1], a @ b)
        hook = about_y(bars[1], pin - point)
        return {"needle_driver": way, "needle_arm_hinge": about_y(bars[0], pin - hinge), "needle_hook_turn": hook,
                "needle_slide": way, "needle_turn": hook}  # fmt: skip

    def poses(self, inputs, tip):
        """Pose of every link where scope_tip has the pose `tip`."""
        to_tip = tip @ numpy.linalg.inv(self.pose_of("scope_tip", inputs))
        return {link.get("name"): to_tip @ self.pose_of(link.get("name"), inputs) for link in self.root.findall("link")}
