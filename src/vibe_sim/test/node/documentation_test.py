#!/usr/bin/env python3
"""docs/interfaces.md lists what a running simulator offers: every topic with its type, every service, every parameter."""

import os
import re
import sys
import unittest

import rosgraph
import rospy
import rosservice
import rostest

DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../../docs/interfaces.md")
NODE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../node")
NOT_OURS = {"/rosout", "/rosout_agg", "/tf", "/tf_static"}  # known to every ROS user


class DocumentationTest(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("load_scene", 20)
        with open(os.path.realpath(DOCS)) as text:
            self.text = text.read()

    def table_row(self, name):
        # a parameter may have a topic's name; only topics and services have a type with a package in the second column
        rows = [line for line in self.text.splitlines() if line.startswith("| `{}` |".format(name))]
        rows = [line for line in rows if "/" in line.split("|")[2]]
        self.assertEqual(len(rows), 1, "rows about " + name)
        return rows[0]

    def test_every_topic_is_there_with_its_type(self):
        master = rosgraph.Master("/documentation")
        published, subscribed, _ = master.getSystemState()
        topics = {t for t, nodes in published + subscribed if "/sim_node" in nodes} - NOT_OURS
        types = dict(master.getTopicTypes())
        self.assertEqual(len(topics), 22, topics)
        for topic in topics:
            with self.subTest(topic=topic):
                name = topic if topic == "/clock" else topic[1:]
                self.assertIn("| " + types[topic] + " |", self.table_row(name))

    def test_every_service_is_there_with_its_type(self):
        services = [s for s in rosservice.get_service_list(node="/sim_node") if "logger" not in s]
        self.assertEqual(len(services), 6, services)
        for service in services:
            with self.subTest(service=service):
                self.assertIn("| " + rosservice.get_service_type(service) + " |", self.table_row(service[1:]))

    def test_every_parameter_is_there(self):
        names = set()
        for file in ("parameters.cpp", "vibe_trainee_main.cpp"):
            with open(os.path.join(NODE, file)) as code:
                names.update(re.findall(r'reader\.(?:read|required)\("(\w+)"', code.read()))
        self.assertEqual(len(names), 14, names)
        for name in names:
            self.assertTrue([l for l in self.text.splitlines() if l.startswith("| `{}` |".format(name))], name)


if __name__ == "__main__":
    rospy.init_node("documentation_test")
    rostest.rosrun("vibe_sim", "documentation_test", DocumentationTest, sys.argv)
