#!/usr/bin/python3
"""Writes the URDF of the endoscope with its suturing device to standard output.

The URDF is plain XML that any tool reads; this program keeps its many repeated parts (shaft, eight segments) and the
numbers behind them in one place. What is drawn are the meshes of make_scope_meshes.py.
Usage: make_scope_urdf.py > ../urdf/scope.urdf
"""
import argparse
import math
import sys
from xml.sax.saxutils import quoteattr

# --- geometry [m]. Sources: [S] SAGES Manual of Flexible Endoscopy (OverStitch 15.8 mm closed, 23.3 mm open, 18.4 mm
# beyond the endoscope), [O] Olympus GIF-2T160 (double-channel gastroscope, 12.6 mm); [D] design choice.
SCOPE_RADIUS = 0.0063  # [O]
SHAFT_LENGTH = 0.350   # [D] longer than the insertion range, so that its end never leaves the oesophagus
BEND_LENGTH = 0.088    # [D] with the rigid tip about the 10 cm that gastroscopes bend; radius 31 mm at 164 deg
SEGMENTS = 8           # [D] the tip is within 1.1 % of the true arc's chord at 164 deg
TIP_LENGTH = 0.016     # [D] rigid end of the endoscope that carries the cap
CAP_RADIUS = 0.0079    # [S]
CAP_LENGTH = 0.012     # [D]
ARM_REACH = 0.0184     # [S] of the needle arm's bracket beyond the endoscope
HELIX_TURNS = 3         # within the 2 to 4 that are used
HELIX_PITCH = 0.0018    # [D]
HELIX_RADIUS = 0.0010   # [D] of the wire's middle; passes through a channel of 2.8 mm
HELIX_WIRE = 0.00025    # [D] radius of the wire
HELIX_STEM = 0.028      # [D] still in the channel when the helix is out
NEEDLE_OPEN = (0.0148, -0.0025, 0.0134)  # [D] the needle's point in scope_tip, within 23.3 mm of the whole device [S]

# What is only drawn: the needle arm as two bars with two pins that turn, so that the needle's point stays on its path;
# the needle, which leaves the arm; the argon probe. In scope_tip; all [D].
HINGE = (0.0014, -0.00445, 0.0053)  # of the arm
ARM_LENGTH = 0.0108                 # from the hinge to the pin of the hook
HOOK_LENGTH = 0.0054                # from that pin to the needle's point
ARM_RADIUS, HOOK_RADIUS = 0.00055, 0.0005  # of their collision shapes, round bars about the meshes
HOOK_BEND = (0.0031, 0.0, 0.0004)   # where these shapes of the hook meet, in its frame
NEEDLE_IN_EXCHANGE = (0.0012, 0.4189)  # how deep, and how far turned to lie along the bore [rad]
NEEDLE_GONE = 0.018                 # as deep: within the rigid end of the endoscope
PROBE_IN, PROBE_REACH = -0.005, 0.015  # of its end before the face; beyond, the rear end of the drawn piece would show

SHAFT_PIECES = 6       # [D] of the part of the shaft that enters the lumen and bends there: 2 % more than that part
SHAFT_PIECE = 0.034    # [D]
SEGMENT_LENGTH = BEND_LENGTH / SEGMENTS
STRAIGHT_LENGTH = BEND_LENGTH - SEGMENT_LENGTH / 2 + TIP_LENGTH  # from the first bending joint to the tip

# --- densities [kg/m^3], design choices: steel coil, fibres and polymer together; steel
SCOPE_DENSITY = 1500.0
STEEL = 7800.0
CARRIER_RADIUS = 0.002  # [m] of the solid sphere that stands for a part without a body of its own

DEGREE = math.pi / 180

