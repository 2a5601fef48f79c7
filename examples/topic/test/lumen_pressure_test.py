#!/usr/bin/env python3
"""lumen_pressure with states as the simulator sends them: pressure, stamp, and nothing without a state."""

import queue
import unittest

import rospy
import rostest
from sensor_msgs.msg import FluidPressure
from vibe_msgs.msg import ProcedureState


class LumenPressure(unittest.TestCase):
    def test_pressure_is_absolute_and_has_the_stamp_of_the_state(self):
        received = queue.Queue()
        rospy.Subscriber("lumen/pressure", FluidPressure, received.put)
        with self.assertRaises(queue.Empty):  # control: what arrives below is the answer to a state
            received.get(timeout=1)
        states = rospy.Publisher("procedure/state", ProcedureState, queue_size=10, latch=True)
        for seconds, gauge in ((3, 1333.2), (4, 0.0), (5, 2000.0)):
            state = ProcedureState(pressure=gauge)
            state.header.stamp = rospy.Time(seconds, 500)
            states.publish(state)
            message = received.get(timeout=20)
            self.assertEqual(message.header.stamp, rospy.Time(seconds, 500))
            self.assertAlmostEqual(message.fluid_pressure, 100000 + gauge, places=6)


if __name__ == "__main__":
    rospy.init_node("lumen_pressure_test")
    rostest.rosrun("vibe_example_topic", "lumen_pressure", LumenPressure)
