#!/usr/bin/env python3
"""gamepad_node with a recorded pad and a simulator that is played by the test: motion, buttons, start, end, errors."""

import os
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import JointState, Joy
from vibe_testing.program import Program
from vibe_testing.wait import wait_until

SCOPE = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
SUTURING_DEVICE = ["helix_advance", "helix_rotation", "needle_driver"]
START = [0.05, 0.3, -0.2, 0.1, 0.004, 1.0, 0.006]
RECORDING = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pad_session.evemu")
INSERTION_RATE = 0.04  # of two_stick.yaml [m/s]


class Simulator:
    """Takes commands over at once and publishes the joints, as the simulator does."""

    def __init__(self):
        self.joints = dict(zip(SCOPE + SUTURING_DEVICE, START))
        self.scope, self.suturing_device, self.buttons = [], [], []
        self.publisher = rospy.Publisher("joint_states", JointState, queue_size=10)
        self.subscribers = [
            rospy.Subscriber("scope/servo_jp", JointState, self.take, self.scope, queue_size=1000, tcp_nodelay=True),
            rospy.Subscriber(
                "suturing_device/input/joint_states", JointState, self.take, self.suturing_device, queue_size=1000,
                tcp_nodelay=True
            ),
            rospy.Subscriber("scope/buttons", Joy, self.buttons.append, queue_size=1000, tcp_nodelay=True),
        ]
        self.timer = rospy.Timer(rospy.Duration(1 / 60), self.publish)

    def take(self, message, messages):
        messages.append(message)
        self.joints.update(zip(message.name, message.position))

    def publish(self, _):
        message = JointState(name=list(self.joints), position=list(self.joints.values()))
        message.header.stamp = rospy.Time.now()
        self.publisher.publish(message)

    def stop(self):
        self.timer.shutdown()
        for subscriber in self.subscribers:
            subscriber.unregister()
        self.publisher.unregister()