# --- the inputs: axis, lower, upper, velocity, effort, why
INPUTS = {
    "insertion": ("prismatic", "1 0 0", 0.0, 0.30, 0.15, 43.0,
                  "range: gastro-oesophageal junction to beyond the pylorus of a straightened stomach (design choice); "
                  "velocity: a brisk hand (design choice); effort: 4.4 kg push, Appleyard 2000"),
    "rotation": ("revolute", "1 0 0", -math.pi, math.pi, math.pi, 1.0,
                 "range: half a turn each way, as far as a wrist and the light guide allow (design choice); "
                 "velocity: half a turn per second (design choice); effort: 1.0 N m, Appleyard 2000"),
    "tip_up_down": ("revolute", "0 -1 0", -90 * DEGREE, 164 * DEGREE, math.pi, 1.0,
                    "total bend of the section, up positive; up 164 deg measured on GIF-HQ190 (ASMBS 2024) although 210 "
                    "are specified, down 90 deg as specified; velocity: half a turn per second (design choice)"),
    "tip_left_right": ("revolute", "0 0 1", -100 * DEGREE, 100 * DEGREE, math.pi, 1.0,
                       "total bend of the section, left positive; 100 deg each way as specified; velocity as up/down"),
    "helix_advance": ("prismatic", "1 0 0", 0.0, 0.030, 0.10, 8.0,
                      "range: the working distance of the camera (design choice); velocity: a quick push (design choice); "
                      "effort: largest instrument force, Trejos 2011"),
    "helix_rotation": ("revolute", "1 0 0", -16 * math.pi, 16 * math.pi, 8 * math.pi, 0.05,
                       "range: 8 turns each way, twice the 2 to 4 turns that reach the muscle; velocity: 4 turns per second "
                       "between two fingers (design choice)"),
    "needle_driver": ("prismatic", "-0.6 0 -0.8", 0.0, 0.018, 0.10, 8.0,
                      "chord of the curved needle's path, 0 with the arm open, upper end with the needle in the anchor "
                      "exchange (design choice); velocity: closed in 0.2 s (design choice)"),
}

NEEDLE_PATH = (-0.6, 0.0, -0.8)  # axis of needle_driver
NEEDLE_WAY = INPUTS["needle_driver"][3]


def arm_pin(way):
    """(x, z) of the pin between arm and hook when the needle has gone this way: two circles meet there."""
    point = [NEEDLE_OPEN[k] + way * NEEDLE_PATH[k] for k in (0, 2)]
    x, z = point[0] - HINGE[0], point[1] - HINGE[2]
    distance = math.hypot(x, z)
    along = (ARM_LENGTH ** 2 + distance ** 2 - HOOK_LENGTH ** 2) / (2 * distance)
    beside = math.sqrt(ARM_LENGTH ** 2 - along ** 2)
    return HINGE[0] + (along * x + beside * z) / distance, HINGE[2] + (along * z - beside * x) / distance


def turn_between(a, b):
    """From a to b about +y, which turns z towards x [rad]."""
    return math.atan2(a[1] * b[0] - a[0] * b[1], a[0] * b[0] + a[1] * b[1])


PIN_OPEN, PIN_CLOSED = arm_pin(0.0), arm_pin(NEEDLE_WAY)
ARM_TURN = turn_between(*((x - HINGE[0], z - HINGE[2]) for x, z in (PIN_OPEN, PIN_CLOSED)))
HOOK_TURN = turn_between(*((x - NEEDLE_OPEN[0] - way * NEEDLE_PATH[0], z - NEEDLE_OPEN[2] - way * NEEDLE_PATH[2])
                           for (x, z), way in ((PIN_OPEN, 0.0), (PIN_CLOSED, NEEDLE_WAY))))

# The joints of what is only drawn: axis, lower, upper, multiplier and offset of needle_driver, why. They mimic
# needle_driver roughly, for who knows the inputs only; joint_states has their exact values, which come first.
DRAWN = {
    "needle_arm_hinge": ("revolute", "0 1 0", 0.0, 2.2, ARM_TURN / NEEDLE_WAY, 0.0, "the arm turns about its hinge"),
    "needle_hook_turn": ("revolute", "0 1 0", -1.6, 1.6, HOOK_TURN / NEEDLE_WAY, 0.0,
                         "the hook turns about the needle's point, so that its pin stays at the end of the arm"),
    "needle_draw": ("prismatic", "-1 0 0", 0.0, NEEDLE_GONE, 0.0, 0.0,
                    "0: on the arm; else in the anchor exchange, or at its upper end gone as T-tag"),
    "needle_slide": ("prismatic", "-0.6 0 -0.8", 0.0, NEEDLE_WAY, 1.0, 0.0, "as needle_driver while it is on the arm"),
    "needle_turn": ("revolute", "0 1 0", -1.6, 1.6, HOOK_TURN / NEEDLE_WAY, 0.0, "as the hook while it is on the arm"),
    "argon_probe": ("prismatic", "1 0 0", PROBE_IN, PROBE_REACH, 0.0, PROBE_IN,
                    "of its end before the distal face; out while the argon pedal is down"),
}

