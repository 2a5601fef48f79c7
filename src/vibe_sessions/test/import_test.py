#!/usr/bin/env python3
"""Imported motions: units, interpolation, what is said of motions and maps that are wrong, and the session that follows."""
import contextlib
import io
import math
import os
import random
import shutil
import tempfile
import unittest

import numpy
from in_folder import InFolder

from vibe_sessions.headless import SessionError, call, find_in_package, find_program
from vibe_sessions.imports.main import main
from vibe_sessions.imports.map_file import JOINTS, read_map
from vibe_sessions.imports.motion_file import open_motion
from vibe_sessions.imports.resampling import GRID, inputs_of
from vibe_sessions.imports.session import record, write_commands

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "..", "regressions", "scenes", "coarse_stomach.yaml")
MAP = """\
scene: {scene}
time: {{from: t, unit: {time}}}
joints:
  insertion: {{from: depth, unit: {length}}}
  rotation: {{from: roll, unit: {angle}}}
  tip_up_down: {{from: bend, unit: {angle}, sign: -1, offset: 10 deg}}
buttons:
  insufflate: 1
  needle: {{from: jaw, above: 0.5}}
"""
SI = {"time": "s", "length": "m", "angle": "rad"}


class ImportTest(InFolder):
    def map(self, text=MAP, **units):
        return self.write("map.yaml", text.format(scene=SCENE, **{**SI, **units}))

    def motion(self, rows, names="t,depth,roll,bend,jaw"):
        return self.write("motion.csv", names + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))

    def read(self, motion, map_file):
        """(period, joints, buttons, sentences)"""
        made = read_map(map_file)
        opened = open_motion(motion, made.time)
        notes = list(opened.notes)
        found = inputs_of(opened, made, notes)
        return (*found, "\n".join(notes + opened.unused()))

    def bag(self, name="other.bag", count=90, joint="outer_insertion"):
        import rosbag
        from genpy import Time
        from sensor_msgs.msg import JointState, Joy
        path = os.path.join(self.folder, name)
        with rosbag.Bag(path, "w") as bag:
            for k in range(count):
                stamp = Time(1700000000, k * 10_000_000)
                state = JointState(name=["outer_yaw", joint], position=[0.001 * k, 0.05 + 0.0001 * k])
                state.header.stamp = stamp
                bag.write("/PSM1/measured_js", state, stamp)
                bag.write("/pedals", Joy(buttons=[int(k > 50)]), stamp)  # without a stamp of its own
                bag.write("/camera", Joy(), stamp)
        return path


def wave(count=40, rate=30, phase=0.0):
    """Rows of a motion within the limits and speeds of the scope: t [s], depth [m], two angles [rad], jaw."""
    return [[k / rate, 0.05 + 0.02 * math.sin(k / 9 + phase), 0.3 * math.cos(k / 7 + phase), 0.2 * math.sin(k / 11), float(k > 20)]
            for k in range(count)]


