#!/usr/bin/env python3
"""Measures the time from the middle of an exposure to the datagram, stage by stage.

Starts a ROS master, a GigE Vision camera in software (or uses the camera that is given) and vision_node, receives the
datagrams, writes a table with one row per frame and prints quantiles. Run it on an idle computer, in a sourced
workspace: the stages are waiting for the scheduler on a busy one.
"""

import argparse
import csv
import os
import socket
import struct
import tempfile
import time

from vibe_bringup.graph import Graph
from vibe_sessions.whole_file import open_whole

HEADER = struct.Struct("<4sHBxIfQdff")
STAGES = ["half_exposure", "transport", "wait", "track", "predict_and_send"]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", help="CSV to write")
    parser.add_argument("--camera", help="address of a camera, with --config (default: a simulated GigE camera)")
    parser.add_argument("--config", help="configuration of the camera's rig")
    parser.add_argument("--scene", default="moving", help="of the simulated camera")
    parser.add_argument("--frames", type=int, default=1000, help="to measure")
    arguments = parser.parse_args()
    if bool(arguments.camera) != bool(arguments.config):
        parser.error("--camera and --config go together")
    return arguments


def wait_for(condition, seconds, what):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit("measure_latency: no {} within {:.0f} s".format(what, seconds))
        time.sleep(0.05)


def start_camera(graph, arguments, folder):
    """Address and configuration of the camera."""
    if arguments.camera:
        return arguments.camera, arguments.config
    config = os.path.join(folder, "rig.yaml")
    graph.start("camera", ["rosrun", "vibe_vision", "vibe_fake_camera", "--scene", arguments.scene, "--config", config])
    wait_for(lambda: os.path.exists(config), 120, "simulated camera")
    return "gige:127.0.0.1", config


def record(graph, arguments, folder):
    """{frame: (exposure, age)} of the datagrams, and {frame: message} of suturing_device/tracking."""
    import rospy
    from vibe_msgs.msg import InstrumentTrackArray

    source, config = start_camera(graph, arguments, folder)
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(10)
    for name, value in (("config", config), ("source", source), ("udp", "127.0.0.1:%d" % receiver.getsockname()[1])):
        graph.set_parameter("/vision_node/" + name, value)
    graph.start("vision_node", ["rosrun", "vibe_vision", "vision_node"])
    os.environ.update(graph.env)
    rospy.init_node("measure_latency", anonymous=True, disable_signals=True)
    tracks, ages = {}, {}
    rospy.Subscriber("suturing_device/tracking", InstrumentTrackArray, lambda m: tracks.setdefault(m.frame_sequence, m))
    wait_for(lambda: tracks, 30, "frame")
    while len(ages) < arguments.frames:
        _, _, _, _, exposure, frame, _, age, _ = HEADER.unpack_from(receiver.recv(2048))
        if exposure > 0:  # else: there was no frame
            ages[frame] = exposure, age
    time.sleep(0.5)
    rospy.signal_shutdown("measured")
    return ages, tracks


def rows_of(ages, tracks):
    for frame in sorted(ages):
        exposure, age = ages[frame]
        track = tracks.get(frame)
        if track is None or track.exposure == 0:
            continue
        known = track.transport + track.wait + track.track
        stages = [exposure / 2, track.transport - exposure / 2, track.wait, track.track, age - known]
        yield [frame] + ["%.7f" % stage for stage in stages]


def main():
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory(prefix="vibe_latency_") as folder:
        graph = Graph(folder)
        try:
            graph.start_master()
            rows = list(rows_of(*record(graph, arguments, folder)))
        finally:
            graph.stop_all()
    with open_whole(arguments.table, newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["frame"] + STAGES)
        writer.writerows(rows)
    for i, stage in enumerate(STAGES + ["total"], 1):
        values = sorted(float(row[i]) if i < len(row) else sum(map(float, row[1:])) for row in rows)
        low, median, high = (1e3 * values[int(share * (len(values) - 1))] for share in (0, 0.5, 0.99))
        print("{:18s} min {:7.3f}  median {:7.3f}  p99 {:7.3f} ms".format(stage.replace("_", " "), low, median, high))
    print("{} frames; load of the computer {:.1f}".format(len(rows), os.getloadavg()[0]))


if __name__ == "__main__":
    main()
