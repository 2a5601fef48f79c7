#!/usr/bin/env python3
"""Presses no button, ten times a second, as a scripted trainee does."""
import rospy
from sensor_msgs.msg import Joy

rospy.init_node("rival")
publisher = rospy.Publisher("scope/buttons", Joy, queue_size=10)
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    message = Joy(buttons=[0] * 6)
    message.header.stamp = rospy.Time.now()
    publisher.publish(message)
    try:
        rate.sleep()
    except rospy.ROSInterruptException:
        break