class UnitsTest(ImportTest):
    def test_the_same_motion_in_other_units_is_the_same_session(self):
        chance = random.Random(3)
        for case in range(30):
            begin = chance.choice([0, 1.7e9])
            digits = chance.choice([4, 6, 9, 17])
            rows = [[round(begin + t, 4), *[round(value, digits) for value in rest]]
                    for t, *rest in wave(40, chance.uniform(10, 200), chance.choice([0, chance.uniform(0, 6)]))]  # 0: from 50 mm
            unit, many = chance.choice([("mm", 1e3), ("um", 1e6), ("cm", 1e2)])
            one = self.read(self.motion(rows), self.map())
            # as another program writes them: times as text with its digits, the rest from floating-point products
            others = ["{:.1f},{!r},{!r},{!r},{!r}".format(1e3 * t - 1e3 * begin, many * d, math.degrees(r), math.degrees(b), jaw)
                      for t, d, r, b, jaw in rows]
            motion = self.write("other.csv", "t,depth,roll,bend,jaw\n" + "\n".join(others) + "\n")
            two = self.read(motion, self.map(time="ms", length=unit, angle="deg"))
            self.assertEqual(one[1].tobytes(), two[1].tobytes(), case)
            self.assertEqual(one[2].tobytes(), two[2].tobytes(), case)

    def test_the_bag_of_commands_is_the_same_bytes(self):
        contents = []
        for name in ("a.bag", "b.bag"):
            period, joints, buttons, _ = self.read(self.motion(wave()), self.map())
            write_commands(os.path.join(self.folder, name), SCENE, period, joints, buttons)
            with open(os.path.join(self.folder, name), "rb") as stream:
                contents.append(stream.read())
        self.assertEqual(*contents)

    def test_joints_are_those_of_the_motion_between_its_values(self):
        rows = wave()
        period, joints, buttons, _ = self.read(self.motion(rows), self.map())
        lead = len(joints) - int(rows[-1][0] / period) - 1
        at = numpy.arange(len(joints) - lead) * period
        times, depth, roll, bend, jaw = map(numpy.array, zip(*rows))
        for name, values in (("insertion", depth), ("rotation", roll), ("tip_up_down", math.radians(10) - bend)):
            asked = numpy.interp(at, times, values)
            error = numpy.abs(joints[lead:, list(JOINTS).index(name)] - asked).max()
            self.assertLess(error, 2 * GRID, name)
        held = jaw[numpy.searchsorted(times, at + 1e-9, side="right") - 1] > 0.5
        self.assertEqual(buttons[lead:, 2].astype(bool).tolist(), held.tolist())
        self.assertTrue(buttons[:, 5].all())

    def test_the_joints_go_to_the_first_pose_within_their_speed(self):
        _, joints, _, _ = self.read(self.motion(wave()), self.map(MAP + "lead: 1 s\n"))
        self.assertEqual(joints[0].tolist(), [0] * 7)
        self.assertLess(numpy.abs(numpy.diff(joints[:60, 0])).max(), 0.15 / 60)

    def test_start_moves_the_whole_motion(self):
        text = MAP.replace("from: depth,", "from: depth, start: 100 mm,")
        _, joints, _, _ = self.read(self.motion(wave()), self.map(text))
        _, plain, _, _ = self.read(self.motion(wave()), self.map())
        shift = joints[-30:, 0] - plain[-30:, 0]
        self.assertLess(numpy.ptp(shift), 2 * GRID)
        self.assertAlmostEqual(shift[0], 0.1 - wave()[0][1], 6)

    def test_the_joints_of_another_robot_in_a_bag(self):
        text = ("scene: {scene}\njoints:\n  insertion: {{from: /PSM1/measured_js/outer_insertion}}\n"
                "  rotation: {{from: /PSM1/measured_js/outer_yaw}}\nbuttons:\n  needle: {{from: /pedals/buttons/0}}\n")
        period, joints, buttons, said = self.read(self.bag(), self.map(text))
        self.assertAlmostEqual(joints[-1][0], 0.05 + 0.0001 * 100 * int(0.89 / period) * period, 6)
        self.assertEqual(buttons[:, 2].max(), 1)
        self.assertIn("The topic '/camera' is not used.", said)


