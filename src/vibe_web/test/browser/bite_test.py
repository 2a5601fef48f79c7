#!/usr/bin/env python3
"""A page drives a whole bite, with a simulator of its own."""

import sys
import unittest

import rospy
import rostest
from vibe_msgs.msg import ProcedureEvent
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder
from web_test import port_of

PATIENCE = 500  # on a machine that computes slowly [s]


class Bite(unittest.TestCase):
    def test_a_page_takes_a_whole_bite(self):
        events = Recorder("/procedure/events", ProcedureEvent)
        simulator = Program(
            "vibe_sim", "sim_node", name="sim_node", scene="package://vibe_core/scenes/stomach.yaml", time_source="wall"
        )
        self.addCleanup(simulator.stop)
        server = Program("vibe_web", "web_node", name="web_node", port=0)
        self.addCleanup(server.stop)
        page = Program("vibe_web", "page_bite", str(port_of(server)))
        self.addCleanup(page.stop)
        self.assertEqual(page.ends(PATIENCE), 0, page.output() + server.last_words())
        print(page.output())
        self.assertTrue(events.waits_for(lambda event: event.kind == ProcedureEvent.RELEASE))
        for kind in (ProcedureEvent.GRAB, ProcedureEvent.BITE, ProcedureEvent.RELEASE):
            self.assertEqual(len([event for event in events.messages if event.kind == kind]), 1)
        self.assertFalse([event.text for event in events.messages if event.kind == ProcedureEvent.REJECTED])


if __name__ == "__main__":
    rospy.init_node("bite_test")
    rostest.rosrun("vibe_web", "bite", Bite, sys.argv)
