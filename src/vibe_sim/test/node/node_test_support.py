"""What the tests of the node share. The tests know the simulator only through its topics, services and exit status."""

import os

import rospy
from sensor_msgs.msg import JointState, Joy

EPOCH = 1_000_000_000  # stamp of step 0 [ns]
PERIOD = 1.0 / 60  # of balloon.yaml [s]
SCOPE_JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
SUTURING_DEVICE_JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]


def scene(name):
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes", name)


def stamp_of(step, origin=EPOCH, period=PERIOD):
    return origin + round(step * period * 1e9)


def joints(names, positions, stamp):
    message = JointState(name=list(names), position=list(positions))
    message.header.stamp = stamp
    return message


def buttons(pressed=(), stamp=None):
    message = Joy(buttons=[1 if i in pressed else 0 for i in range(6)])
    message.header.stamp = stamp or rospy.Time(0)
    return message


def state_hash(text):
    hashes = [line.split()[-1] for line in text.splitlines() if line.startswith("state hash: ")]
    return hashes[-1] if hashes else None