class SentencesTest(ImportTest):
    """What is found is said, each in one sentence with numbers."""

    def said(self, rows, text=MAP, names="t,depth,roll,bend,jaw", **units):
        return self.read(self.motion(rows, names), self.map(text, **units))[3]

    def refused(self, sentence, motion, map_file):
        for other in sentence if isinstance(sentence, tuple) else (sentence,):
            with self.assertRaises(SessionError) as caught:
                self.read(motion, map_file)
            self.assertIn(other, str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))

    def test_nothing_is_said_of_a_good_motion(self):
        self.assertEqual([line for line in self.said(wave()).splitlines() if "stays at 0" not in line], [])

    def test_what_is_not_used(self):
        self.assertIn("The column 'grip' is not used.", self.said([[*row, 1.0] for row in wave()], names="t,depth,roll,bend,jaw,grip"))

    def test_beyond_the_limits(self):
        rows = wave()
        rows[30][1] = 0.35
        said = self.said(rows)
        self.assertRegex(said, r"'insertion' is beyond its limits of 0 to 300 mm in 1 of 79 steps, from 1.000 to 1.000 s of the "
                               r"motion, by up to 50 mm, and is clamped")
        self.assertRegex(said, r"'insertion' is asked for up to \d+ mm/s in \d+ steps, .* at 150 mm/s at most; it lags by")

    def test_wrong_units(self):
        in_mm = [[t, 1e3 * depth, *rest] for t, depth, *rest in wave()]
        self.assertIn("A possible cause is the unit, m; in mm they would fit", self.said(in_mm))
        scaled = self.said(in_mm, MAP.replace("from: depth,", "from: depth, scale: 0.001,"))
        self.assertNotIn("possible cause", scaled)
        in_deg = [[t, depth, math.degrees(roll), *rest] for t, depth, roll, *rest in wave()]
        self.assertIn("A possible cause is the unit, rad; in deg they would fit", self.said(in_deg))
        self.assertRegex(self.said(wave(), length="mm"), "'insertion' moves by .* mm in all. A possible cause is the unit, mm; in m")
        in_ms = [[1e3 * t, *rest] for t, *rest in wave()]
        self.assertIn("A possible cause is the unit of the time", self.said(in_ms))
        self.refused("possible cause is the unit of the time", self.motion([[1e6 * t, *rest] for t, *rest in wave()]), self.map())

    def test_gaps_stamps_that_go_back_and_no_numbers(self):
        rows = wave()
        rows[5][1] = float("nan")
        rows[10][0] = rows[7][0]
        said = self.said([row for k, row in enumerate(rows) if not 15 <= k < 35])
        self.assertRegex(said, "'depth': 1 of 20 values or their times are no numbers .* value 6; they are left out")
        self.assertRegex(said, r"'depth': 1 stamps repeat or go back, first after 0\.300 s")
        self.assertRegex(said, r"'depth': 1 gaps of up to 0\.7 s")

    def test_maps_that_are_wrong(self):
        motion = self.motion(wave())
        for change, sentence in (
                (("insertion:", "insertoin:"), "unknown key 'insertoin' of 'joints'; did you mean 'insertion'?"),
                (("from: depth", "from: dept"), "has no column 'dept'; did you mean 'depth'?"),
                (("unit: {length}", "unit: deg"), "'deg' is no unit of 'insertion', which is in m"),
                (("unit: {length}", "unit: furlong"), "unknown unit 'furlong'"),
                (("sign: -1", "sign: 2"), "the sign '2' is neither 1 nor -1"),
                (("buttons:", "butons:"), "unknown key 'butons' of a map; did you mean 'buttons'?"),
                (("scene: {scene}", "scene: nowhere.yaml"), "there is no scene 'nowhere.yaml'"),
                (("from: t,", "from: tt,"), "has no column 'tt'")):
            self.refused(sentence, motion, self.map(MAP.replace(*change)))
        for scene in ("[1, 2]\n", "a: [\n", f"base: {SCENE}\nstep_period: 0 s\n", "base: package://vibe_core/scenes/sphere.yaml\n"):
            path = self.write("scene.yaml", scene)
            self.refused("cannot be read or has no scope", motion, self.write("map.yaml", MAP.format(scene=path, **SI)))
        self.refused("no joint has a column", motion, self.write("map.yaml", "joints: {}\n"))
        self.refused("No message on '/PSM1/measured_js' has the joint 'yaw'; did you mean 'outer_yaw'?", self.bag(),
                     self.map("joints: {{insertion: {{from: /PSM1/measured_js/yaw}}}}\n"))

    def test_the_program_says_one_line_and_status_2(self):
        error = io.StringIO()
        with contextlib.redirect_stderr(error):
            status = main([os.path.join(self.folder, "none.csv"), "--map", self.map(), "--output", os.path.join(self.folder, "o")])
        self.assertEqual((status, error.getvalue().count("\n")), (2, 1), error.getvalue())
        self.assertFalse(os.path.exists(os.path.join(self.folder, "o")))

    def test_damaged_files_give_a_session_or_a_sentence(self):
        chance = random.Random(11)
        good = {"csv": self.motion(wave(12)), "bag": self.bag(count=12), "map": self.map()}
        bag_map = self.write("bag.yaml", f"scene: {SCENE}\njoints: {{insertion: {{from: /PSM1/measured_js/outer_insertion}}}}\n")
        words = [b"nan", b"1e309", b"-1e17", b"\x00", b"\xff\xfe", b",,,", b"\n\n", b";", b"'", b"{", b"[[", b"a: &x [*x]", b"-1", b"0"]
        refused = 0
        for _ in range(150):
            kind = chance.choice(sorted(good))
            with open(good[kind], "rb") as stream:
                content = bytearray(stream.read())
            for _ in range(chance.randint(1, 4)):
                at = chance.randrange(len(content) + 1)
                content[at:at + chance.choice([0, 1, 3, 30])] = chance.choice(words)
            if chance.random() < 0.2:
                del content[chance.randrange(len(content)):]
            hurt = self.write("hurt." + kind, bytes(content))
            files = {"csv": (hurt, good["map"]), "bag": (hurt, bag_map), "map": (good["csv"], hurt)}[kind]
            try:
                _, joints, _, _ = self.read(*files)
                self.assertTrue(numpy.isfinite(joints).all())
            except SessionError as error:
                self.assertNotIn("\n", str(error))
                refused += 1
        self.assertGreater(refused, 15)


