"""A simulator whose scope does the same motion again and again, and a web_node beside it."""

import math
import sys
import time

import rospy
from sensor_msgs.msg import JointState
from vibe_msgs.srv import Snapshot
from vibe_testing.program import Program
from vibe_testing.wait import wait_until

SECONDS = 15  # of the motion


class MovingScope:
    """@param snapshot  state to begin with"""

    def __init__(self, port, snapshot=None, **parameters):
        scene = "package://vibe_core/scenes/stomach.yaml"
        self.simulator = Program("vibe_sim", "sim_node", name="sim_node", scene=scene, time_source="wall", **parameters)
        self.server = Program("vibe_web", "web_node", name="web_node", port=port)
        if not wait_until(lambda: "http" in self.server.output()):
            sys.exit("web_node has not started: " + self.server.last_words())
        self.command = rospy.Publisher("scope/servo_jp", JointState, queue_size=1)
        if snapshot:
            rospy.wait_for_service("load_snapshot", 30)
            answer = rospy.ServiceProxy("load_snapshot", Snapshot)(file=snapshot)
            if not answer.success:
                sys.exit("The snapshot cannot be loaded: " + answer.message)

    def move(self, seconds):
        """To where the scope is at this time of the motion."""
        turn = 2 * math.pi * seconds / SECONDS
        self.command.publish(
            JointState(position=[0.10 - 0.06 * math.cos(turn), 0, 0.5 * math.sin(turn), 0.3 * math.sin(2 * turn)])
        )

    def move_for(self, seconds):
        begin = time.monotonic()
        while time.monotonic() < begin + seconds:
            self.move(time.monotonic() - begin)
            time.sleep(1 / 60)

    def stop(self):
        self.server.stop()
        self.simulator.stop()
