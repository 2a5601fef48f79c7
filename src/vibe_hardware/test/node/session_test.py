#!/usr/bin/env python3
"""A session without hardware: simulator, hardware_node and emulated devices with a hand that presses a balloon."""

import os
import socket
import struct
import sys
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from hardware_test_support import Emulator
from sensor_msgs.msg import JointState
from vibe_msgs.msg import HapticParameters, ProcedureEvent, StepInput
from vibe_testing.diagnostics import Diagnostics
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

# Touches at 7 cm, presses for some seconds and leaves; the helix is advanced and a button held meanwhile.
SCRIPT = """
name: session
actions:
  - {move: {insertion: 7.8 cm, rotation: 0.3, tip_up_down: 0.2}, in: 2 s}
  - {move: {helix_advance: 5 mm}, in: 1 s}
  - {hold: insufflate, for: 1 s}
  - {wait: 4 s}
  - {move: {insertion: 5 cm}, in: 1 s}
  - {wait: 60 s}
"""
STATUS_REPORT, STALL = 3, 1


class DeviceSocket:
    """A second host of an emulated device, in the words of socket_bus.hpp."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.settimeout(5)
        self.socket.connect(path)
        self.number = 0

    def feature(self, report):
        self.number = (self.number + 1) % 256
        self.socket.send(bytes([ord("G"), self.number, report]))
        while True:
            packet = self.socket.recv(8192)
            if packet[0] == ord("R") and packet[1] == self.number:
                return None if packet[2] == STALL else packet[3:]

    def status(self):
        """Number of the set in force, accepted sets, refused sets."""
        report = self.feature(STATUS_REPORT)
        return struct.unpack_from("<H", report, 6)[0], *struct.unpack_from("<II", report, 20)


class SessionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.applied = Recorder("applied_input", StepInput)
        cls.scope = Recorder("scope/input/joint_states", JointState)
        cls.haptic = Recorder("haptic/measured_js", JointState)
        cls.parameters = Recorder("haptic/parameters", HapticParameters)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.diagnostics = Recorder("/diagnostics", DiagnosticArray)
        assert wait_until(lambda: cls.applied.messages, 60), "the simulator does not run"
        cls.emulator = Emulator(SCRIPT)
        cls.emulator.start()
        cls.node = Program("vibe_hardware", "hardware_node", name="hardware_node", bus=cls.emulator.folder)

    @classmethod
    def tearDownClass(cls):
        cls.node.stop()
        cls.emulator.stop()

    def test_a_hand_presses_the_tissue_and_feels_it(self):
        touch = self.parameters.waits_for(lambda m: m.touching, 30)
        self.assertIsNotNone(touch, self.node.output())
        device = DeviceSocket(os.path.join(self.emulator.folder, "haptic.hid"))
        first = device.status()
        self.assertIsNotNone(self.applied.waits_for(lambda m: m.buttons[5] == 1, 20), "insufflate")
        time.sleep(2)
        second = device.status()
        self.check_parameters_arrive(first, second)
        self.check_force()
        self.assertIsNotNone(self.parameters.waits_for(lambda m: not m.touching, 30))
        for kind in (ProcedureEvent.CONTACT_BEGIN, ProcedureEvent.CONTACT_END):
            self.assertIsNotNone(self.events.waits_for(lambda m, kind=kind: m.kind == kind), kind)
        self.check_joints()
        self.check_diagnostics()

    def check_parameters_arrive(self, first, second):
        self.assertGreater(second[1] - first[1], 40)  # accepted in three seconds or more; 60 a second are sent
        self.assertEqual((second[0] - first[0]) % 65536, second[1] - first[1])
        self.assertEqual(second[2], 0)

    def check_force(self):
        """While it presses, the motor makes the force that the simulator computes."""
        pressed = [m for m in self.parameters.messages if m.touching][-1]
        self.assertLess(pressed.joint_effort[0], -0.05)
        self.assertAlmostEqual(self.haptic.messages[-1].effort[0], pressed.joint_effort[0], delta=0.03)

    def check_joints(self):
        """The simulator has followed the devices, and these the script, as far as friction and tissue let them."""
        applied = [m.joints for m in self.applied.messages]
        deepest = max(joints[0] for joints in applied)
        self.assertAlmostEqual(deepest, 0.078, delta=0.002)
        self.assertAlmostEqual(max(joints[1] for joints in applied), 0.3, delta=0.01)
        self.assertAlmostEqual(max(joints[2] for joints in applied), 0.2, delta=1e-3)
        # moves at 10 mm/s while a button is held, in wall time: 0.1 s may go astray on a busy machine
        self.assertAlmostEqual(applied[-1][4], 5e-3, delta=1e-3)
        measured = {round(message.position[0], 9) for message in self.scope.messages}
        followed = [round(joints[0], 9) in measured for joints in applied if joints[0] > 0]
        self.assertGreater(len(followed), 100)
        self.assertGreater(sum(followed), 0.99 * len(followed))

    def check_diagnostics(self):
        for name in ("haptic device", "input device"):
            _, _, values = Diagnostics(self.diagnostics, name).waits_for_newer(time.time())
            for key in ("lost reports", "duplicated reports", "malformed reports", "reconnects"):
                self.assertEqual(values[key], "0", name + ": " + key)
            self.assertGreater(int(values["received reports"]), 300)


if __name__ == "__main__":
    rospy.init_node("session_test")
    rostest.rosrun("vibe_hardware", "session", SessionTest, sys.argv)