class GamepadTest(unittest.TestCase):
    def setUp(self):
        self.simulator = Simulator()
        self.nodes = []

    def tearDown(self):
        for node in self.nodes:
            node.stop()
        self.simulator.stop()

    def start(self, **parameters):
        self.nodes.append(Program("vibe_hardware", "gamepad_node", name="gamepad_node", **parameters))
        return self.nodes[-1]

    def test_a_recorded_pad_drives_the_scope(self):
        node = self.start(replay=RECORDING)
        self.assertTrue(wait_until(lambda: node.count("has ended") == 1, 20), node.lines)
        time.sleep(0.5)
        scope, buttons = self.simulator.scope, self.simulator.buttons
        self.assertEqual(scope[0].name, SCOPE)
        self.assertEqual(list(scope[0].position), START[:4])  # no jump at the start
        self.assertEqual(list(self.simulator.suturing_device[0].position), START[4:])
        steps = [abs(b.position[0] - a.position[0]) for a, b in zip(scope, scope[1:])]
        self.assertLess(max(steps), INSERTION_RATE * 0.1 + 1e-9)
        moved = scope[-1].position[0] - START[0]
        self.assertAlmostEqual(moved, INSERTION_RATE * 2.0, delta=INSERTION_RATE * 0.1)
        self.assertEqual(list(scope[-1].position[1:]), START[1:4])
        self.check_stamps(scope, 100)
        states = []
        for message in buttons:
            if not states or states[-1] != tuple(message.buttons):
                states.append(tuple(message.buttons))
        insufflate, grab, needle = (0, 0, 0, 0, 0, 1), (0, 1, 0, 0, 0, 1), (0, 1, 1, 0, 0, 1)
        nothing = (0, 0, 0, 0, 0, 0)
        self.assertEqual(states, [nothing, insufflate, grab, needle, nothing])
        self.assertEqual(node.count("To begin: press BTN_START to insufflate"), 1)
        self.assertEqual(node.stop(), 0)

    def check_stamps(self, messages, rate):
        stamps = [message.header.stamp.to_sec() for message in messages]
        self.assertEqual(stamps, sorted(set(stamps)))
        self.assertAlmostEqual((len(stamps) - 1) / (stamps[-1] - stamps[0]), rate, delta=0.1 * rate)
        self.assertLess(abs(stamps[-1] - time.time()), 2)

    def test_after_the_pad_has_gone_the_joints_are_held_and_buttons_repeated(self):
        node = self.start(replay=RECORDING)
        self.assertTrue(wait_until(lambda: node.count("has ended") == 1, 20), node.lines)
        time.sleep(0.2)
        scope, buttons = len(self.simulator.scope), len(self.simulator.buttons)
        position = list(self.simulator.scope[-1].position)
        time.sleep(1)
        self.assertGreater(len(self.simulator.scope) - scope, 80)
        self.assertAlmostEqual(len(self.simulator.buttons) - buttons, 10, delta=3)
        self.assertTrue(all(list(m.position) == position for m in self.simulator.scope[scope:]))

    def test_joints_that_the_simulator_puts_elsewhere_are_taken_over(self):
        node = self.start(replay=RECORDING)
        self.assertTrue(wait_until(lambda: node.count("has ended") == 1, 20), node.lines)
        subscriber = self.simulator.subscribers[0]
        subscriber.unregister()  # for a moment nothing takes the command over
        self.simulator.subscribers[0] = rospy.Subscriber("scope/servo_jp", JointState, self.simulator.scope.append)
        self.simulator.joints["insertion"] = 0.0  # a reset; the command is further away than half a second of motion
        self.assertTrue(wait_until(lambda: self.simulator.scope[-1].position[0] == 0.0, 3), self.simulator.scope[-1])

    def test_records_what_it_plays(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, "copy.evemu")
            node = self.start(replay=RECORDING, record=copy)
            self.assertTrue(wait_until(lambda: node.count("has ended") == 1, 20), node.lines)
            self.assertEqual(node.stop(), 0)
            self.assertEqual(events_of(copy)[-16:], events_of(RECORDING)[-16:])

    def test_messages_of_joy_node_drive_the_scope_until_it_leaves(self):
        joy = rospy.Publisher("joy", Joy, queue_size=10)
        node = self.start(joy="joy")
        self.assertTrue(wait_until(lambda: joy.get_num_connections() > 0, 20), node.lines)
        joy.publish(Joy(axes=[0] * 8, buttons=[0] * 11))
        self.assertTrue(wait_until(lambda: node.count("with 8 axes and 11 buttons") == 1, 20), node.lines)
        self.assertTrue(wait_until(lambda: self.simulator.scope, 20), node.lines)
        joy.publish(Joy(axes=[0, 1] + [0] * 6, buttons=[1] + [0] * 10))  # forwards, A
        self.assertTrue(wait_until(lambda: self.simulator.scope[-1].position[0] > START[0] + 0.01, 20))
        self.assertTrue(wait_until(lambda: self.simulator.buttons[-1].buttons[1] == 1, 20))
        joy.unregister()
        self.assertTrue(wait_until(lambda: node.count("is gone") == 1, 20), node.lines)
        self.assertTrue(wait_until(lambda: self.simulator.buttons[-1].buttons[1] == 0, 20))

    def test_a_joy_node_that_hangs_moves_nothing_on(self):
        joy = rospy.Publisher("joy", Joy, queue_size=10)
        node = self.start(joy="joy")
        self.assertTrue(wait_until(lambda: joy.get_num_connections() > 0, 20), node.lines)
        joy.publish(Joy(axes=[0] * 8, buttons=[0] * 11))
        self.assertTrue(wait_until(lambda: self.simulator.scope, 20), node.lines)
        pressed = Joy(axes=[0, 1] + [0] * 6, buttons=[1, 1] + [0] * 9)  # forwards; A switches, B is held
        joy.publish(pressed)
        self.assertTrue(wait_until(lambda: node.count("No message has come on /joy for 0.5 s") == 1, 20), node.lines)
        self.assertTrue(wait_until(lambda: self.simulator.buttons[-1].buttons[:3] == (0, 1, 0), 20))
        rest = list(self.simulator.scope[-1].position)
        self.assertGreater(rest[0], START[0] + 0.01)
        time.sleep(0.5)
        self.assertEqual(list(self.simulator.scope[-1].position), rest)
        joy.publish(pressed)  # it goes on: what was held is held again, and nothing is pressed anew
        self.assertTrue(wait_until(lambda: self.simulator.buttons[-1].buttons[:3] == (0, 1, 1), 20))
        self.assertTrue(wait_until(lambda: self.simulator.scope[-1].position[0] > rest[0] + 0.01, 20))
        joy.unregister()

    def test_without_a_pad_it_says_so_once_and_publishes_nothing(self):
        reports = []
        listener = rospy.Subscriber("/diagnostics", DiagnosticArray, reports.append)
        node = self.start(pad="no such gamepad")
        self.assertTrue(wait_until(lambda: node.count("No device found with 'no such gamepad'") == 1), node.lines)
        self.assertTrue(wait_until(lambda: reports))
        time.sleep(2)
        self.assertEqual(node.count("no such gamepad"), 1)
        self.assertEqual((self.simulator.scope, self.simulator.buttons), ([], []))
        self.assertEqual(reports[-1].status[0].level, DiagnosticStatus.WARN)
        self.assertIn("absent", reports[-1].status[0].message)
        listener.unregister()
        self.assertEqual(node.stop(), 0)

    def test_mistakes_end_it_with_a_sentence(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as mapping:
            mapping.write("name: wrong\njoints:\n  insertion: {axis: ABS_Y, mode: rate, rate: 1 m/s}\n")
            mapping.flush()
            for parameters, sentence in [
                ({"mapping": mapping.name}, mapping.name + ":3: joints.insertion.rate: '1 m/s' is out of range"),
                ({"mapping": "/nowhere.yaml"}, "/nowhere.yaml: cannot be opened"),
                ({"replay": "/nowhere.evemu"}, "nowhere.evemu"),
                ({"record": "/nowhere/pad.evemu"}, "Cannot write the pad recording '/nowhere/pad.evemu'"),
                ({"mappping": "x"}, "did you mean 'mapping'?"),
                ({"joy": "joy", "pad": "x"}, "The parameter joy goes without pad and replay"),
                ({"rate": 1000}, "Parameter /gamepad_node/rate must be a number from 60 Hz to 100 Hz"),
            ]:
                node = self.start(**parameters)
                self.assertEqual(node.ends(), 2, node.lines)
                self.assertEqual(node.count(sentence), 1, node.lines)


def events_of(file):
    with open(file, encoding="utf-8") as lines:
        return [line.split()[1:] for line in lines if line.startswith("E:")]


if __name__ == "__main__":
    rospy.init_node("gamepad_test")
    rostest.rosrun("vibe_hardware", "gamepad_test", GamepadTest, sys.argv)
