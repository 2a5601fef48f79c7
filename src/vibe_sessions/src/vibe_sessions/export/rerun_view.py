#!/usr/bin/env python3
"""Shows session.mcap, which lies beside this file, in Rerun: the organ, the scope, forces, threads, pictures, events.

It needs no ROS:  pip install rerun-sdk mcap-ros2-support;  python3 rerun_view.py [--save session.rrd]
Lengths are in metres, forces in newtons (an arrow of 1 cm is 1 N); the frame is that of the scope's poses.
"""

import argparse
import pathlib

import numpy
import rerun
import rerun.blueprint as layout
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

ARROW = 0.01  # of a force [m/N]
SEEN = 80  # of 255: opacity of the wall, so that the scope and the threads within are seen
STRAIN = 0.5  # with the darkest colour (ratio)
WALL, STRAINED = numpy.array([214, 143, 134]), numpy.array([90, 0, 90])
TUBE = {"lengths": 0.06, "radii": 0.006, "translations": [-0.06, 0, 0], "quaternions": rerun.Quaternion(xyzw=[0, 0.5**0.5, 0, 0.5**0.5])}
FIRST = ("tissue/topology", "tf_static")  # what others need
ENDINGS = ("tissue/particles", "scope/measured_cp", "scope/measured_cf", "sutures", "procedure/events", "procedure/state",
           "endoscope/image_raw")


def points_of(cloud):
    """The fields of a sensor_msgs/PointCloud2 as a structured array."""
    kinds = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 8: "<f8"}
    names, offsets = [field.name for field in cloud.fields], [field.offset for field in cloud.fields]
    formats = [(kinds[field.datatype], field.count) if field.count > 1 else kinds[field.datatype] for field in cloud.fields]
    kind = numpy.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": cloud.point_step})
    return numpy.frombuffer(bytes(cloud.data), kind)


def normals_of(positions, triangles):
    """Outward normals of the vertices, weighted by area (Rerun shades with them)."""
    a, b, c = (positions[triangles[:, corner]] for corner in range(3))
    normals = numpy.zeros_like(positions)
    for corner in range(3):
        numpy.add.at(normals, triangles[:, corner], numpy.cross(b - a, c - a))
    return normals / numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


def triple(vector):
    return [vector.x, vector.y, vector.z]


class Session:
    """What a topic's message draws is the method with the last part of the topic's name."""

    def __init__(self):
        self._triangles, self._frames = {}, {}

    def topology(self, message):
        self._triangles[message.revision] = numpy.array(message.triangles).reshape(-1, 3)

    def tf_static(self, message):
        for part in message.transforms:
            self._frames[part.child_frame_id] = part.transform

    def particles(self, message):
        points = points_of(message)
        triangles, frame = self._triangles[int(points["revision"][0])], self._frames.get(message.header.frame_id)
        if frame:
            self._pose("world/organ", frame.translation, frame.rotation)
        share = numpy.clip(points["strain"] / STRAIN, 0, 1)[:, None]
        positions = numpy.stack([points[name] for name in "xyz"], axis=1)
        colors = (WALL + share * (STRAINED - WALL)).astype(numpy.uint8)
        rerun.log("world/organ/wall", rerun.Mesh3D(vertex_positions=positions, triangle_indices=triangles, vertex_colors=colors,
                                                   vertex_normals=normals_of(positions, triangles), albedo_factor=[255, 255, 255, SEEN]))

    def _pose(self, name, translation, rotation):
        quaternion = rerun.Quaternion(xyzw=[*triple(rotation), rotation.w])
        rerun.log(name, rerun.Transform3D(translation=triple(translation), quaternion=quaternion))

    def measured_cp(self, message):
        self._pose("world/scope_tip", message.pose.position, message.pose.orientation)
        rerun.log("world/scope_tip/shaft", rerun.Capsules3D(**TUBE, colors=[60, 60, 70]))

    def measured_cf(self, message):
        force = triple(message.wrench.force)
        rerun.log("world/scope_tip/force", rerun.Arrows3D(vectors=[numpy.array(force) * ARROW], colors=[255, 200, 0]))
        rerun.log("force", rerun.Scalars([*force, float(numpy.linalg.norm(force))]))

    def sutures(self, message):
        lines = [[triple(point) for point in suture.thread] for suture in message.sutures]
        rerun.log("world/threads", rerun.LineStrips3D(lines, radii=0.0006, colors=[40, 120, 255]))
        rerun.log("world/bites", rerun.Points3D([triple(bite.position) for suture in message.sutures for bite in suture.bites],
                                                radii=0.0015, colors=[20, 60, 160]))
        rerun.log("tension", rerun.Scalars([max(suture.tension, default=0.0) for suture in message.sutures] or [0.0]))

    def events(self, message):
        rerun.log("events", rerun.TextLog(message.text))

    def state(self, message):
        rerun.log("phase", rerun.StateChange(state=str(message.phase)))

    def image_raw(self, message):
        models = {"rgb8": "RGB", "bgr8": "BGR", "rgba8": "RGBA", "bgra8": "BGRA", "mono8": "L"}
        if message.encoding in models:
            rows = numpy.frombuffer(bytes(message.data), numpy.uint8).reshape(message.height, message.step)
            channels = len(models[message.encoding])
            pixels = rows[:, : message.width * channels].reshape(message.height, message.width, channels)
            rerun.log("picture", rerun.Image(pixels, color_model=models[message.encoding]))


def views(pictures):
    plots = [layout.TimeSeriesView(origin="force", name="Force on the tool: x, y, z in scope_tip, size [N]"),
             layout.TimeSeriesView(origin="tension", name="Largest tension of each thread [N]")]
    left = layout.Vertical(layout.Spatial3DView(origin="world", name="Organ, scope, forces, threads"), layout.TextLogView(origin="events"),
                           row_shares=[3, 1])
    right = layout.Vertical(*([layout.Spatial2DView(origin="picture", name="Picture")] if pictures else []), *plots)
    return layout.Blueprint(layout.Horizontal(left, right, column_shares=[3, 2]), collapse_panels=True)


def show(messages, blueprint, save):
    rerun.init("vibe", spawn=not save)
    if save:
        rerun.save(save)
    rerun.send_blueprint(blueprint)
    rerun.log("world", rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    rerun.log("force", rerun.SeriesLines(names=["x", "y", "z", "size"]), static=True)
    session = Session()
    for _, channel, message, content in messages:
        rerun.set_time("time", duration=message.publish_time * 1e-9)
        getattr(session, channel.topic.rpartition("/")[2])(content)


def main():
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--save", metavar="FILE", help="write a file that Rerun opens, and open no window")
    save = options.parse_args().save
    recording = pathlib.Path(__file__).with_name("session.mcap")
    with open(recording, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        topics = [channel.topic for channel in reader.get_summary().channels.values()]
        messages = (
            message
            for endings in (FIRST, ENDINGS)
            for message in reader.iter_decoded_messages([topic for topic in topics if topic.endswith(endings)])
        )
        show(messages, views(any(topic.endswith("image_raw") for topic in topics)), save)


if __name__ == "__main__":
    main()
