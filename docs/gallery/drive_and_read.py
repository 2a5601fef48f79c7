#!/usr/bin/env python3
"""Pushes the scope forward until the wall pushes back with half a newton."""
import rospy
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState


def react(message):  # 60 times a second: the wrench of the tissue on the tool, in the frame of the tip
    global insertion
    force = -message.wrench.force.x  # x looks forward [N]
    insertion += 0.0005  # 30 mm/s
    command.publish(JointState(position=[insertion, 0, 0, 0]))  # [m], rotation, tip up/down, tip left/right [rad]
    if force > 0.5:
        print("{:.0f} mm deep, {:.2f} N".format(1e3 * insertion, force))
        rospy.signal_shutdown("reached")


rospy.init_node("drive_and_read")
insertion = 0.0  # [m]
command = rospy.Publisher("scope/servo_jp", JointState, queue_size=1)
rospy.Subscriber("scope/measured_cf", WrenchStamped, react)
rospy.spin()
