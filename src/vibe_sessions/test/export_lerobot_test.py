"""Episodes of a recording: which steps are rows of which goal, and how a goal ended."""

import io
import itertools
import os
import random
import unittest

import genpy
import numpy
import rosbag
from geometry_msgs.msg import PoseStamped, Vector3, WrenchStamped
from in_folder import InFolder
from PIL import Image as Picture
from sensor_msgs.msg import CompressedImage, Image, JointState
from vibe_msgs.msg import GoalProgress, ProcedureEvent, StepInput, StepResult, ToolContact, ToolContacts, TraineeProgress

from vibe_sessions.export.lerobot import JOINTS, NAMES, Reader
from vibe_sessions.export.pictures import Recorded, topic_of
from vibe_sessions.export.source import Source
from vibe_sessions.report.bag_file import BagError

RATE = 60
GOALS = [(1, 0.5, GoalProgress.REACHED), (2, 1.2, GoalProgress.REACHED), (3, 1.6, GoalProgress.FAILED), (4, 9, None)]  # until [s]
SLIP = 0.9  # [s]


def picture(number, encoding, height=16, width=32):
    """In rows with two bytes at their end that belong to no pixel, or as a PNG."""
    pixels = numpy.zeros((height, width, 3), numpy.uint8)
    pixels[0, 0] = number, 2 * number % 256, 7
    if encoding == "png":
        file = io.BytesIO()
        Picture.fromarray(pixels).save(file, "png")
        return CompressedImage(format="png", data=file.getvalue())
    order = {"rgb8": [0, 1, 2], "bgr8": [2, 1, 0], "bgra8": [2, 1, 0, 0], "mono8": [0], "16UC1": [0, 1]}[encoding]
    rows = numpy.pad(pixels[..., order].reshape(height, -1), ((0, 0), (0, 2)))
    return Image(height=height, width=width, encoding=encoding, step=rows.shape[1], data=rows.tobytes())


