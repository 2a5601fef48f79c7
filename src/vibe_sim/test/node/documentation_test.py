#!/usr/bin/env python3
"""docs/interfaces.md lists exactly what a running simulator offers: topics and services with their types, parameters."""

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


def rows_of(text, section):
    """The first two columns of the table rows of a section that begin with a name in backquotes: {name: column 2}."""
    part = re.search(r"^## {}\n(.*?)(?=^##|\Z)".format(re.escape(section)), text, re.MULTILINE | re.DOTALL)
    if part is None:
        raise AssertionError("docs/interfaces.md has no section '{}'".format(section))
    rows = re.findall(r"^\| `([^`]+)` \| ([^|]*) \|", part.group(1), re.MULTILINE)
    if len(rows) != len(dict(rows)):
        raise AssertionError("section '{}' has two rows about the same name".format(section))
    return dict(rows)


def parameters_read_by(file):
    with open(os.path.join(NODE, file), encoding="utf-8") as code:
        return set(re.findall(r'reader\.(?:read|required)\("(\w+)"', code.read()))


class DocumentationTest(unittest.TestCase):
    """Comparisons of whole sets: what is missing on either side fails. The last test is the control of that."""

    maxDiff = None

    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("load_scene", 20)
        with open(os.path.realpath(DOCS), encoding="utf-8") as text:
            cls.text = text.read()
        cls.master = rosgraph.Master("/documentation")
        cls.published, cls.subscribed, _ = cls.master.getSystemState()

    def topics_of_node(self, registrations):
        types = dict(self.master.getTopicTypes())
        topics = {topic for topic, nodes in registrations if "/sim_node" in nodes} - NOT_OURS
        return {topic if topic == "/clock" else topic[1:]: types[topic] for topic in topics}

    def test_published_topics(self):
        running = self.topics_of_node(self.published)
        self.assertEqual(rows_of(self.text, "Published topics"), running)

    def test_subscribed_topics(self):
        running = self.topics_of_node(self.subscribed)
        running.pop("/clock", None)  # every node subscribes to it with use_sim_time
        self.assertEqual(rows_of(self.text, "Subscribed topics"), running)

    def test_services(self):
        services = [s for s in rosservice.get_service_list(node="/sim_node") if "logger" not in s]
        running = {service[1:]: rosservice.get_service_type(service) for service in services}
        self.assertEqual(rows_of(self.text, "Services"), running)

    def test_parameters(self):
        for section, file in (("sim_node", "simulator/parameters.cpp"),
                              ("vibe_trainee", "programs/vibe_trainee_main.cpp")):
            with self.subTest(section):
                self.assertEqual(set(rows_of(self.text, section)), parameters_read_by(file))

    def test_control_a_row_too_few_or_too_many_is_found(self):
        row = next(line for line in self.text.splitlines() if line.startswith("| `tissue/particles` |"))
        running = self.topics_of_node(self.published)
        for changed in ("", row + "\n" + row.replace("tissue/particles", "tissue/nothing")):
            self.assertNotEqual(rows_of(self.text.replace(row, changed), "Published topics"), running)


if __name__ == "__main__":
    rospy.init_node("documentation_test")
    rostest.rosrun("vibe_sim", "documentation_test", DocumentationTest, sys.argv)
