#!/usr/bin/env python3
"""A whole bite by two arms, each with a crtk_teleop: one at the scope, one at the suturing device; and a hand-over."""

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
from vibe_testing.wait import wait_until

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
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def begin(self):
        """@return a person with two arms, and their nodes"""
        nodes, arguments = [], []
        for node, arm, mapping in ARMS:
            arguments += [arm, mapping_of(mapping, self.folder.name)]
            nodes.append(Program("vibe_hardware", "crtk_teleop", name=node, arm=arm, mapping=arguments[-1]))
            self.addCleanup(nodes[-1].stop)
            self.assertTrue(nodes[-1].says("waiting for"), nodes[-1].output())
        person = Program("vibe_hardware", "two_hands", *arguments, name="person")
        self.addCleanup(person.stop)
        return person, nodes

    def test_two_nodes_take_a_whole_bite_after_others_have_died_in_mid_bite(self):
        events = Recorder("/procedure/events", ProcedureEvent)
        self.assertTrue(events.waits_for_connection())
        first, first_nodes = self.begin()
        wound = lambda: any(event.kind == ProcedureEvent.HELIX_TURNED for event in events.messages)
        self.assertTrue(wait_until(wound, PATIENCE), first.output())
        for program in (first, *first_nodes):
            program.process.kill()
        released = lambda: [event.kind for event in events.messages].count(ProcedureEvent.RELEASE) > 0
        self.assertTrue(wait_until(released, PATIENCE), "the wall was not let go")
        person, nodes = self.begin()
        self.assertEqual(person.ends(PATIENCE), 0, person.output() + nodes[-1].last_words())
        print(person.output())
        happened = [event.kind for event in events.messages]
        for kind, count in ((ProcedureEvent.GRAB, 2), (ProcedureEvent.BITE, 1), (ProcedureEvent.RELEASE, 2)):
            self.assertEqual(happened.count(kind), count)
        self.assertFalse([kind for kind in happened if kind in MISTAKES])


if __name__ == "__main__":
    rospy.init_node("two_hands_test")
    rostest.rosrun("vibe_hardware", "two_hands", TwoHands, sys.argv)
