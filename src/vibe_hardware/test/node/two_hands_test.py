#!/usr/bin/env python3
"""A whole bite by two arms, each with a crtk_teleop: one at the scope, one at the suturing device."""

import os
import sys
import tempfile
import unittest

import rospy
import rostest
import yaml
from vibe_msgs.msg import ProcedureEvent
from vibe_testing.program import Program
from vibe_testing.recorder import Recorder

SHIPPED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "config", "arms")
PATIENCE = 500  # on a machine that computes slowly [s]
ARMS = (("left", "/MTML", "dvrk_left"), ("right", "/MTMR", "dvrk_right"))
MISTAKES = (ProcedureEvent.SLIP, ProcedureEvent.BITE_MISSED, ProcedureEvent.BITE_WITHDRAWN, ProcedureEvent.REJECTED)


def mapping_of(name, folder):
    """The shipped mapping, with an arm that may be silent for as long as a busy machine stands still."""
    with open(os.path.join(SHIPPED, name + ".yaml"), encoding="utf-8") as stream:
        mapping = yaml.safe_load(stream)
    mapping.setdefault("arm", {})["timeout"] = "2 s"
    path = os.path.join(folder, name + ".yaml")
    with open(path, "w", encoding="utf-8") as stream:
        yaml.safe_dump(mapping, stream)
    return path


class TwoHands(unittest.TestCase):
    def test_two_nodes_take_a_whole_bite(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        events = Recorder("/procedure/events", ProcedureEvent)
        self.assertTrue(events.waits_for_connection())
        nodes, arguments = {}, []
        for node, arm, mapping in ARMS:
            arguments += [arm, mapping_of(mapping, folder.name)]
            nodes[node] = Program("vibe_hardware", "crtk_teleop", name=node, arm=arm, mapping=arguments[-1])
            self.addCleanup(nodes[node].stop)
            self.assertTrue(nodes[node].says("waiting for"), nodes[node].output())
        person = Program("vibe_hardware", "two_hands", *arguments)
        self.addCleanup(person.stop)
        self.assertEqual(person.ends(PATIENCE), 0, person.output() + nodes["right"].last_words())
        print(person.output())
        happened = [event.kind for event in events.messages]
        for kind in (ProcedureEvent.GRAB, ProcedureEvent.BITE, ProcedureEvent.RELEASE):
            self.assertEqual(happened.count(kind), 1)
        self.assertFalse([kind for kind in happened if kind in MISTAKES])


if __name__ == "__main__":
    rospy.init_node("two_hands_test")
    rostest.rosrun("vibe_hardware", "two_hands", TwoHands, sys.argv)
