#!/usr/bin/env python3
"""The program endoscope_camera in a hollow ball of tissue with one burnt spot, without a display: where the spot is in
the picture must be where camera_info says."""

import json
import os
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

import numpy
import rospy
import rostest
import tf2_msgs.msg
from ball import FRAME, RADIUS, Ball
from geometry_msgs.msg import PoseStamped, TransformStamped
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from std_msgs.msg import String
from vibe_msgs.msg import TissueTopology
from vibe_testing.program import Program, find_program
from vibe_testing.wait import wait_until

CAMERA = "scope_camera_optical"
NEAR = 1.0  # error allowed where the spot is [px]
WITHOUT_DISPLAY = {"DISPLAY": None, "LIBGL_ALWAYS_SOFTWARE": None}

# a camera off the middle that looks along x of the ball: z forward, x right, y down
TURN = numpy.column_stack([(0, -1, 0), (0, 0, -1), (1, 0, 0)])
QUATERNION = (-0.5, 0.5, -0.5, 0.5)  # the same
PLACE = numpy.array([-0.008, 0.003, -0.002])
ASIDE = numpy.array([0, 0.008, 0])  # another place


def in_camera(point, place):
    return TURN.T @ (numpy.asarray(point) - place)


def project(info, point):
    """As image_geometry and OpenCV do: K, and for `equidistant` Kannala and Brandt with the coefficients D."""
    x, y = point[:2] / point[2]
    if info.distortion_model == "equidistant":
        aside = numpy.hypot(x, y)
        angle = numpy.arctan(aside)
        powers = angle ** numpy.array([2, 4, 6, 8])
        scale = angle * (1 + numpy.dot(info.D, powers)) / aside
        x, y = scale * x, scale * y
    return numpy.array([info.K[0] * x + info.K[2], info.K[4] * y + info.K[5]])


def pixels_of(image):
    return numpy.frombuffer(image.data, numpy.uint8).reshape(image.height, image.width, 3).astype(float)


def distance_from_middle(image):
    y, x = numpy.mgrid[0 : image.height, 0 : image.width]
    return numpy.hypot(x - (image.width - 1) / 2, y - (image.height - 1) / 2)


def dark_spot(image):
    """Middle, spread and amount of what is dark inside of the circle [px]."""
    light = pixels_of(image).mean(axis=2)
    inside = distance_from_middle(image) < 0.94 * min(image.width, image.height) / 2
    weight = numpy.clip(1 - light / (0.5 * numpy.median(light[inside])), 0, 1) * inside
    y, x = numpy.mgrid[0 : image.height, 0 : image.width]
    amount = weight.sum()
    if amount < 3:
        return None, 0.0, amount
    middle = numpy.array([(x * weight).sum(), (y * weight).sum()]) / amount
    spread = numpy.sqrt((((x - middle[0]) ** 2 + (y - middle[1]) ** 2) * weight).sum() / amount)
    return middle, spread, amount


class Camera(Program):
    """endoscope_camera with some parameters, and what it publishes."""

    started = 0  # each has a name of its own: parameters stay at the master

    def __init__(self, eyes=("",), **parameters):
        Camera.started += 1
        name = "camera{}".format(Camera.started)
        super().__init__("vibe_endoscope", "endoscope_camera", name=name, env=WITHOUT_DISPLAY, **parameters)
        self.images, self.infos, self.subscribers = {}, {}, []
        for eye in eyes:
            self.images[eye], self.infos[eye] = [], []
            base = "endoscope/" + (eye + "/" if eye else "")
            self.subscribers += [
                rospy.Subscriber(base + "image_raw", Image, self.images[eye].append),
                rospy.Subscriber(base + "camera_info", CameraInfo, self.infos[eye].append),
            ]

    def __enter__(self):
        # the program begins to listen with the first of them, and a picture is lost to one that comes later
        ready = lambda: all(subscriber.get_num_connections() > 0 for subscriber in self.subscribers)
        assert wait_until(ready), "the program does not publish"
        return self

    def __exit__(self, *_):
        for subscriber in self.subscribers:
            subscriber.unregister()
        assert self.stop() == 0, self.output()

    def last(self, stamp, eye=""):
        """Image and camera_info of a stamp, once they are there."""

        def of_stamp(messages):
            return [message for message in messages if message.header.stamp == stamp]

        arrived = wait_until(lambda: of_stamp(self.images[eye]) and of_stamp(self.infos[eye]))
        assert arrived, "no image in time; the program {}".format(
            "runs" if self.is_running() else "ended with status {}".format(self.ends()))
        return of_stamp(self.images[eye])[0], of_stamp(self.infos[eye])[0]


