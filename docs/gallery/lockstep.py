#!/usr/bin/env python3
"""Presses the tip on the wall with 0.3 N, by one decision per step of a simulator that waits for it: lockstep.py SECONDS"""
import sys
import time

import rospy
from sensor_msgs.msg import JointState, Joy
from std_msgs.msg import Header
from vibe_msgs.msg import StepResult

WANTED = 0.3  # [N]
GAIN = 0.1  # speed of insertion per newton that is lacking [m/s/N]
STEP = 1 / 60  # that of the scene [s]
SCOPE = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
DEVICE = ["helix_advance", "helix_rotation", "needle_driver"]

rospy.init_node("lockstep")
outputs = [rospy.Publisher(topic, kind, queue_size=1) for topic, kind in (
    ("scope/input/joint_states", JointState), ("suturing_device/input/joint_states", JointState), ("scope/buttons", Joy))]
inputs = []


def send():
    for output, message in zip(outputs, inputs):
        output.publish(message)


def decide(result):  # after every step: the results of this one go in, the inputs of the next come out
    force = -result.wrench.force.x  # [N]
    joints = list(result.joints)
    joints[0] += GAIN * (WANTED - force) * STEP
    header = Header(stamp=result.header.stamp)  # the end of this step is the start of the next
    inputs[:] = (JointState(header=header, name=SCOPE, position=joints[:4]),
                 JointState(header=header, name=DEVICE, position=joints[4:]),
                 Joy(header=header, buttons=[0] * 6))
    if result.time < float(sys.argv[1]):
        send()
    elif not rospy.is_shutdown():
        print("{:.1f} s: {:.4f} N at {:.3f} mm".format(result.time, force, 1e3 * joints[0]))
        rospy.signal_shutdown("done")


rospy.Subscriber("step_result", StepResult, decide)
while not rospy.is_shutdown():  # inputs that were sent before the simulator listened are sent again
    time.sleep(0.5)
    send()
