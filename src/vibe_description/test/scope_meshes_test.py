#!/usr/bin/env python3
"""The meshes of the endoscope: what the program writes, closed, as large as stated, near the collision shapes, and not in
the way of the lens. Without ROS but for the search of the package."""

import hashlib
import os
import re
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
PACKAGE = os.path.dirname(HERE)
sys.path[:0] = [HERE, os.path.join(PACKAGE, "scripts")]

import numpy
from make_scope_meshes import MATERIALS, files
from make_scope_urdf import NEEDLE_GONE, NEEDLE_IN_EXCHANGE, PROBE_IN, PROBE_REACH
from obj_mesh import ObjMesh, bodies, first_hits, nearest, unmatched_edges, volume_of
from scope_pose import Scope, numbers, origin_of

URDF = os.path.join(PACKAGE, "urdf", "scope.urdf")
ADDRESS = "package://vibe_description/"
MM = 0.001
NEEDLE_WAY = 0.018

# What the simulator needs of the URDF: all but what is drawn. Recordings hold for it, so it changes only on purpose.
PHYSICS = "d09569fb150337d8590467b9ba79b5583187a205c81d468f3c390bce08458a92"


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


HELD = {"needle_slide": NEEDLE_WAY, "needle_draw": NEEDLE_IN_EXCHANGE[0], "needle_turn": NEEDLE_IN_EXCHANGE[1]}
GONE = {**HELD, "needle_draw": NEEDLE_GONE}
PROBE_OUT = {"argon_probe": 0.010}  # marking.probe_length
DEVICE = ("scope_tip", "device_cap", "needle_arm", "needle_hook", "suture_needle", "helix", "argon_probe")


def physics_of(urdf):
    """The text without visuals and materials, and without the links and joints that are only drawn."""
    urdf = re.sub(r"\n *<!-- drawn .*(?=\n</robot>)", "", urdf, flags=re.S)
    return re.sub(r"\n *<material name.*?</material>", "", re.sub(r"\n *<visual>.*?</visual>", "", urdf, flags=re.S))


def mesh_names():
    return sorted(name for name in os.listdir(os.path.join(PACKAGE, "meshes")) if name.endswith(".obj"))


def mesh(name):
    return ObjMesh(os.path.join(PACKAGE, "meshes", name))


def moved(points, pose):
    return points @ pose[:3, :3].T + pose[:3, 3]


def along_edges(corners, spacing):
    """Points on the edges of triangles, the corners among them."""
    ends = numpy.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    counts = numpy.ceil(numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / spacing).astype(int)
    parts = [a + (b - a) * numpy.linspace(0, 1, n + 1)[:, None] for (a, b), n in zip(ends, counts)]
    return numpy.unique(numpy.round(numpy.concatenate(parts), 6), axis=0)


ARM = ("needle_arm", "needle_hook")  # bodies where a scene asks for it


class Capsule:
    """A cylinder whose ends carry spheres, as the simulator reads them."""

    def __init__(self, link, pose, number=0):
        shapes = [(c.find("geometry")[0], origin_of(c.find("origin"))) for c in link.findall("collision")]
        rod, place = [(shape, at) for shape, at in shapes if shape.tag == "cylinder"][number]
        self.radius, self.length = float(rod.get("radius")), float(rod.get("length"))
        centre, axis = moved(place[:3, 3], pose), pose[:3, :3] @ place[:3, 2]
        self.ends = numpy.array([centre - self.length / 2 * axis, centre + self.length / 2 * axis])

    def distance(self, points):
        """Outside positive, inside negative [m]."""
        a, along = self.ends[0], self.ends[1] - self.ends[0]
        share = numpy.clip((points - a) @ along / (along @ along), 0, 1)
        return numpy.linalg.norm(points - a - share[:, None] * along, axis=1) - self.radius

    def surface(self, spacing):
        along = self.ends[1] - self.ends[0]
        axis = along / numpy.linalg.norm(along)
        beside = numpy.cross(axis, (0, 1, 0) if abs(axis[1]) < 0.9 else (1, 0, 0))
        beside /= numpy.linalg.norm(beside)
        third = numpy.cross(axis, beside)
        around = numpy.linspace(0, 2 * numpy.pi, int(2 * numpy.pi * self.radius / spacing), endpoint=False)
        rings = [(self.ends[0] + s * along, 1.0, 0.0) for s in numpy.linspace(0, 1, int(self.length / spacing) + 2)]
        for end, sign in ((self.ends[0], -1), (self.ends[1], 1)):
            rings += [(end, numpy.cos(t), sign * numpy.sin(t)) for t in numpy.linspace(0, numpy.pi / 2, 10)]
        circles = numpy.cos(around)[:, None] * beside + numpy.sin(around)[:, None] * third
        return numpy.concatenate([centre + self.radius * (wide * circles + high * axis) for centre, wide, high in rings])


class ScopeMeshesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scope = Scope(text_of(URDF))
        cls.links = {link.get("name"): link for link in cls.scope.root.findall("link")}
        cls.straight = cls.scope.poses({}, numpy.eye(4))
        cls.meshes = {name: mesh(name) for name in mesh_names()}
        solid = [name for name, link in cls.links.items() if link.findall("collision") and name not in ARM]
        cls.capsules = {name: Capsule(cls.links[name], cls.straight[name]) for name in solid}

    def drawn(self, link, poses=None):
        """Corners of a link's triangles where it is [m]."""
        address = self.links[link].find("visual/geometry/mesh").get("filename")
        corners = self.meshes[os.path.basename(address)].corners()
        return moved(corners.reshape(-1, 3), (poses or self.straight)[link]).reshape(-1, 3, 3)

    def corners_of(self, links, joints):
        poses = self.scope.poses(joints, numpy.eye(4))
        return numpy.concatenate([self.drawn(link, poses) for link in links])

    # --- the files

    def test_files_are_what_the_program_writes(self):
        expected = files()
        self.assertEqual(sorted(expected), sorted(os.listdir(os.path.join(PACKAGE, "meshes"))))
        for name, text in expected.items():
            same = text == text_of(os.path.join(PACKAGE, "meshes", name))
            self.assertTrue(same, f"{name}: run scripts/make_scope_meshes.py meshes in vibe_description")

    def test_urdf_names_files_of_the_package(self):
        visuals = self.scope.root.findall("link/visual/geometry/mesh")
        self.assertEqual(len(visuals), len(self.scope.root.findall("link/visual")), "every visual is a mesh")
        used = {visual.get("filename") for visual in visuals}
        self.assertEqual(used, {ADDRESS + "meshes/" + name for name in self.meshes}, "and every mesh is used")
        found = subprocess.check_output(["rospack", "find", "vibe_description"], text=True).strip()
        for address in used:
            self.assertTrue(os.path.isfile(os.path.join(found, address[len(ADDRESS) :])), address)

    def test_what_the_simulator_reads_has_not_changed(self):
        urdf = text_of(URDF)
        self.assertEqual(hashlib.sha256(physics_of(urdf).encode()).hexdigest(), PHYSICS)
        # control: it covers collision shapes, joints and masses, and not what is drawn
        drawn = urdf[urdf.index("<!-- drawn ") :]
        for tag in ("<collision>", "<inertial>", "<joint", "<limit"):
            self.assertEqual(physics_of(urdf).count(tag), urdf.count(tag) - drawn.count(tag))
        self.assertEqual(drawn.count("<cylinder "), 3, "of arm and hook, which no simulation reads unless its scene asks for it")
        self.assertNotIn("meshes/", physics_of(urdf))
        changed = urdf.replace('<axis xyz="-0.6 0 -0.8"/>', '<axis xyz="-0.8 0 -0.6"/>', 1)
        self.assertNotEqual(physics_of(changed), physics_of(urdf), "the joint of the needle")

    # --- each mesh

    def test_meshes_are_closed_and_face_outwards(self):
        for name, each in self.meshes.items():
            self.assertEqual(unmatched_edges(each.faces), [], name)
            for body in bodies(each.faces):
                self.assertGreater(volume_of(each.corners()[body]), 0, name)
        # control: a hole, and a body turned inside out
        tip = self.meshes["tip.obj"]
        self.assertEqual(len(unmatched_edges(tip.faces[1:])), 3)
        self.assertLess(volume_of(tip.corners()[:, ::-1]), 0)

    def test_triangles_are_few_and_have_areas_and_normals(self):
        total = sum(os.path.getsize(os.path.join(PACKAGE, "meshes", name)) for name in self.meshes)
        self.assertLess(total, 800e3, "bytes of all meshes")
        for name, each in self.meshes.items():
            corners = each.corners()
            self.assertLess(len(corners), 4000, name)
            normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            area = numpy.linalg.norm(normal, axis=1)
            self.assertGreater(area.min(), 0, name)
            smooth = each.normals[each.normal_faces]
            self.assertLess(abs(numpy.linalg.norm(smooth, axis=2) - 1).max(), 2e-3, name)
            along = numpy.einsum("ijk,ik->ij", smooth, normal / area[:, None])
            wide = area > 2e-10  # narrower ones are as flat as the micrometre of the file lets them be
            self.assertGreater(along[wide].min(), 0.3, name + ": normals lean by less than the crease")
        self.assertEqual({line.split()[1] for name in self.meshes for line in files()[name].splitlines()
                          if line.startswith("usemtl")}, set(MATERIALS))  # fmt: skip

    # --- dimensions

    def test_dimensions_are_those_of_the_device(self):
        cap = self.drawn("device_cap").reshape(-1, 3)
        arm = self.corners_of(("needle_arm", "needle_hook", "suture_needle"), {}).reshape(-1, 3)
        closed = numpy.hypot(cap[:, 1], cap[:, 2]).max()
        self.assertAlmostEqual(2 * closed, 15.8 * MM, delta=0.1 * MM)
        self.assertAlmostEqual(arm[:, 2].max() - cap[:, 2].min(), 23.3 * MM, delta=0.15 * MM)
        self.assertAlmostEqual(arm[:, 0].max(), 18.4 * MM, delta=0.15 * MM)
        shut = self.corners_of(("needle_arm", "needle_hook"), self.scope.arm(NEEDLE_WAY)).reshape(-1, 3)
        self.assertLess(numpy.hypot(shut[:, 1], shut[:, 2]).max(), 7.9 * MM, "the closed arm is within the 15.8 mm")
        self.assertGreater(numpy.hypot(arm[:, 1], arm[:, 2]).max(), 15 * MM, "control: the open one is not")
        tip = self.drawn("scope_tip").reshape(-1, 3)
        self.assertAlmostEqual(2 * numpy.hypot(tip[:, 1], tip[:, 2]).max(), 12.6 * MM, delta=0.05 * MM)

    def test_points_of_needle_and_helix_are_where_the_simulator_has_them(self):
        self.assertLess(numpy.linalg.norm(self.meshes["suture_needle.obj"].points, axis=1).min(), 0.02 * MM)
        for way in numpy.linspace(0, NEEDLE_WAY, 19):
            poses = self.scope.poses(self.scope.arm(way), numpy.eye(4))
            for link in ("suture_needle", "needle_hook"):
                self.assertLess(numpy.linalg.norm(poses[link][:3, 3] - poses["needle"][:3, 3]), 1e-9, link)
        helix = self.meshes["helix.obj"].points
        foremost = helix[helix[:, 0].argmax()]
        self.assertAlmostEqual(foremost[0], 0, delta=0.01 * MM)
        self.assertAlmostEqual(numpy.hypot(*foremost[1:]), 1.0 * MM, delta=0.02 * MM)  # the wire is a millimetre off the axis
        self.assertLess(numpy.hypot(helix[:, 1], helix[:, 2]).max(), 1.4 * MM, "it passes through the channel")

    def test_the_arm_stays_joined_and_meets_nothing_on_its_way(self):
        rest = self.corners_of(("scope_tip", "device_cap"), {})
        for way in numpy.linspace(0, NEEDLE_WAY, 7):
            poses = self.scope.poses(self.scope.arm(way), numpy.eye(4))
            pins = poses["needle_arm_pin"][:3, 3] - poses["needle_hook_pin"][:3, 3]
            self.assertLess(numpy.linalg.norm(pins), 1e-9, way)
            for link in ("needle_arm", "needle_hook"):
                points = along_edges(self.drawn(link, poses), 0.6 * MM)
                # the cheeks and the pin of the hinge are around the arm; the needle's end is in the mouth
                points = points[numpy.hypot(points[:, 0] - 1.4 * MM, points[:, 2] - 5.3 * MM) > 1.2 * MM]
                self.assertGreater(nearest(points, rest).min(), 0.05 * MM, f"{link} at {1000 * way:.0f} mm")
                self.assertGreater(points[:, 0].min(), 0, "before the face")
        # control: a hook that does not turn as the arm does meets the anchor exchange or leaves its pin
        straight = self.scope.poses({**self.scope.arm(0.6 * NEEDLE_WAY), "needle_hook_turn": 0.0}, numpy.eye(4))
        apart = straight["needle_arm_pin"][:3, 3] - straight["needle_hook_pin"][:3, 3]
        self.assertGreater(numpy.linalg.norm(apart), 1 * MM)

    def test_the_needle_points_along_its_way(self):
        """Within 42 degrees of the chord; where it ends, within 32 of the bore."""
        for way in numpy.linspace(0, NEEDLE_WAY, 19):
            tip = self.scope.poses(self.scope.arm(way), numpy.eye(4))["suture_needle"][:3, :3] @ self.needle_axis()
            self.assertGreater(tip @ (-0.6, 0, -0.8), numpy.cos(numpy.radians(42)), f"at {1000 * way:.0f} mm")
        self.assertGreater(tip @ (-1, 0, 0), numpy.cos(numpy.radians(32)))
        held = self.scope.poses(HELD, numpy.eye(4))["suture_needle"][:3, :3] @ self.needle_axis()
        self.assertGreater(held @ (-1, 0, 0), numpy.cos(numpy.radians(6)), "the exchange holds it along its bore")

    def needle_axis(self):
        """Direction of the needle's first millimetre."""
        points = self.meshes["suture_needle.obj"].points
        near = points[abs(numpy.linalg.norm(points, axis=1) - 1 * MM) < 0.15 * MM].mean(axis=0)
        return -near / numpy.linalg.norm(near)

    def test_the_closed_needle_is_in_the_mouth_of_the_exchange(self):
        point = self.scope.poses(self.scope.arm(NEEDLE_WAY), numpy.eye(4))["needle"][:3, 3]
        hits = first_hits(point, numpy.array([[-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1.0]]),
                          self.drawn("device_cap"))  # fmt: skip
        self.assertTrue((hits < 3 * MM).all(), "walls of the bore around it")
        self.assertEqual(first_hits(point, numpy.array([[1.0, 0, 0]]), self.drawn("device_cap"))[0], numpy.inf)

    def seen(self, link, joints, count=400):
        """Share of a link's corners that can be seen from somewhere before and beside the device."""
        poses = self.scope.poses(joints, numpy.eye(4))
        points = self.drawn(link, poses).reshape(-1, 3)
        points = numpy.unique(points, axis=0)[:: max(1, len(points) // count)]
        # the rear of the endoscope is closed for this purpose: what is in it is not seen
        walls = numpy.concatenate([self.drawn(n, poses) for n in ("scope_tip", "device_cap", "segment_8")])
        ways = numpy.array([[1, 0, 0.02], [0.5, 0.8, 0.03], [0.5, -0.8, 0.1], [0.4, 0.2, 1.0], [0.4, -0.1, -1.0], [0, 0, 1.0]])
        free = [numpy.isinf(first_hits(p, ways, walls)).any() for p in points]
        return numpy.mean(free)

    def test_needle_and_probe_are_hidden_where_they_are_not(self):
        self.assertEqual(self.seen("suture_needle", GONE), 0, "the needle that is gone is within the endoscope")
        self.assertEqual(self.seen("argon_probe", {}), 0, "the probe is in its channel")
        # control: on the arm, in the exchange, and out of the channel they are seen
        self.assertGreater(self.seen("suture_needle", {}), 0.9)
        self.assertGreater(self.seen("suture_needle", HELD), 0.3)
        self.assertGreater(self.seen("argon_probe", PROBE_OUT), 0.3)

    def test_what_is_hidden_does_not_stick_out_where_the_endoscope_bends(self):
        """It stays in the rigid end: before the last bending joint, 21.5 mm behind the face, and within 6.3 mm."""
        for link, joints in (("suture_needle", GONE), ("argon_probe", {})):
            points = self.drawn(link, self.scope.poses(joints, numpy.eye(4))).reshape(-1, 3)
            self.assertGreater(points[:, 0].min(), -21.5 * MM, link)
            self.assertLess(numpy.hypot(points[:, 1], points[:, 2]).max(), 6.3 * MM, link)

    def test_the_probe_ends_where_the_beam_begins(self):
        """The simulator's beam leaves the x axis of scope_tip, marking.probe_length before it."""
        probe = self.drawn("argon_probe", self.scope.poses(PROBE_OUT, numpy.eye(4))).reshape(-1, 3)
        end = numpy.unique(probe[abs(numpy.linalg.norm(probe - (0.010, 0, 0), axis=1) - 0.5 * MM) < 0.01 * MM], axis=0)
        self.assertEqual(len(end), 20, "the rim of its bore, 1 mm wide")
        self.assertLess(numpy.linalg.norm(end.mean(axis=0) - (0.010, 0, 0)), 0.005 * MM)
        thick = self.meshes["argon_probe.obj"].points
        across = thick[abs(thick[:, 0] + 16 * MM) < 0.01 * MM]  # its rear end, parallel to the channel
        self.assertAlmostEqual(numpy.ptp(across[:, 1]), 2.3 * MM, delta=0.03 * MM)
        self.assertLess(PROBE_IN, 0)
        # in the mouth of its channel: rays from its axis meet the wall of the channel behind the probe's own
        mouth = probe[abs(probe[:, 0] + 0.6 * MM) < 0.7 * MM]
        self.assertLess(numpy.hypot(mouth[:, 1] - 2.8 * MM, mouth[:, 2] + 2.2 * MM).max(), 1.4 * MM)
        farthest = self.drawn("argon_probe", self.scope.poses({"argon_probe": PROBE_REACH}, numpy.eye(4))).reshape(-1, 3)
        self.assertLess(farthest[:, 0].min(), 0, "at its longest its rear end is still in the channel")

    # --- collision shapes

    def largest_gap(self, link, shift=(0, 0, 0), before=0.0):
        """How far a mesh sticks out of the collision shapes, as far as it is behind x = before [m]."""
        # the distance from a convex shape is largest at a corner
        points = self.drawn(link).reshape(-1, 3) + numpy.array(shift)
        points = points[points[:, 0] <= before + 1e-9]
        return numpy.min([capsule.distance(points) for capsule in self.capsules.values()], axis=0).max()

    def test_meshes_stay_within_the_collision_shapes(self):
        for link in self.capsules:
            allowed = LARGEST_OUTSIDE.get(link, OUTSIDE)
            self.assertLess(self.largest_gap(link), allowed, link)
        # control: a part that is half a millimetre beside its place
        self.assertGreater(self.largest_gap("segment_4", (0, 0.5 * MM, 0)), OUTSIDE)

    def test_arm_and_hook_are_near_their_collision_shapes(self):
        for link, rods, most in (("needle_arm", 1, 0.3 * MM), ("needle_hook", 2, 1.6 * MM)):
            capsules = [Capsule(self.links[link], self.straight[link], k) for k in range(rods)]
            points = self.drawn(link).reshape(-1, 3)
            self.assertLess(numpy.min([c.distance(points) for c in capsules], axis=0).max(), most, link)
            # control: with its first bar alone, or half a millimetre beside its place
            aside = points + (0, 0.5 * MM, 0) if rods == 1 else points
            self.assertGreater(capsules[0].distance(aside).max(), most, link)

    def test_what_has_no_collision_shape_is_small(self):
        cap = self.drawn("device_cap").reshape(-1, 3)
        self.assertLess(cap[:, 0].max(), 5 * MM, "hinge and exchange before the face")

    def gaps_of_shape(self, link, drawn_links, shift=(0, 0, 0)):
        """Points of a collision shape that are outermost, and how far the nearest mesh is [m]."""
        capsules = list(self.capsules.values())
        points = self.capsules[link].surface(3 * MM)
        points = points[numpy.min([capsule.distance(points) for capsule in capsules], axis=0) > -1e-6]
        return points, nearest(points + numpy.array(shift), numpy.concatenate([self.drawn(name) for name in drawn_links]))

    def test_collision_shapes_are_covered_by_the_meshes(self):
        for link, around in (("segment_4", ("segment_4", "segment_5")), ("shaft_3", ("shaft_3", "shaft_4")),
                             ("segment_8", ("segment_8", "scope_tip")), ("scope_tip", ("scope_tip", "device_cap")),
                             ("device_cap", ("device_cap", "scope_tip", "segment_8"))):  # fmt: skip
            points, gaps = self.gaps_of_shape(link, around)
            front = points[:, 0] > -7.9 * MM  # round where the device is flat
            self.assertLess(gaps[~front].max(initial=0), COVERED, link)
            self.assertLess(gaps[front].max(initial=0), COVERED_FRONT, link)
        # control: a part half a millimetre beside its place
        _, aside = self.gaps_of_shape("segment_4", ("segment_4", "segment_5"), (0, 0.5 * MM, 0))
        self.assertGreater(aside.max(), COVERED)

    # --- what the lens sees

    def covered(self, inputs, count=32):
        """Rays of the round picture (140 degrees, equidistant), and which of them meet the device."""
        steps = (numpy.arange(count) + 0.5) / count * 2 - 1
        down, right = numpy.meshgrid(steps, steps, indexing="ij")
        aside = numpy.hypot(down, right)
        inside = aside < 1
        angle = numpy.radians(70) * aside[inside]
        beside = numpy.sin(angle) / aside[inside]
        rays = numpy.stack([numpy.cos(angle), -beside * right[inside], -beside * down[inside]], axis=1)
        poses = self.scope.poses(inputs, numpy.eye(4))
        corners = numpy.concatenate([self.drawn(link, poses) for link in DEVICE])
        corners = corners[corners[:, :, 0].max(axis=1) > 0.6 * MM]  # nearer than the camera draws
        return angle, numpy.isfinite(first_hits(poses["scope_camera_optical"][:3, 3], rays, corners))

    def test_the_device_leaves_the_view_free(self):
        for name, inputs, most in (("open", {}, 0.12), ("closed", self.scope.arm(NEEDLE_WAY), 0.14), ("helix", {"helix_advance": 0.018}, 0.19),
                                   ("exchanged", {**self.scope.arm(0.0), **HELD}, 0.12), ("probe", PROBE_OUT, 0.19)):
            angle, hit = self.covered(inputs)
            print(f"{name}: {100 * hit.mean():.1f} % of the picture, nothing within {numpy.degrees(angle[hit].min()):.0f} deg")
            self.assertLess(hit.mean(), most, name)
            self.assertGreater(hit.mean(), 0.04, name + ": the device is seen")
            self.assertGreater(numpy.degrees(angle[hit].min()), 15 if name == "helix" else 8 if name == "probe" else 22, name)


# Farthest that a mesh may be outside of the collision shapes [m]: ribs of 0.12 mm and rounding
OUTSIDE = 0.15 * MM
LARGEST_OUTSIDE = {
    "scope_tip": 2.3 * MM,  # the rim of its face, see device_cap
    "device_cap": 3.0 * MM,  # a flat ring where the collision shape is a hemisphere: (sqrt 2 - 1) 7.9 mm at a sharp rim
}
COVERED = 0.2 * MM  # a cylinder of 28 sides is 0.04 mm flatter in the middle of a side; ribs of 0.12 mm
COVERED_FRONT = 2.6 * MM


if __name__ == "__main__":
    unittest.main()
