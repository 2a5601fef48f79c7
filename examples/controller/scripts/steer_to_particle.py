#!/usr/bin/env python3
"""Steers the scope until it looks at a particle of the wall from 15 mm: steer_to_particle.py _particle:=1200"""
import numpy
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Float64MultiArray

STANDOFF = 0.015  # [m]
GAIN = 1.0  # [1/s]
DAMPING = 0.01  # of the inverse [m]: bounds the joints where the scope cannot go [m]
LIMITS = numpy.array([0.02, 0.3, 0.3, 0.3])  # of the joints' speeds [m/s], [rad/s]
newest = {}


def listen(topic, kind):
    rospy.Subscriber(topic, kind, lambda message: newest.update({topic: message}), queue_size=1)


def vector(point):
    return numpy.array([point.x, point.y, point.z])


def speed_of_joints(particle):
    """Damped least squares: dq/dt = J^T (J J^T + d^2)^-1 v, and the distance that is left [m]."""
    way = particle - vector(newest["scope/measured_cp"].pose.position)
    left = way * (1 - STANDOFF / numpy.linalg.norm(way))
    jacobian = numpy.array(newest["scope/jacobian"].data).reshape(6, 4)[:3]
    speed = jacobian.T @ numpy.linalg.solve(jacobian @ jacobian.T + DAMPING**2 * numpy.eye(3), GAIN * left)
    return speed / max(1, numpy.max(abs(speed) / LIMITS)), numpy.linalg.norm(left)


rospy.init_node("steer_to_particle")
number = rospy.get_param("~particle")
for name, kind in {"scope/measured_cp": PoseStamped, "scope/jacobian": Float64MultiArray,
                   "scope/setpoint_js": JointState, "tissue/particles": PointCloud2}.items():
    listen(name, kind)
command = rospy.Publisher("scope/servo_jp", JointState, queue_size=1)
rate, left = rospy.Rate(60), 1.0
while not rospy.is_shutdown() and left > 0.001:
    rate.sleep()
    if len(newest) < 4:
        continue
    wall = next(point_cloud2.read_points(newest["tissue/particles"], ("x", "y", "z"), uvs=[(number, 0)]))
    speed, left = speed_of_joints(numpy.array(wall))
    command.publish(JointState(position=newest["scope/setpoint_js"].position + speed / 60))
    rospy.loginfo_throttle(1, "%.1f mm left", 1e3 * left)