# Joints of the shaft that no input drives: the simulator bends the shaft under load. Largest angle [rad], speed [rad/s]
# and torque [N m] per joint: design choice, far beyond what a hand causes.
SHAFT_LIMIT = (1.5, 10.0, 5.0)

MESHES = "package://vibe_description/meshes/"  # written by make_scope_meshes.py


def number(value):
    """Shortest text with 12 digits; never -0, so that the file does not depend on the sign of a zero."""
    text = f"{value:.12g}"
    return "0" if text == "-0" else text


def vector(values):
    return " ".join(number(v) for v in values)


ALONG_X = (0, math.pi / 2, 0)  # roll pitch yaw of a cylinder, whose axis is z in its own frame


class Cylinder:
    def __init__(self, radius, length, at, rpy=ALONG_X):
        self.radius, self.length, self.at, self.rpy = radius, length, at, rpy

    def xml(self):
        return f'<cylinder radius="{number(self.radius)}" length="{number(self.length)}"/>'


class Sphere:
    def __init__(self, radius, at):
        self.radius, self.at, self.rpy = radius, at, (0, 0, 0)

    def xml(self):
        return f'<sphere radius="{number(self.radius)}"/>'


class Mesh:
    """A file in the folder of meshes, in the frame of the link and in metres."""

    def __init__(self, name):
        self.name, self.at, self.rpy = name, (0, 0, 0), (0, 0, 0)

    def xml(self):
        return f'<mesh filename="{MESHES}{self.name}.obj"/>'


def capsule_x(start, end, radius):
    """Round bar from start to end along x, as the three primitives that URDF has for it."""
    bar = Cylinder(radius, end - start, ((start + end) / 2, 0, 0))
    return [bar, Sphere(radius, (start, 0, 0)), Sphere(radius, (end, 0, 0))]


def capsule_between(start, end, radius):
    """The same between any two points."""
    along = [b - a for a, b in zip(start, end)]
    length = math.hypot(*along)
    turn = (-math.asin(along[1] / length), math.atan2(along[0], along[2]), 0)
    bar = Cylinder(radius, length, tuple((a + b) / 2 for a, b in zip(start, end)), turn)
    return [bar, Sphere(radius, start), Sphere(radius, end)]


class Body:
    """Mass [kg], centre [m] and principal moments about it along the link's axes [kg m^2]."""

    def __init__(self, mass, centre, moments):
        self.mass, self.centre, self.moments = mass, centre, moments

    @staticmethod
    def bar_x(density, radius, start, end):
        length = end - start
        mass = density * math.pi * radius ** 2 * length
        across = mass * (3 * radius ** 2 + length ** 2) / 12
        return Body(mass, ((start + end) / 2, 0, 0), (mass * radius ** 2 / 2, across, across))

    @staticmethod
    def ball(density, radius, centre=(0, 0, 0)):
        mass = density * 4 / 3 * math.pi * radius ** 3
        return Body(mass, centre, (0.4 * mass * radius ** 2,) * 3)


