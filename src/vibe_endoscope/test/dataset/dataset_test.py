#!/usr/bin/env python3
"""vibe_dataset on a recording of a hollow ball with a burnt spot that moves: every file against what is known."""

import filecmp
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "endoscope"))

import numpy
import rosbag
import rospy
import tf2_msgs.msg
from ball import FRAME, RADIUS, Ball
from geometry_msgs.msg import TransformStamped
from PIL import Image
from sensor_msgs.msg import JointState
from vibe_msgs.msg import SessionInfo

# a lens that slides along y of the ball and looks along x: z forward, x right, y down
URDF = """<robot name="scope"><link name="scope_base"/><link name="tip"/><link name="scope_camera_optical"/>
<link name="needle"><visual name="rod"><origin xyz="0.02 -0.006 0.004" rpy="0 0 0"/><geometry><sphere radius="0.002"/>
</geometry></visual></link>
<joint name="slide" type="prismatic"><parent link="scope_base"/><child link="tip"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="hold" type="fixed"><parent link="tip"/><child link="needle"/></joint>
<joint name="look" type="fixed"><parent link="tip"/><child link="scope_camera_optical"/>
<origin rpy="-1.5707963267948966 0 -1.5707963267948966"/></joint></robot>"""
START = numpy.array([-0.008, 0.003, -0.002])
SPEED = 0.0004  # of the lens, from state to state [m]
STATES = 6
PERIOD = 0.1  # [s]


def place_of(state):
    return START + (0, SPEED * state, 0)


def write_recording(file, ball, with_frames=True, urdf=URDF, spoil=lambda state, particles: None):
    """spoil: changes the message of a state."""
    with rosbag.Bag(file, "w") as bag:
        begin = rospy.Time(100)
        if with_frames:
            fixed = TransformStamped(child_frame_id="scope_base")
            fixed.header.frame_id = FRAME
            fixed.transform.translation.x, fixed.transform.translation.y, fixed.transform.translation.z = START
            fixed.transform.rotation.w = 1
            bag.write("/tf_static", tf2_msgs.msg.TFMessage([fixed]), begin)
        info = SessionInfo(urdf=urdf, version="0.1", scene="name: ball\nradius: \"0.05\"\n", scene_hash=7)
        bag.write("/session_info", info, begin)
        bag.write("/tissue/topology", ball.topology(begin), begin)
        for state in range(STATES):
            stamp = begin + rospy.Duration(PERIOD * (state + 1))
            particles = ball.particles(stamp)
            spoil(state, particles)
            bag.write("/tissue/particles", particles, stamp)
            joints = JointState(name=["slide"], position=[SPEED * state])
            joints.header.stamp = stamp
            bag.write("/joint_states", joints, stamp)


def call(*arguments):
    program = subprocess.check_output(["catkin_find", "--first-only", "--libexec", "vibe_endoscope", "vibe_dataset"],
                                      text=True).strip()  # fmt: skip
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    return subprocess.run([program, *arguments], env=environment, capture_output=True, text=True, timeout=120)


def files_below(folder):
    return sorted(os.path.relpath(os.path.join(path, name), folder) for path, _, names in os.walk(folder) for name in names)