@unittest.skipUnless(find_in_package("vibe_sim", "vibe_replay"), "vibe_replay is not built")
class SessionTest(ImportTest):
    """With the real program."""

    def imported(self, name):
        output = os.path.join(self.folder, name)
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(main([self.motion(wave()), "--map", self.map(), "--output", output]), 0)
        return output, said.getvalue()

    def test_a_session_that_moved_as_was_asked_for_and_is_the_same_twice(self):
        output, said = self.imported("one")
        for name in ("commands.bag", "session.bag", "summary.txt", "import.txt", "session_report/index.html"):
            self.assertTrue(os.path.getsize(os.path.join(output, name)) > 0, name)
        self.assertIn("state hash: ", said)
        self.assertEqual([name for name in os.listdir(output) if name.startswith(".part-")], [])
        import rosbag
        _, joints, _, _ = self.read(self.motion(wave()), self.map())
        worst = 0.0
        with rosbag.Bag(os.path.join(output, "session.bag")) as bag:
            self.assertEqual(bag.get_message_count(["/tf_static"]), 1)  # without which there are no pictures of it
            inputs = {message.step: message for _, message, _ in bag.read_messages(["/applied_input"])}
            for _, state, _ in bag.read_messages(["/joint_states"]):
                step = round((state.header.stamp.to_sec() - 1) * 60)
                if step > 0:  # the joints at the end of a step are those that it was asked for; the scope gives way a little
                    worst = max(worst, abs(state.position[state.name.index("insertion")] - joints[step - 1][0]))
        self.assertEqual(len(inputs), len(joints))
        self.assertTrue(all(tuple(message.joints) == tuple(joints[step]) for step, message in inputs.items()))
        self.assertTrue(all(message.state_hash for message in inputs.values()))
        self.assertLess(worst, 0.5e-3)  # a step later it would be 1 mm
        again = tempfile.mkdtemp(dir=self.folder)
        shutil.copy(os.path.join(output, "commands.bag"), again)
        record(again)
        with open(os.path.join(output, "session.bag"), "rb") as one, open(os.path.join(again, "session.bag"), "rb") as two:
            self.assertEqual(one.read(), two.read())
        replayed = call([os.path.join(again, "session.bag")], program=find_program("vibe_sim", "vibe_replay"))
        self.assertIn("the same: all", replayed)

    def test_the_inputs_of_a_session_end_in_its_state(self):
        place = lambda name: os.path.join(self.folder, name)  # noqa: E731
        said = call(["--scene", SCENE, "--script", "package://vibe_core/trainees/demo/grabs.yaml", "--duration", "1.5", "--seed", "7",
                     "--quiet", "--inputs", place("inputs.csv"), "--contacts", place("contacts.csv")])
        inputs = numpy.loadtxt(place("inputs.csv"), delimiter=",", skiprows=1)
        self.assertEqual((len(inputs), inputs[0][0]), (90, 0))
        write_commands(place("commands.bag"), SCENE, 1 / 60, inputs[:, 1:8], inputs[:, 8:].astype(numpy.uint8), 7)
        self.assertEqual("state hash: " + record(self.folder), said.strip())
        inputs[40:, 2] += 1e-6  # and another input does not
        os.remove(place("session.bag"))
        write_commands(place("commands.bag"), SCENE, 1 / 60, inputs[:, 1:8], inputs[:, 8:].astype(numpy.uint8), 7)
        self.assertNotEqual("state hash: " + record(self.folder), said.strip())


if __name__ == "__main__":
    unittest.main()