class EpisodesTest(InFolder):
    def setUp(self):
        super().setUp()
        self.path = os.path.join(self.folder, "session.bag")

    def write(self, steps=120, goals=True, reset=None, kinds=(), late=0.0, respawn=10**6):
        """Joint k has the position time + k where it is measured, and minus that where it is commanded. Everything is received
        up to `late` seconds after its stamp."""
        self.late, self.dice, self.last = late, random.Random(5), {}
        events = [(SLIP, ProcedureEvent.SLIP), *kinds]
        with rosbag.Bag(self.path, "w") as self.bag:
            for step in range(steps + 1):
                seconds = 1 + step / RATE
                self.put_results(seconds)
                for time, kind in events:
                    if abs(1 + time - seconds) < 1e-6:
                        self.put("procedure/events", ProcedureEvent(kind=kind), seconds)
                if goals:
                    self.put_goals(seconds)
                run = 2 if reset is not None and step >= reset else 1
                joints = [-(seconds + k) for k in range(7)]
                self.put("applied_input", StepInput(step=step, session=1 + (step >= respawn), run=run, joints=joints, buttons=bytes([0, 1, 0, 0, 0, step % 2])), seconds)
        return self.path

    def add_pictures(self, topic="endoscope/image_raw", encoding="rgb8", rate=RATE, until=3.0):
        """Their first pixel has the number of the picture in red, and twice that in green."""
        with rosbag.Bag(self.path, "a") as self.bag:
            for number in range(int(until * rate)):
                self.put(topic, picture(number, encoding), 1 + number / rate)
        return self.path

    def put(self, topic, message, seconds, received=None):
        message.header.stamp = genpy.Time.from_sec(seconds)
        self.last[topic] = max(self.last.get(topic, 0), (received or seconds) + self.dice.uniform(0, self.late))  # one after the other
        self.bag.write("/" + topic, message, genpy.Time.from_sec(self.last[topic]))

    def put_results(self, seconds, received=None):
        values = [seconds + k for k in range(7)]
        self.put("scope/measured_js", JointState(name=JOINTS[:4], position=values[:4], velocity=[1.0] * 4), seconds, received)
        self.put("suturing_device/measured_js", JointState(name=JOINTS[4:], position=values[4:], velocity=[2.0] * 3), seconds, received)
        pose, wrench = PoseStamped(), WrenchStamped()
        pose.pose.position.x, wrench.wrench.torque.z = seconds, 3 * seconds
        self.put("scope/measured_cp", pose, seconds, received)
        self.put("scope/measured_cf", wrench, seconds, received)
        contacts = [ToolContact(force=Vector3(0, 1.0, seconds), normal_force=2.0)] * 2
        self.put("scope/contacts", ToolContacts(contacts=contacts if seconds < 2 else []), seconds, received)
        self.put("step_result", StepResult(pressure=100 * seconds), seconds, received)

    def put_goals(self, seconds):
        ended, goals = 0, []
        for number, until, state in GOALS:
            if seconds - 1 > until - 1e-6:
                goals.append(GoalProgress(id=number, goal="goal {}".format(number), state=state))
                ended = until
        if len(goals) < len(GOALS):
            number = GOALS[len(goals)][0]
            goals.append(GoalProgress(id=number, goal="goal {}".format(number), state=GoalProgress.ACTIVE))
        if abs(seconds - 1 - ended) < 1e-6:  # when something changes, as the trainee sends it
            self.put("trainee/progress", TraineeProgress(goals=goals), seconds)

    def episodes(self, fps=30, **options):
        with Source(self.path, **options) as source:
            return [(episode, episode.split(success), success) for episode, success in Reader(source, fps).episodes()]

    def test_goals_are_episodes_with_their_splits(self):
        self.write()
        found = [(episode.task, split, success) for episode, split, success in self.episodes()]
        self.assertEqual(found, [("goal 1", "train", True), ("goal 2", "recovery", True), ("goal 3", "failure", False),
                                 ("goal 4", "failure", False)])  # fmt: skip

    def test_a_row_is_what_was_known_at_its_time_and_what_was_commanded_then(self):
        for fps, late in ((20, 0), (30, 0), (60, 0), (30, 0.9), (60, 2.9)):
            self.write(late=late)
            self.assertEqual([len(episode.times) for episode, _, _ in self.episodes(fps)],
                             [0.5 * fps, round(0.7 * fps), 0.4 * fps, 0.4 * fps + 1])  # fmt: skip
            for episode, _, _ in self.episodes(fps):
                columns, times = episode.columns(), numpy.array(episode.times) / 1e9
                self.assertLess(abs(numpy.diff(times) - 1 / fps).max(), 1e-6)
                self.assertEqual({name: value.shape for name, value in columns.items()},
                                 {name: (len(times), len(names)) for name, names in NAMES.items()})  # fmt: skip
                expected = times[:, None] + numpy.arange(7)
                numpy.testing.assert_allclose(columns["observation.state"][:, :7], expected, atol=1e-6)
                numpy.testing.assert_allclose(columns["action"][:, :7], -expected, atol=1e-6)
                numpy.testing.assert_allclose(columns["observation.pose"][:, 0], times, atol=1e-6)
                numpy.testing.assert_allclose(columns["observation.wrench"][:, 5], 3 * times, atol=1e-6)
                touched = (times < 2 - 1e-6)[:, None]
                contacts = numpy.stack([numpy.full_like(times, 2), 4 + 0 * times, 0 * times, 2 + 0 * times, 2 * times], axis=1)
                numpy.testing.assert_allclose(columns["observation.contacts"], touched * contacts, atol=1e-5)
                numpy.testing.assert_allclose(columns["observation.gas"][:, 0], 100 * times, atol=1e-3)

    def test_events_are_in_the_first_row_after_them(self):
        self.write(kinds=[(0.25, ProcedureEvent.GRAB), (0.25, ProcedureEvent.GRAB)])
        columns = [episode.columns()["observation.events"] for episode, _, _ in self.episodes(20)]
        grabs = NAMES["observation.events"].index("grab")
        self.assertEqual([column[:, grabs].sum() for column in columns], [2, 0, 0, 0])
        self.assertEqual(columns[0][5, grabs], 2)
        self.assertEqual(columns[1].sum(), 1)  # the slip

    def test_no_event_is_lost_whenever_it_is_received(self):
        kinds = [(k / 12, ProcedureEvent.GRAB) for k in range(1, 24)]
        grabs = NAMES["observation.events"].index("grab")
        for fps, late in itertools.product((2, 10, 60), (0, 0.9)):
            self.write(kinds=kinds, late=late)
            found = [episode.columns()["observation.events"][:, grabs].sum() for episode, _, _ in self.episodes(fps)]
            self.assertEqual(found, [6, 8, 5, 4], (fps, late))  # that which ends a goal belongs to it

    def test_a_goal_that_a_range_cuts_has_its_own_label(self):
        self.write()
        for end, labels in ((1.3, [True]), (1.6, [True, True]), (2.4, [True, True, False]), (2.9, [True, True, False, False])):
            self.assertEqual([success for _, _, success in self.episodes(end=end)], labels, end)

    def test_a_simulator_that_was_started_anew_is_another_episode(self):
        self.write(goals=False, respawn=60)
        self.assertEqual([len(episode.times) for episode, _, _ in self.episodes()], [30, 31])

    def test_where_time_is_set_back_no_row_has_results_of_another_time(self):
        for length, lost in itertools.product((60, 300), (0, 6)):  # steps until then; whose results a recorder has lost after it
            self.write(steps=0, goals=False)
            with rosbag.Bag(self.path, "w") as self.bag:
                for step in range(2 * length):
                    run, seconds, received = 1 + step // length, 1 + step % length / RATE, 1 + step / RATE
                    if not 0 <= step - length < lost:
                        self.put_results(seconds, received)
                    message = StepInput(step=step % length, run=run, joints=[-seconds] * 7)
                    self.put("applied_input", message, seconds, received + 0.01)
            found = [episode.columns() for episode, _, _ in self.episodes(60)]
            self.assertEqual([len(columns["action"]) for columns in found], [length, length - lost])
            for columns in found:
                numpy.testing.assert_allclose(columns["observation.pose"][:, 0], -columns["action"][:, 0], atol=1e-6)

    def test_two_simulators_are_refused(self):
        self.write()
        with rosbag.Bag(self.path, "a") as bag:
            bag.write("/other/applied_input", StepInput(), genpy.Time(1))
        with self.assertRaisesRegex(BagError, "two simulators ./applied_input and /other/applied_input.*; take one of them out"):
            self.episodes()

    def test_without_a_trainee_a_session_is_an_episode_and_a_reset_begins_another(self):
        self.write(goals=False, reset=60, kinds=[(1.5, ProcedureEvent.CINCHED)])
        found = [(len(episode.times), split) for episode, split, _ in self.episodes()]
        self.assertEqual(found, [(30, "failure"), (31, "train")])
        self.assertEqual(len(self.episodes(begin=1.5, end=1.9)[0][0].times), 12 + 1)

    def test_recorded_pictures_are_those_nearest_to_the_rows(self):
        for topic, encoding, rate in (("endoscope/image_raw", "rgb8", 60), ("endoscope/image_raw", "bgr8", 30), ("a/endoscope/image_raw", "bgra8", 20),
                                      ("endoscope/image_raw/compressed", "png", 60), ("endoscope/left/image_raw", "mono8", 60)):  # fmt: skip
            self.write()
            self.add_pictures(topic, encoding, rate)
            with Source(self.path) as source:
                pictures, fps = Recorded(source), min(rate, 30)
                self.assertEqual(pictures.shape, [16, 32, 3])
                for episode, _ in Reader(source, fps).episodes():
                    found = numpy.array([frame[0, 0] for frame in pictures.of(episode.times, fps)])
                    numbers = numpy.round((numpy.array(episode.times) / 1e9 - 1) * rate)
                    numpy.testing.assert_array_equal(found[:, 0], numbers)
                    numpy.testing.assert_array_equal(found[:, 1], numbers if encoding == "mono8" else 2 * numbers % 256)

    def test_after_a_reset_pictures_are_those_of_the_new_time(self):
        self.write()
        self.add_pictures()
        with rosbag.Bag(self.path, "a") as bag:
            for number in range(60):
                message = picture(190 + number, "rgb8")
                message.header.stamp = genpy.Time.from_sec(2 + number / RATE)
                bag.write("/endoscope/image_raw", message, genpy.Time.from_sec(20 + number / RATE))
        with Source(self.path) as source:
            found = [int(frame[0, 0, 0]) for frame in Recorded(source).of([int(time * 1e9) for time in (2, 2.5, 2.1, 2.2)], 30)]
        self.assertEqual(found, [60, 90, 196, 202])

    def test_pictures_that_cannot_be_used(self):
        self.write()
        self.add_pictures("microscope/image_raw")  # of another camera
        with Source(self.path) as source:
            self.assertEqual(topic_of(source), [])
        self.add_pictures(rate=10)
        with Source(self.path) as source, self.assertRaisesRegex(BagError, "no picture within 0.0.. s of a frame; give the --rate"):
            list(Recorded(source).of([1e9 + k * 1e9 / 30 for k in range(60)], 30))
        self.write()
        self.add_pictures(encoding="16UC1")
        with Source(self.path) as source, self.assertRaisesRegex(BagError, "image_raw at 1.000 s cannot be read .'16UC1'.; those in rgb8"):
            Recorded(source)

    def test_what_cannot_be_done(self):
        self.write()
        with self.assertRaisesRegex(BagError, "fewer than 100 frames; give a lower --rate"):
            self.episodes(100)
        with rosbag.Bag(self.path, "w") as bag:
            bag.write("/applied_input", StepInput(), genpy.Time(1))
        with self.assertRaisesRegex(BagError, "has no scope/measured_js, which lerobot needs; "):
            self.episodes()


if __name__ == "__main__":
    unittest.main()
