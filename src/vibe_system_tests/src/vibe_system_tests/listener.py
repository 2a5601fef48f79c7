"""A node that hears topics: prints each with the time when its first message came (CLOCK_MONOTONIC, the same in all
processes).

Usage: python3 -m vibe_system_tests.listener NAME TOPIC...
"""

import json
import sys
import time

import rospy


def listen(name, topics):
    rospy.init_node(name)
    seen = set()

    def take(_, topic):
        if topic not in seen:
            seen.add(topic)
            print(topic, repr(time.monotonic()), flush=True)

    for topic in topics:
        rospy.Subscriber(topic, rospy.AnyMsg, take, topic)
    print("listens", json.dumps(topics), flush=True)
    rospy.spin()


if __name__ == "__main__":
    listen(sys.argv[1], sys.argv[2:])