class Urdf:
    def __init__(self):
        self.lines = []

    def add(self, indent, text):
        self.lines.append("  " * indent + text)

    def shape(self, tag, shape):
        self.add(2, f"<{tag}>")
        self.add(3, f'<origin xyz="{vector(shape.at)}" rpy="{vector(shape.rpy)}"/>')
        self.add(3, f"<geometry>{shape.xml()}</geometry>")
        self.add(2, f"</{tag}>")

    def link(self, name, body=None, mesh="", collisions=(), note=""):
        if note:
            self.add(1, f"<!-- {note} -->")
        if not (body or mesh or collisions):
            self.add(1, f"<link name={quoteattr(name)}/>")
            return
        self.add(1, f"<link name={quoteattr(name)}>")
        if body:
            ixx, iyy, izz = (number(m) for m in body.moments)
            self.add(2, "<inertial>")
            self.add(3, f'<origin xyz="{vector(body.centre)}" rpy="0 0 0"/>')
            self.add(3, f'<mass value="{number(body.mass)}"/>')
            self.add(3, f'<inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/>')
            self.add(2, "</inertial>")
        if mesh:
            self.shape("visual", Mesh(mesh))
        for shape in collisions:
            self.shape("collision", shape)
        self.add(1, "</link>")

    def joint(self, name, kind, parent, child, at=(0, 0, 0), rpy=(0, 0, 0), extra=()):
        self.add(1, f'<joint name="{name}" type="{kind}">')
        self.add(2, f'<parent link="{parent}"/>')
        self.add(2, f'<child link="{child}"/>')
        self.add(2, f'<origin xyz="{vector(at)}" rpy="{vector(rpy)}"/>')
        for line in extra:
            self.add(2, line)
        self.add(1, "</joint>")

    def input_joint(self, name, parent, child, at=(0, 0, 0)):
        kind, axis, lower, upper, velocity, effort, why = INPUTS[name]
        self.add(1, f"<!-- input {name}: {why} -->")
        limit = (f'<limit lower="{number(lower)}" upper="{number(upper)}" velocity="{number(velocity)}" '
                 f'effort="{number(effort)}"/>')
        self.joint(name, kind, parent, child, at, extra=(f'<axis xyz="{axis}"/>', limit))

    def drawn_joint(self, name, parent, child, at=(0, 0, 0)):
        kind, axis, lower, upper, multiplier, offset, why = DRAWN[name]
        self.add(1, f"<!-- drawn {name}: {why} -->")
        speed, effort = INPUTS["needle_driver"][4:6]
        limit = (f'<limit lower="{number(lower)}" upper="{number(upper)}" velocity="{number(speed)}" '
                 f'effort="{number(effort)}"/>')
        mimic = f'<mimic joint="needle_driver" multiplier="{number(multiplier)}" offset="{number(offset)}"/>'
        self.joint(name, kind, parent, child, at, extra=(f'<axis xyz="{axis}"/>', limit, mimic))

    def bend_joint(self, index, source, parent, child, at):
        """One of the equal parts of a total bend."""
        _, axis, lower, upper, velocity, effort, _ = INPUTS[source]
        limit = (f'<limit lower="{number(lower / SEGMENTS)}" upper="{number(upper / SEGMENTS)}" '
                 f'velocity="{number(velocity / SEGMENTS)}" effort="{number(effort)}"/>')
        mimic = f'<mimic joint="{source}" multiplier="{number(1 / SEGMENTS)}" offset="0"/>'
        self.joint(f"{source}_{index}", "revolute", parent, child, at, extra=(f'<axis xyz="{axis}"/>', limit, mimic))

    def shaft_joint(self, source, index, parent, child, at):
        """A joint that bends under load only, about the axis of the bend of the same direction."""
        axis = INPUTS[source.replace("shaft", "tip")][1]
        angle, velocity, effort = SHAFT_LIMIT
        limit = (f'<limit lower="{number(-angle)}" upper="{number(angle)}" velocity="{number(velocity)}" '
                 f'effort="{number(effort)}"/>')
        self.joint(f"{source}_{index}", "revolute", parent, child, at, extra=(f'<axis xyz="{axis}"/>', limit))


def add_shaft(urdf):
    """The insertion tube. It turns behind its bends: a bent shaft that a hand turns keeps its shape in space."""
    carrier = Body.ball(SCOPE_DENSITY, CARRIER_RADIUS)
    urdf.link("scope_base", note="at the gastro-oesophageal junction, x along the insertion into the lumen")
    urdf.input_joint("insertion", "scope_base", "scope_slide")
    urdf.link("scope_slide", carrier, note="where the tip of the straight endoscope is")
    bends = SHAFT_PIECES * SHAFT_PIECE
    urdf.joint("scope_shaft_mount", "fixed", "scope_slide", "scope_shaft", (-STRAIGHT_LENGTH - bends, 0, 0))
    back = -(SHAFT_LENGTH - bends)
    urdf.link("scope_shaft", Body.bar_x(SCOPE_DENSITY, SCOPE_RADIUS, back, 0), "shaft",
              capsule_x(back, 0, SCOPE_RADIUS), note="part of the insertion tube that stays in the oesophagus")
    for k in range(1, SHAFT_PIECES + 2):
        add_shaft_piece(urdf, k)
    urdf.input_joint("rotation", f"shaft_{SHAFT_PIECES + 1}", "scope_neck")
    urdf.link("scope_neck", carrier, note="end of the insertion tube, at the first bending joint")
    urdf.input_joint("tip_up_down", "scope_neck", "up_down_wheel")
    urdf.link("up_down_wheel", carrier, note="carries nothing: its joint holds the total bend that the segments mimic")
    urdf.input_joint("tip_left_right", "scope_neck", "left_right_wheel")
    urdf.link("left_right_wheel", carrier, note="carries nothing, as up_down_wheel")