TRUTH = {  # topic, encoding, type and number of the values of a pixel
    "depth/image_raw": ("32FC1", numpy.float32, 1),
    "normals": ("32FC3", numpy.float32, 3),
    "labels": ("8UC1", numpy.uint8, 1),
    "flow": ("32FC2", numpy.float32, 2),
    "flow_visible": ("8UC1", numpy.uint8, 1),
}


class Truth:
    """What the program publishes beside the image."""

    def __init__(self, base="endoscope/"):
        self.messages = {topic: [] for topic in [*TRUTH, "pose"]}
        self.subscribers = [rospy.Subscriber(base + topic, Image, self.messages[topic].append) for topic in TRUTH]
        self.subscribers.append(rospy.Subscriber(base + "pose", PoseStamped, self.messages["pose"].append))

    def of(self, topic, stamp):
        def found():
            return [message for message in self.messages[topic] if message.header.stamp == stamp]

        assert wait_until(found), "no {} in time".format(topic)
        return found()[0]

    def values(self, topic, stamp):
        message = self.of(topic, stamp)
        encoding, kind, channels = TRUTH[topic]
        assert (message.encoding, message.header.frame_id) == (encoding, CAMERA)
        shape = (message.height, message.width) + ((channels,) if channels > 1 else ())
        return numpy.frombuffer(message.data, kind).reshape(shape)

    def __enter__(self):
        assert wait_until(lambda: all(s.get_num_connections() > 0 for s in self.subscribers)), "no truth is published"
        return self

    def __exit__(self, *_):
        for subscriber in self.subscribers:
            subscriber.unregister()


class EndoscopeCameraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ball = Ball()
        cls.spot = cls.ball.burn((1, 0.45, 0.3))
        cls.topology = rospy.Publisher("tissue/topology", TissueTopology, queue_size=1, latch=True)
        cls.particles = rospy.Publisher("tissue/particles", PointCloud2, queue_size=5)
        cls.tf = rospy.Publisher("/tf", tf2_msgs.msg.TFMessage, queue_size=100)
        cls.topology.publish(cls.ball.topology(rospy.Time.now()))
        cls.clock = rospy.Time.now() - rospy.Duration(1000)  # stamps have nothing to do with the time of day

    def wait_for_listener(self):
        # two of topology and tf would do, but the order in which they are made is the program's
        ready = lambda: min(p.get_num_connections() for p in (self.topology, self.particles, self.tf)) > 0
        self.assertTrue(wait_until(ready), "the program does not listen")

    def setUp(self):
        self.wait_until_alone()

    def wait_until_alone(self):
        # the connections of the program before end a little after it, and would be taken for those of the next one
        gone = lambda: max(p.get_num_connections() for p in (self.topology, self.particles, self.tf)) == 0
        self.assertTrue(wait_until(gone), "the program before still listens")

    def send_pose(self, stamp, place):
        transform = TransformStamped(child_frame_id=CAMERA)
        transform.header.stamp, transform.header.frame_id = stamp, FRAME
        transform.transform.translation.x, transform.transform.translation.y, transform.transform.translation.z = place
        rotation = transform.transform.rotation
        rotation.x, rotation.y, rotation.z, rotation.w = QUATERNION
        self.tf.publish(tf2_msgs.msg.TFMessage([transform]))

    def show(self, place=PLACE, ball=None):
        """Sends the ball as it is seen from a place, and tells the stamp."""
        cls = type(self)
        cls.clock += rospy.Duration(1)
        self.wait_for_listener()
        self.send_pose(cls.clock, place)
        self.particles.publish((ball or self.ball).particles(cls.clock))
        return cls.clock

    def check_spot(self, image, info, place=PLACE, allowed=NEAR):
        found, spread, _ = dark_spot(image)
        self.assertIsNotNone(found, "there is no dark spot")
        self.assertLess(spread, 20)
        expected = project(info, in_camera(self.spot, place))
        error = numpy.linalg.norm(found - expected)
        print("spot at {}, expected at {}: {:.2f} px".format(found.round(2), expected.round(2), error))
        self.assertLess(error, allowed)
        return found

    def test_equidistant_picture_is_as_camera_info_says(self):
        with Camera(rate=0) as camera:
            stamp = self.show()
            image, info = camera.last(stamp)
            self.assertEqual((image.width, image.height, image.step, image.encoding), (640, 480, 1920, "rgb8"))
            self.assertEqual((info.width, info.height, info.distortion_model), (640, 480, "equidistant"))
            self.assertEqual((image.header.frame_id, info.header.frame_id), (CAMERA, CAMERA))
            self.assertEqual(info.header.stamp, stamp)
            self.assertAlmostEqual(info.K[0], 240 / numpy.radians(70), places=6)
            before = self.check_spot(image, info)

            # the circle: black outside, tissue inside
            light, aside = pixels_of(image).mean(axis=2), distance_from_middle(image)
            self.assertEqual(light[aside > 241].max(), 0)
            self.assertGreater(light[aside < 238].min(), 0)
            self.assertEqual([light[y, x] for y in (0, -1) for x in (0, -1)], [0] * 4)

            # control: from another place it is elsewhere
            image, info = camera.last(self.show(PLACE + ASIDE))
            after = self.check_spot(image, info, PLACE + ASIDE)
            self.assertGreater(numpy.linalg.norm(after - before), 20)

            # control: without the spot nothing is dark
            image, _ = camera.last(self.show(ball=Ball()))
            self.assertIsNone(dark_spot(image)[0])

    def test_rectilinear_picture_is_as_camera_info_says(self):
        with Camera(rate=0, lens="rectilinear", field_of_view=110, width=500, height=600) as camera:
            image, info = camera.last(self.show())
            self.assertEqual((image.width, image.height, info.distortion_model), (500, 600, "plumb_bob"))
            self.assertEqual(len(info.D), 5)
            self.assertAlmostEqual(info.K[0], 250 / numpy.tan(numpy.radians(55)), places=6)
            self.check_spot(image, info)
            # control: the other lens would show it elsewhere
            wrong = CameraInfo(distortion_model="equidistant", D=[0] * 4, K=info.K)
            found = dark_spot(image)[0]
            self.assertGreater(numpy.linalg.norm(found - project(wrong, in_camera(self.spot, PLACE))), 4 * NEAR)

    def test_pair_sees_the_spot_displaced_by_focal_length_times_baseline_over_depth(self):
        with Camera(("left", "right"), rate=0, stereo=True, baseline=0.005, lens="rectilinear",
                     field_of_view=100) as pair:  # fmt: skip
            stamp = self.show()
            left, left_info = pair.last(stamp, "left")
            right, right_info = pair.last(stamp, "right")
            self.assertEqual(left_info.P[3], 0)
            self.assertAlmostEqual(right_info.P[3], -right_info.K[0] * 0.005, places=6)
            self.check_spot(left, left_info)
            displaced = dark_spot(left)[0] - dark_spot(right)[0]
            expected = left_info.K[0] * 0.005 / in_camera(self.spot, PLACE)[2]
            print("disparity {:.2f} px, expected {:.2f}".format(displaced[0], expected))
            self.assertGreater(expected, 10)
            self.assertAlmostEqual(displaced[0], expected, delta=1)
            self.assertAlmostEqual(displaced[1], 0, delta=0.5)

    def test_picture_shows_the_scope_as_it_was_at_the_stamp(self):
        with Camera(rate=0) as camera:
            self.wait_for_listener()
            begin = self.show()
            camera.last(begin)
            # poses before and after, the latter known long before the picture is taken
            middle, end = begin + rospy.Duration(0.5), begin + rospy.Duration(1)
            self.send_pose(end, PLACE + ASIDE)
            time.sleep(0.3)
            self.particles.publish(self.ball.particles(middle))
            image, info = camera.last(middle)
            self.check_spot(image, info, PLACE + ASIDE / 2)
            type(self).clock = end

    def test_a_mark_browns_also_while_its_states_have_no_transforms(self):
        marked = Ball()
        spot = marked.burn((1, 0.45, 0.3))
        marked.grade //= 3
        cls = type(self)

        def light_of(stamp):
            image, info = camera.last(stamp)
            x, y = project(info, in_camera(spot, PLACE)).round().astype(int)
            return pixels_of(image)[y - 3 : y + 4, x - 3 : x + 4].mean()

        with Camera(rate=0) as camera:
            camera.last(self.show(ball=Ball()))
            cls.clock += rospy.Duration(1)
            self.particles.publish(marked.particles(cls.clock))
            cls.clock += rospy.Duration(479)  # twice the time in which half of the white is gone
            old = light_of(self.show(ball=marked))
            camera.last(self.show(ball=Ball()))
            new = light_of(self.show(ball=marked))
        print("grey level of a mark: old {:.0f}, new {:.0f}".format(old, new))
        self.assertGreater(new, 1.2 * old)

    def check_truth(self, truth, stamp, info, place):
        pixel = numpy.round(project(info, in_camera(self.spot, place))).astype(int)
        x, y = pixel
        depth, labels = truth.values("depth/image_raw", stamp), truth.values("labels", stamp)
        self.assertAlmostEqual(depth[y, x], in_camera(self.spot, place)[2], delta=0.0003)
        outside = distance_from_middle(info) > 240.001
        self.assertTrue(numpy.isnan(depth[outside]).all() and (labels[outside] == 0).all())
        self.assertTrue(numpy.isfinite(depth[~outside]).all())
        normal = truth.values("normals", stamp)[y, x]
        self.assertLess(numpy.linalg.norm(normal + TURN.T @ self.spot / RADIUS), 0.03)
        # the burnt spot of the labels is where it is drawn
        rows, columns = numpy.nonzero(numpy.isin(labels, self.burnt))
        self.assertLess(numpy.hypot(columns.mean() - x, rows.mean() - y), 2)
        return pixel

    def test_truth_has_stamp_size_and_geometry_of_the_image(self):
        with Camera(rate=0) as camera, Truth() as truth:
            tables = []
            rospy.Subscriber("endoscope/label_table", String, lambda message: tables.append(json.loads(message.data)))
            self.assertTrue(wait_until(lambda: tables))
            type(self).burnt = [row["number"] for row in tables[0] if row.get("heat") not in (None, "none")]
            first, second = self.show(), None
            _, info = camera.last(first)
            before = self.check_truth(truth, first, info, PLACE)
            # the flow of the first image comes with the second
            self.assertEqual(truth.messages["flow"], [])
            step = numpy.array([0, 0.001, 0.0005])
            second = self.show(PLACE + step)
            camera.last(second)
            after = self.check_truth(truth, second, info, PLACE + step)
            flow, visible = truth.values("flow", first), truth.values("flow_visible", first)
            expected = project(info, in_camera(self.spot, PLACE + step)) - project(info, in_camera(self.spot, PLACE))
            self.assertLess(numpy.linalg.norm(flow[before[1], before[0]] - expected), 0.2)
            self.assertGreater(numpy.linalg.norm(expected), 2)
            self.assertEqual(visible[before[1], before[0]], 255)
            self.assertGreater(numpy.linalg.norm(after - before), 2)
            pose = truth.of("pose", second)
            self.assertEqual(pose.header.frame_id, FRAME)
            found = [pose.pose.position.x, pose.pose.position.y, pose.pose.position.z]
            numpy.testing.assert_allclose(found, PLACE + step, atol=1e-9)

    def test_sensor_changes_the_image_and_not_the_truth(self):
        shots = []
        for parameters in ({}, {"exposure": 0.5, "read_noise": 0.05, "distortion": 0.02}):
            self.wait_until_alone()
            with Camera(rate=0, **parameters) as camera, Truth() as truth:
                stamp = self.show()
                image, info = camera.last(stamp)
                shots.append((pixels_of(image), info.D, truth.values("depth/image_raw", stamp)))
        (plain, plain_d, depth), (noisy, noisy_d, same_depth) = shots
        numpy.testing.assert_array_equal(depth, same_depth)
        self.assertEqual((plain_d[0], noisy_d[0]), (0, 0.02))
        inside = (slice(200, 280), slice(280, 360))
        self.assertLess(noisy[inside].mean(), 0.85 * plain[inside].mean())
        self.assertGreater(numpy.abs(numpy.diff(noisy[inside], axis=1)).mean(), 5)

    def test_twice_the_pixels_show_the_same(self):
        shots = []
        for size in (1, 2):
            self.wait_until_alone()
            with Camera(rate=0, width=320 * size, height=240 * size) as camera:
                shots.append(camera.last(self.show())[0])
        spots = [dark_spot(shot)[0] + 0.5 for shot in shots]  # from the corner
        self.assertLess(numpy.linalg.norm(spots[1] / 2 - spots[0]), 0.5)
        small, large = pixels_of(shots[0]), pixels_of(shots[1])
        halved = large.reshape(240, 2, 320, 2, 3).mean(axis=(1, 3))
        inside = distance_from_middle(shots[0]) < 117
        difference = numpy.abs(halved - small)[inside].mean()
        control = numpy.abs(halved[:, ::-1] - small)[inside].mean()
        print("difference {:.2f} of 255, mirrored {:.2f}".format(difference, control))
        self.assertLess(difference, 6)  # the fine relief is shaded from neighbouring pixels
        self.assertGreater(control, 2 * difference)

    def test_listens_to_nothing_while_nobody_looks(self):
        with Camera((), rate=0) as camera:
            wait_until(lambda: any(t == "/endoscope/image_raw" for t, _ in rospy.get_published_topics()))
            self.assertTrue(camera.is_running())
            time.sleep(1)
            self.assertEqual(self.particles.get_num_connections(), 0)
            subscriber = rospy.Subscriber("endoscope/image_raw", Image, lambda _: None)
            self.wait_for_listener()
            subscriber.unregister()
            self.assertTrue(wait_until(lambda: self.particles.get_num_connections() == 0))

    def test_wrong_parameters_and_no_display_end_it_with_one_sentence(self):
        cases = [
            (["_widht:=640"], None, 2, "widht"),
            (["_lens:=fisheye"], None, 2, "equidistant or rectilinear"),
            (["_field_of_view:=180"], None, 2, "from 10 to 170"),
            (["_width:=lots"], None, 2, "whole number"),
            (["_exposure:=0"], None, 2, "from 0.05 to 20"),
            (["_lens:=rectilinear", "_distortion:=-0.1"], None, 2, "folds the image over"),
            ([], "/nowhere", 1, "apt-get install xvfb"),
        ]
        binary = find_program("vibe_endoscope", "endoscope_camera")
        for number, (arguments, path, status, words) in enumerate(cases):
            environment = {name: value for name, value in os.environ.items() if name not in WITHOUT_DISPLAY}
            if path:
                environment["PATH"] = path
            name = "__name:=wrong{}".format(number)
            answer = subprocess.run([binary, name] + arguments, env=environment, capture_output=True, text=True, timeout=60)
            self.assertEqual(answer.returncode, status, answer.stderr)
            sentences = [line for line in answer.stderr.splitlines() if line.startswith("endoscope_camera: ")]
            self.assertEqual(len(sentences), 1, answer.stderr)
            self.assertIn(words, sentences[0])


if __name__ == "__main__":
    rospy.init_node("endoscope_camera_test")
    rostest.rosrun("vibe_endoscope", "endoscope_camera_test", EndoscopeCameraTest, sys.argv)