def json_of(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


def rays_of(numbers):
    """Unit rays of all pixels from intrinsics.json alone, and which are in the circle."""
    y, x = numpy.mgrid[0 : numbers["height"], 0 : numbers["width"]].astype(float)
    x, y = (x - numbers["cx"]) / numbers["fx"], (y - numbers["cy"]) / numbers["fy"]
    slope = numpy.hypot(x, y)
    angle = slope if numbers["model"] == "equidistant" else numpy.arctan(slope)
    scale = numpy.where(slope > 0, numpy.sin(angle) / numpy.where(slope > 0, slope, 1), 1)
    return numpy.dstack([x * scale, y * scale, numpy.cos(angle)]), slope * numbers["fx"] <= numbers["radius"]


class DatasetTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.ball = Ball()
        cls.spot = cls.ball.burn((1, 0.45, 0.3))
        cls.bag = os.path.join(cls.folder, "whole.bag")
        write_recording(cls.bag, cls.ball)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def make(self, name, *options, bag=None):
        output = os.path.join(self.folder, name)
        result = call(bag or self.bag, "--output", output, "--width", "320", "--height", "240", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return output

    def check_poses(self, folder, count):
        poses = numpy.loadtxt(os.path.join(folder, "poses.txt"))
        self.assertEqual(poses.shape, (count, 8))
        numpy.testing.assert_allclose(poses[:, 0], 100 + PERIOD * numpy.arange(1, count + 1))
        numpy.testing.assert_allclose(poses[:, 1:4], [place_of(state) for state in range(count)], atol=1e-9)
        turn = numpy.array([-0.5, 0.5, -0.5, 0.5])
        numpy.testing.assert_allclose(numpy.abs(poses[:, 4:] @ turn), 1, atol=1e-9)

    def check_depth(self, folder, state, numbers):
        rays, inside = rays_of(numbers)
        depth = numpy.load(os.path.join(folder, "depth", "{:06d}.npy".format(state)))
        labels = numpy.asarray(Image.open(os.path.join(folder, "labels", "{:06d}.png".format(state))))
        self.assertTrue((numpy.isfinite(depth) == inside).all())
        world = numpy.dstack([rays[..., 2], -rays[..., 0], -rays[..., 1]])  # x forward, y left, z up
        along = world @ place_of(state)
        distance = -along + numpy.sqrt(along**2 - place_of(state) @ place_of(state) + RADIUS**2)
        wall = inside & (labels < 100)
        error = numpy.abs(distance * rays[..., 2] - depth)[wall]
        print("depth of the ball: median {:.2g} m, max {:.2g} m".format(numpy.median(error), error.max()))
        self.assertLess(numpy.median(error), 1e-4)
        self.assertLess(error.max(), 1e-4)
        return labels, distance[..., None] * world + place_of(state), wall

    def check_flow(self, folder, state, points, wall, numbers):
        """The ball stands still, so the motion is that of the lens."""
        flow = numpy.load(os.path.join(folder, "flow", "{:06d}.npy".format(state)))
        visible = numpy.asarray(Image.open(os.path.join(folder, "flow_visible", "{:06d}.png".format(state))))
        self.assertTrue((numpy.isfinite(flow).all(axis=2) == (visible > 0)).all())
        seen = points - place_of(state + 1)
        seen = numpy.dstack([-seen[..., 1], -seen[..., 2], seen[..., 0]])
        aside = numpy.hypot(seen[..., 0], seen[..., 1])
        angle = numpy.arctan2(aside, seen[..., 2])
        scale = numbers["fx"] * (angle if numbers["model"] == "equidistant" else numpy.tan(angle)) / aside
        there = numpy.dstack([numbers["cx"] + scale * seen[..., 0], numbers["cy"] + scale * seen[..., 1]])
        y, x = numpy.mgrid[0 : numbers["height"], 0 : numbers["width"]]
        known = wall & (visible == 255)
        error = numpy.linalg.norm(numpy.dstack([x, y]) + flow - there, axis=2)[known]
        motion = numpy.linalg.norm(flow, axis=2)[known]
        print("flow: mean {:.2f} px, max error {:.3f} px".format(motion.mean(), error.max()))
        self.assertGreater(motion.mean(), 0.5)
        self.assertLess(error.max(), 0.2)
        self.assertGreater(numpy.median(numpy.linalg.norm(numpy.dstack([x, y]) - flow - there, axis=2)[known]), 0.5)

    def test_files_are_what_is_known_with_both_lenses(self):
        for lens, degrees in (("equidistant", "140"), ("rectilinear", "100")):
            folder = self.make("one_" + lens, "--lens", lens, "--field-of-view", degrees, "--rate", "0",
                               "--content", "depth,normals,labels,flow,particles")  # fmt: skip
            self.check_poses(folder, STATES)
            numbers, data = json_of(folder, "intrinsics.json"), json_of(folder, "dataset.json")
            self.assertEqual((data["images"], data["scene"]), (STATES, "name: ball\nradius: \"0.05\"\n"))
            self.assertFalse(os.path.exists(os.path.join(folder, "flow", "{:06d}.npy".format(STATES - 1))))
            labels, points, wall = self.check_depth(folder, 3, numbers)
            self.check_flow(folder, 3, points, wall, numbers)

            # the burnt spot is where the labels say, and dark in the image
            burnt = numpy.isin(labels, [row["number"] for row in json_of(folder, "labels.json") if row.get("heat") == "deep burn"])
            self.assertLess(numpy.linalg.norm(points[burnt].mean(axis=0) - self.spot), 0.0005)
            image = numpy.asarray(Image.open(os.path.join(folder, "image", "000003.png"))).mean(axis=2)
            self.assertLess(image[burnt].mean(), 0.6 * numpy.median(image[wall]))

            rod = next(row["number"] for row in json_of(folder, "labels.json") if row["name"] == "needle/rod")
            self.assertGreater((labels == rod).sum(), 20)
            normals = numpy.load(os.path.join(folder, "normals", "000003.npy")).astype(float)
            outward = numpy.dstack([-points[..., 1], -points[..., 2], points[..., 0]]) / RADIUS
            self.assertLess(numpy.abs(normals + outward)[wall].max(), 0.02)
            particles = numpy.load(os.path.join(folder, "particles", "000003.npy"))
            numpy.testing.assert_allclose(particles, self.ball.points, atol=1e-7)

    def test_same_call_gives_the_same_bytes_and_a_seed_varies_them(self):
        first, again = self.make("first", "--seed", "5"), self.make("again", "--seed", "5")
        other = self.make("other", "--seed", "6")
        names = files_below(first)
        self.assertEqual(names, files_below(again))
        self.assertGreater(len(names), 5 * STATES)
        _, different, wrong = filecmp.cmpfiles(first, again, names, shallow=False)
        self.assertEqual((different, wrong), ([], []))
        _, different, _ = filecmp.cmpfiles(first, other, names, shallow=False)
        self.assertIn("image/000000.png", different)
        # the truth has no noise: it is smooth beside the image
        depth = numpy.load(os.path.join(first, "depth", "000000.npy"))
        self.assertLess(numpy.nanmedian(numpy.abs(numpy.diff(depth, 2, axis=1))), 2e-5)

    def test_texture_and_light_change_the_image_and_no_truth(self):
        usual = self.make("usual")
        varied = self.make("varied", "--seed", "5", "--vary", "mucosa,light")
        other = self.make("other_look", "--seed", "6", "--vary", "mucosa,light")
        lens = self.make("lens", "--seed", "5", "--vary", "lens")
        truth = [name for name in files_below(usual) if name.split("/")[0] in ("depth", "normals", "labels", "flow", "flow_visible")]
        self.assertGreater(len(truth), 4 * STATES)
        for folder in (varied, other):
            _, different, wrong = filecmp.cmpfiles(usual, folder, truth + ["poses.txt", "intrinsics.json"], shallow=False)
            self.assertEqual((different, wrong), ([], []))
        _, different, _ = filecmp.cmpfiles(usual, lens, truth, shallow=False)  # control
        self.assertIn("depth/000000.npy", different)
        images = [numpy.asarray(Image.open(os.path.join(folder, "image", "000003.png")), float) for folder in (usual, varied, other)]
        for a, b in ((0, 1), (0, 2), (1, 2)):
            difference = numpy.abs(images[a] - images[b]).mean()
            print("images of two looks differ by {:.1f} levels".format(difference))
            self.assertGreater(difference, 2)

    def test_values_of_a_seed_are_told(self):
        one, other, part, none = (
            json_of(self.make(name, "--rate", "2", *options), "dataset.json")
            for name, options in (
                ("told", ("--seed", "8")),
                ("told_other", ("--seed", "9")),
                ("told_part", ("--seed", "8", "--vary", "light")),
                ("told_none", ()),
            )
        )
        self.assertEqual(one["varied"], ["lens", "sensor", "mucosa", "light"])
        self.assertEqual((part["varied"], none["varied"]), (["light"], []))
        for group in ("mount", "sensor", "mucosa", "light"):
            self.assertGreater(len(one[group]), 2)
            for name, value in one[group].items():
                self.assertNotEqual(value, other[group][name], name)
            self.assertEqual(part[group], (one if group == "light" else none)[group])
        self.assertEqual(none["mucosa"]["areae_size"], 0.0025)
        self.assertEqual(none["light"]["left_guide_x"], -0.0035)

    def test_a_wrong_state_is_told_also_where_none_is_taken(self):
        def nan(state, particles):
            if state == 1:
                particles.data = struct.pack("<f", float("nan")) + particles.data[4:]

        def short(state, particles):
            if state == 1:
                particles.data, particles.width = particles.data[: -particles.point_step], particles.width - 1
                particles.row_step -= particles.point_step

        for name, spoil, words in (("nan", nan, "not finite"), ("short", short, "particles and the topology")):
            bag = os.path.join(self.folder, name + ".bag")
            write_recording(bag, self.ball, spoil=spoil)
            output = os.path.join(self.folder, "of_" + name)
            # before the first image, between two images, and as an image
            for options in (("--from", "100.45"), ("--every", "3", "--rate", "0"), ("--rate", "0")):
                result = call(bag, "--output", output, "--width", "64", "--height", "48", *options)
                self.assertEqual(result.returncode, 1, options)
                self.assertEqual(result.stderr.count("vibe_dataset: "), 1, result.stderr)
                for part in (words, "100.200 s", bag, "--to"):
                    self.assertIn(part, result.stderr)
                self.assertFalse(os.path.exists(output), options)
            ended = call(bag, "--output", output, "--width", "64", "--height", "48", "--rate", "0", "--to", "100.15")
            self.assertEqual(ended.returncode, 0, ended.stderr)  # control: as the sentence says

    def test_a_pair_agrees_with_its_disparity(self):
        folder = self.make("pair", "--stereo", "--lens", "rectilinear", "--field-of-view", "90", "--baseline", "0.005",
                           "--rate", "5")  # fmt: skip
        numbers = json_of(folder, "intrinsics.json")
        left = numpy.load(os.path.join(folder, "left", "depth", "000000.npy"))
        right = numpy.load(os.path.join(folder, "right", "depth", "000000.npy"))
        disparity = numbers["fx"] * numbers["baseline"] / left
        errors, controls = [], []
        for y in range(60, 180, 7):
            for x in range(110, 210, 7):
                there = x - disparity[y, x]
                k, part = int(there), there - int(there)
                errors.append(abs((1 - part) * right[y, k] + part * right[y, k + 1] - left[y, x]))
                controls.append(abs(right[y, x] - left[y, x]))
        self.assertLess(numpy.median(errors), 1e-5)
        self.assertGreater(numpy.median(controls), 1e-4)
        self.assertEqual(len(files_below(os.path.join(folder, "left", "image"))), STATES // 2)

    def test_wrong_calls_and_recordings_end_with_one_sentence(self):
        no_frames, no_scope = (os.path.join(self.folder, name) for name in ("no_frames.bag", "no_scope.bag"))
        write_recording(no_frames, self.ball, with_frames=False)
        write_recording(no_scope, self.ball, urdf="")
        broken = os.path.join(self.folder, "broken.bag")
        mesh = '<visual><geometry><mesh filename="package://vibe_description/meshes/nowhere.obj"/></geometry></visual>'
        write_recording(broken, self.ball, urdf=URDF.replace('<link name="tip"/>', '<link name="tip">' + mesh + "</link>"))
        full = os.path.join(self.folder, "full")
        os.makedirs(os.path.join(full, "holiday"))
        new = os.path.join(self.folder, "new")
        cases = [
            ([self.bag, "--output", full], 1, "is not empty"),
            (["/dev/null", "--output", new], 1, "cannot be read as a recording"),
            ([no_frames, "--output", new], 1, "/tf_static"),
            ([no_scope, "--output", new], 1, "session_info"),
            ([broken, "--output", new], 1, "nowhere.obj"),
            ([self.bag, "--output", new, "--from", "500"], 1, "ends at 100.600 s"),
            ([self.bag, "--output", new, "--from", "100.31", "--to", "100.35"], 1, "no state between"),
            ([self.bag, "--output", new, "--from", "3", "--to", "2"], 2, "--from is later than --to"),
            ([self.bag, "--output", new, "--vary", "light"], 2, "give a seed"),
            ([self.bag, "--output", new, "--rate", "-1"], 2, "--rate"),
            ([self.bag, "--output", new, "--lens", "rectilinear", "--field-of-view", "170", "--seed", "1"], 1, "another seed"),
            ([self.bag, "--output", new, "--seed", "1", "--vary", "lens,organ"], 2, "organ"),
            ([self.bag, "--output", new, "--lens", "fisheye"], 2, "fisheye"),
            ([self.bag, "--output", new, "--content", "depth,colour"], 2, "colour"),
        ]
        for arguments, status, words in cases:
            result = call(*arguments)
            sentences = [line for line in result.stderr.splitlines() if line.startswith("vibe_dataset: ")]
            self.assertEqual((result.returncode, len(sentences)), (status, 1), result.stderr)
            others = [line for line in result.stderr.splitlines() if "rospack]" not in line]  # of Debian's rviz
            self.assertEqual(others, sentences)
            self.assertIn(words, sentences[0])
            self.assertFalse(os.path.exists(new), words)  # nothing is left of a call that was refused


if __name__ == "__main__":
    import rostest

    rostest.rosrun("vibe_endoscope", "dataset_test", DatasetTest, sys.argv)
