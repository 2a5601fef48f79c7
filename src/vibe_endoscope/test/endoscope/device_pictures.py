#!/usr/bin/env python3
"""Draws the pictures of docs/device.md with endoscope_camera: the device through the lens, and from outside.

Usage, with a ROS master running: device_pictures.py FOLDER
"""

import os
import sys
import time

HERE = os.path.dirname(os.path.realpath(__file__))
PACKAGES = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
sys.path[:0] = [HERE, os.path.join(PACKAGES, "vibe_description", "test")]

import ball
import numpy
import rospy
import tf2_msgs.msg
from endoscope_camera_test import Camera, pixels_of
from geometry_msgs.msg import TransformStamped
from PIL import Image
from scipy.spatial.transform import Rotation
from scope_pose import Scope, pose
from sensor_msgs.msg import PointCloud2
from vibe_msgs.msg import TissueTopology
from vibe_testing.wait import wait_until

HELD = {"needle_slide": 0.018, "needle_draw": 0.0012, "needle_turn": 0.4189}  # the needle in the anchor exchange
HELIX = {"helix_advance": 0.018, "helix_rotation": 2.0}
PROBE = {"argon_probe": 0.010}
OUTSIDE_EXPOSURE = 1.0  # for the steel near the lamp; the automatic one is for the wall behind it
# way of the needle [m], other joints
LENS = [(0, {}), (0.012, {}), (0.018, {}), (0, HELD), (0, HELIX), (0, PROBE)]
# the same, where the camera is and what it looks at from scope_tip, radius of the ball [m]
OUTSIDE = [
    (0, {"helix_advance": 0.006}, ((0.055, -0.022, 0.022), (0.002, 0, 0.0035)), 0.09),
    (0.008, {}, ((0.030, -0.05, 0.02), (0.002, 0, 0.003)), 0.09),
    (0.018, {}, ((0.030, -0.05, 0.02), (0.002, 0, 0.001)), 0.09),
    (0, HELD, ((0.030, -0.05, 0.02), (0.004, 0, 0.003)), 0.09),
    (0, PROBE, ((0.035, 0.045, 0.025), (0.002, 0, 0.003)), 0.09),
    (0, {"helix_advance": 0.01, "tip_up_down": 1.6}, ((0.03, -0.095, 0.025), (-0.012, 0, 0.012)), 0.14),
]


def looking(eye, target):
    """Optical frame at `eye`: z to the target, y down."""
    ahead = numpy.subtract(target, eye)
    ahead /= numpy.linalg.norm(ahead)
    right = numpy.cross(ahead, (0, 0, 1))
    right /= numpy.linalg.norm(right)
    return pose(eye, numpy.column_stack([right, numpy.cross(ahead, right), ahead]))


def transform(name, placed, stamp):
    message = TransformStamped(child_frame_id=name)
    message.header.stamp, message.header.frame_id = stamp, ball.FRAME
    message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = placed[:3, 3]
    rotation = message.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = Rotation.from_matrix(placed[:3, :3]).as_quat()
    return message


class Studio:
    def __init__(self):
        with open(os.path.join(PACKAGES, "vibe_description", "urdf", "scope.urdf"), encoding="utf-8") as file:
            urdf = file.read()
        rospy.set_param("/robot_description", urdf)
        self.scope = Scope(urdf)
        self.topology = rospy.Publisher("tissue/topology", TissueTopology, queue_size=1, latch=True)
        self.particles = rospy.Publisher("tissue/particles", PointCloud2, queue_size=5)
        self.tf = rospy.Publisher("/tf", tf2_msgs.msg.TFMessage, queue_size=100)
        self.clock = rospy.Time.now() - rospy.Duration(1000)

    def listeners(self):
        return [publisher.get_num_connections() for publisher in (self.topology, self.particles, self.tf)]

    def shoot(self, way, joints, camera=None, radius=0.05):
        """A picture from the lens, or from outside with a camera."""
        joints = {**self.scope.arm(way), **joints}
        ball.RADIUS, ball.REVISION = radius, ball.REVISION + 1
        tissue = ball.Ball(4)
        options = {"rate": 0, "width": 640, "height": 640}
        if camera:
            options.update(lens="rectilinear", field_of_view=44, camera_frame="outside", width=900, height=900)
            options.update(auto_exposure=False, exposure=OUTSIDE_EXPOSURE)
        with Camera(**options) as program:
            assert wait_until(lambda: min(self.listeners()) > 0)
            self.clock += rospy.Duration(1)
            self.topology.publish(tissue.topology(self.clock))
            time.sleep(0.3)
            poses = self.scope.poses(joints, pose((0, 0, 0) if camera else (-0.02, 0, 0)))
            if camera:
                poses["outside"] = looking(*camera)
            self.tf.publish(tf2_msgs.msg.TFMessage([transform(n, p, self.clock) for n, p in poses.items()]))
            time.sleep(0.3)  # a part whose pose comes later than the camera's is not drawn
            self.particles.publish(tissue.particles(self.clock))
            image, _ = program.last(self.clock)
        wait_until(lambda: max(self.listeners()) == 0)
        return Image.fromarray(pixels_of(image).astype("uint8"))


def save(pictures, columns, path):
    """Pictures of one size side by side, in 256 colours."""
    width, height = pictures[0].size
    sheet = Image.new("RGB", (columns * width, -(-len(pictures) // columns) * height))
    for k, picture in enumerate(pictures):
        sheet.paste(picture, (k % columns * width, k // columns * height))
    sheet.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=3).save(path, optimize=True)


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit("device_pictures.py: name one folder for the pictures, which must exist.")
    folder = sys.argv[1]
    rospy.init_node("device_pictures")
    studio = Studio()
    save([studio.shoot(*view).resize((400, 400)) for view in LENS], 3, os.path.join(folder, "device_lens.png"))
    outside = [studio.shoot(*view).crop((20, 130, 880, 770)).resize((600, 447)) for view in OUTSIDE]
    save(outside, 2, os.path.join(folder, "device_outside.png"))


if __name__ == "__main__":
    main()