def add_shaft_piece(urdf, index):
    """A universal joint and the piece behind it; behind the last one there is none."""
    parent = f"shaft_{index - 1}" if index > 1 else "scope_shaft"
    carrier = Body.ball(SCOPE_DENSITY, CARRIER_RADIUS)
    urdf.shaft_joint("shaft_up_down", index, parent, f"shaft_yoke_{index}", (SHAFT_PIECE if index > 1 else 0, 0, 0))
    urdf.link(f"shaft_yoke_{index}", carrier)
    urdf.shaft_joint("shaft_left_right", index, f"shaft_yoke_{index}", f"shaft_{index}", (0, 0, 0))
    if index > SHAFT_PIECES:
        urdf.link(f"shaft_{index}", carrier)
        return
    urdf.link(f"shaft_{index}", Body.bar_x(SCOPE_DENSITY, SCOPE_RADIUS, 0, SHAFT_PIECE),
              "shaft_piece", capsule_x(0, SHAFT_PIECE, SCOPE_RADIUS))


def add_bending_section(urdf):
    """Universal joints in the middle of equal lengths: the polygon then leaves and meets the arc along its tangents."""
    for k in range(1, SEGMENTS + 1):
        parent = f"segment_{k - 1}" if k > 1 else "scope_neck"
        length = SEGMENT_LENGTH if k < SEGMENTS else SEGMENT_LENGTH / 2
        urdf.bend_joint(k, "tip_up_down", parent, f"ring_{k}", (SEGMENT_LENGTH if k > 1 else 0, 0, 0))
        urdf.link(f"ring_{k}", Body.ball(SCOPE_DENSITY, CARRIER_RADIUS))
        urdf.bend_joint(k, "tip_left_right", f"ring_{k}", f"segment_{k}", (0, 0, 0))
        urdf.link(f"segment_{k}", Body.bar_x(SCOPE_DENSITY, SCOPE_RADIUS, 0, length),
                  "segment" if k < SEGMENTS else "segment_end", capsule_x(0, length, SCOPE_RADIUS))


def add_tip(urdf):
    urdf.joint("scope_tip_mount", "fixed", f"segment_{SEGMENTS}", "scope_tip", (SEGMENT_LENGTH / 2 + TIP_LENGTH, 0, 0))
    urdf.link("scope_tip", Body.bar_x(SCOPE_DENSITY, SCOPE_RADIUS, -TIP_LENGTH, 0), "tip",
              capsule_x(-TIP_LENGTH, -SCOPE_RADIUS, SCOPE_RADIUS), note="distal face, x along the viewing axis")
    # z forward, x right, y down (REP-103) out of x forward, y left, z up
    urdf.joint("scope_camera_mount", "fixed", "scope_tip", "scope_camera_optical", (0, 0, 0.0025),
               (-math.pi / 2, 0, -math.pi / 2))
    urdf.link("scope_camera_optical", note="z forward, x right, y down")


def add_cap(urdf):
    """Ring around the tip with the bracket of the needle arm above the field of view."""
    bracket_size = (ARM_REACH + CAP_LENGTH / 2, 0.006, 0.0016)  # the steel of bracket and link as one bar
    shell = STEEL * math.pi * (CAP_RADIUS ** 2 - SCOPE_RADIUS ** 2) * CAP_LENGTH * 0.4  # 60 % of the ring is polymer, air
    mass = shell + STEEL * bracket_size[0] * bracket_size[1] * bracket_size[2]
    across = mass * (3 * (CAP_RADIUS ** 2 + SCOPE_RADIUS ** 2) + (CAP_LENGTH + ARM_REACH) ** 2) / 12
    body = Body(mass, (-CAP_LENGTH / 4, 0, 0.002), (mass * (CAP_RADIUS ** 2 + SCOPE_RADIUS ** 2) / 2, across, across))
    urdf.joint("device_cap_mount", "fixed", "scope_tip", "device_cap")
    # tissue is met at its particles, some 4 mm apart: the thin bracket would slip between them and has no collision shape
    urdf.link("device_cap", body, "cap", capsule_x(-CAP_LENGTH, -CAP_RADIUS, CAP_RADIUS),
              note="suturing device: ring around the tip, bracket of the needle arm on the upper side")


def add_helix(urdf):
    """Tissue helix out of the second channel. No collision shape: it is made to pass through the wall."""
    carrier = Body.ball(STEEL, 0.001)
    urdf.input_joint("helix_advance", "scope_tip", "helix_carriage", (-0.002, 0.0028, -0.0022))
    urdf.link("helix_carriage", carrier)
    urdf.input_joint("helix_rotation", "helix_carriage", "helix")
    back = -HELIX_TURNS * HELIX_PITCH - HELIX_STEM
    urdf.link("helix", Body.bar_x(STEEL, 0.0009, back, 0), "helix",
              note="origin at the point of the wire; no collision shape, it penetrates the wall")


