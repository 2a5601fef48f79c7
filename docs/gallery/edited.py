#!/usr/bin/env python3
"""Repeats a recording, then one in which one command was changed by a micrometre: edited.py RECORDING.bag COPY.bag"""
import subprocess
import sys

import rosbag

recording, copy = sys.argv[1:]
with rosbag.Bag(recording) as source, rosbag.Bag(copy, "w") as target:
    for topic, message, time in source.read_messages():
        if topic.endswith("applied_input") and message.step == 60:
            message.joints = [message.joints[0] + 1e-6, *message.joints[1:]]
        target.write(topic, message, time)
for bag in (recording, copy):
    replay = subprocess.run(["rosrun", "vibe_sim", "vibe_replay", bag], capture_output=True, text=True, check=False)
    print("status {}: {}".format(replay.returncode, replay.stdout.strip().splitlines()[-1]))
