"""Messages of tissue and sutures to show, and to spoil."""

import numpy
import rospy
from geometry_msgs.msg import Point
from sensor_msgs.msg import PointCloud2, PointField
from vibe_msgs.msg import Bite, Suture, SutureArray, TissueTopology

POINT = numpy.dtype(
    {
        "names": ["x", "y", "z", "strain", "id", "revision", "region"],
        "formats": ["<f4", "<f4", "<f4", "<f4", "<u4", "<u4", "u1"],
        "offsets": [0, 4, 8, 12, 16, 20, 24],
        "itemsize": 28,
    }
)


def ball(rows, around):
    """Vertices of a ball of 8 cm, poles first and last, and its triangles, seen from outside."""
    polar, azimuth = numpy.meshgrid(
        numpy.pi * numpy.arange(1, rows + 1) / (rows + 1), 2 * numpy.pi * numpy.arange(around) / around, indexing="ij"
    )
    middle = numpy.stack([numpy.sin(polar) * numpy.cos(azimuth), numpy.sin(polar) * numpy.sin(azimuth)], axis=-1)
    middle = numpy.concatenate([middle, numpy.cos(polar)[..., None]], axis=-1).reshape(-1, 3)
    vertices = 0.08 * numpy.vstack([[0, 0, 1], middle, [0, 0, -1]])
    a = numpy.arange(around)
    b = (a + 1) % around
    last, bottom = rows * around + 1, (rows - 1) * around
    upper = 1 + around * numpy.arange(rows - 1)[:, None]
    lower = upper + around
    triangles = [
        numpy.stack([0 * a, 1 + a, 1 + b], axis=-1),
        numpy.stack([0 * a + last, 1 + bottom + b, 1 + bottom + a], axis=-1),
        numpy.stack([upper + a, lower + a, lower + b], axis=-1).reshape(-1, 3),
        numpy.stack([upper + a, lower + b, upper + b], axis=-1).reshape(-1, 3),
    ]
    return vertices, numpy.vstack(triangles)


def topology(rows=40, around=30, revision=1):
    vertices, triangles = ball(rows, around)
    message = TissueTopology(revision=revision, name="ball")
    message.header.frame_id, message.header.stamp = "stomach", rospy.Time.now()
    message.rest_positions = vertices.ravel().tolist()
    message.triangles = triangles.ravel().tolist()
    return message


def particles(rows=40, around=30, revision=1, change=None):
    """`change` may alter the records before they are packed."""
    vertices, _ = ball(rows, around)
    points = numpy.zeros(len(vertices), POINT)
    points["x"], points["y"], points["z"] = vertices.T
    points["id"], points["revision"] = numpy.arange(len(points)), revision
    if change is not None:
        change(points)
    message = PointCloud2(height=1, width=len(points), point_step=POINT.itemsize, data=points.tobytes())
    message.header.frame_id, message.header.stamp = "stomach", rospy.Time.now()
    message.row_step = message.point_step * message.width
    kinds = {"<f4": PointField.FLOAT32, "<u4": PointField.UINT32, "|u1": PointField.UINT8}
    for name in POINT.names:
        kind, offset = POINT.fields[name][:2]
        message.fields.append(PointField(name, offset, kinds[kind.str], 1))
    return message


def sutures():
    """One set of three bites with slack thread."""
    message = SutureArray()
    message.header.frame_id, message.header.stamp = "world", rospy.Time.now()
    suture = Suture(stage=Suture.TAGGED, technique_name="other", transitions=[-1, -1])
    for k in range(3):
        place = Point(0.02 * k, 0.07, 0.0)
        suture.bites.append(Bite(position=place, full_thickness=True, thickness=0.004, depth=0.004))
        suture.thread.append(place)
        suture.thread_offsets.append(k)
    suture.length, suture.tension = [0.03, 0.03], [0.0, 1.0]
    suture.taken = suture.thread
    message.sutures.append(suture)
    return message