def add_needle(urdf):
    """Needle on its curved arm. No collision shape: it is made to pass through the wall."""
    urdf.input_joint("needle_driver", "device_cap", "needle", NEEDLE_OPEN)
    # as a body: half circle from the point of the needle (origin) outwards and back to the reach of the open arm
    end = (ARM_REACH - 0.0008 - NEEDLE_OPEN[0], CAP_RADIUS - 0.0008 - NEEDLE_OPEN[2])
    radius = math.hypot(*end) / 2
    outwards = (-end[1] / 2, end[0] / 2)  # across the chord
    mass = STEEL * math.pi * 0.0005 ** 2 * math.pi * radius
    centre = (end[0] / 2 + outwards[0] * 2 / math.pi, 0, end[1] / 2 + outwards[1] * 2 / math.pi)
    moment = mass * radius ** 2 / 2  # of a bent wire, about any axis to within a factor of two
    urdf.link("needle", Body(mass, centre, (moment,) * 3),
              note="origin at the point of the needle; no collision shape, it penetrates the wall")


def add_drawn_arm(urdf):
    """Arm and hook in place of the body of the link needle, which has no mesh: no weight of their own. They have
    collision shapes for simulations to which they are bodies."""
    carrier = Body.ball(STEEL, 0.001)
    pin = (PIN_OPEN[0] - HINGE[0], 0, PIN_OPEN[1] - HINGE[2])
    urdf.drawn_joint("needle_arm_hinge", "device_cap", "needle_arm", HINGE)
    urdf.link("needle_arm", carrier, "needle_arm", capsule_between((0, 0, 0), pin, ARM_RADIUS),
              note="only drawn, as all that follows, unless the scene makes arm and hook bodies; origin at the hinge")
    urdf.joint("needle_arm_pin_mount", "fixed", "needle_arm", "needle_arm_pin", pin)
    urdf.link("needle_arm_pin")
    urdf.drawn_joint("needle_hook_turn", "needle", "needle_hook")
    pin = (PIN_OPEN[0] - NEEDLE_OPEN[0], HINGE[1] - NEEDLE_OPEN[1], PIN_OPEN[1] - NEEDLE_OPEN[2])
    urdf.link("needle_hook", carrier, "needle_hook",
              capsule_between((0, 0, 0), HOOK_BEND, HOOK_RADIUS) + capsule_between(HOOK_BEND, pin, HOOK_RADIUS),
              note="holds the needle; origin at the needle's point")
    urdf.joint("needle_hook_pin_mount", "fixed", "needle_hook", "needle_hook_pin", pin)
    urdf.link("needle_hook_pin", note="where needle_arm_pin is")


def add_drawn_needle(urdf):
    """The needle that leaves the arm, on three joints from the cap: in the exchange, it stays where it is."""
    carrier = Body.ball(STEEL, 0.001)
    urdf.drawn_joint("needle_draw", "device_cap", "needle_depth", NEEDLE_OPEN)
    urdf.link("needle_depth", carrier)
    urdf.drawn_joint("needle_slide", "needle_depth", "needle_carriage")
    urdf.link("needle_carriage", carrier)
    urdf.drawn_joint("needle_turn", "needle_carriage", "suture_needle")
    urdf.link("suture_needle", carrier, "suture_needle", note="origin at its point")


def add_drawn_probe(urdf):
    """The argon probe out of the channel of the helix, its end in the middle before the face, where the beam begins."""
    urdf.drawn_joint("argon_probe", "scope_tip", "argon_probe")
    urdf.link("argon_probe", Body.ball(STEEL, 0.001), "argon_probe", note="origin at the end of the probe")


def make_urdf():
    urdf = Urdf()
    urdf.add(0, '<?xml version="1.0"?>')
    urdf.add(0, "<!-- Written by scripts/make_scope_urdf.py: change that program, not this file. SI units. -->")
    urdf.add(0, '<robot name="scope">')
    for part in (add_shaft, add_bending_section, add_tip, add_cap, add_helix, add_needle, add_drawn_arm,
                 add_drawn_needle, add_drawn_probe):
        part(urdf)
    urdf.add(0, "</robot>")
    return "\n".join(urdf.lines) + "\n"


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    sys.stdout.write(make_urdf())
