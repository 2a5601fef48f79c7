#!/usr/bin/env python3
"""Writes and draws the force on the tool of a running session, with its events: forces.py SECONDS FILE.csv PICTURE.png"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import rospy
from geometry_msgs.msg import WrenchStamped
from vibe_msgs.msg import ProcedureEvent

rows, events = [], []


def keep(message):  # of the tissue on the tool, about scope_tip and in its axes; exactly 0 without contact
    force, torque = message.wrench.force, message.wrench.torque
    rows.append((message.header.stamp.to_sec(), force.x, force.y, force.z, torque.x, torque.y, torque.z))


rospy.init_node("forces", anonymous=True)
rospy.Subscriber("scope/measured_cf", WrenchStamped, keep)
rospy.Subscriber("procedure/events", ProcedureEvent, lambda message: events.append(message.text))
rospy.sleep(float(sys.argv[1]))
samples = list(rows)  # messages still come
with open(sys.argv[2], "w", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(("time", "fx", "fy", "fz", "tx", "ty", "tz"))  # [s], [N], [N m]
    writer.writerows(samples)
forces = [(fx**2 + fy**2 + fz**2) ** 0.5 for _, fx, fy, fz, *_ in samples]
print("{} samples, {:.2f} N at most".format(len(samples), max(forces)))
print("\n".join(events))
plt.figure(figsize=(4.8, 3.2), layout="constrained")
plt.plot([row[0] - samples[0][0] for row in samples], forces)
plt.xlabel("time [s]")
plt.ylabel("force on the tool [N]")
plt.savefig(sys.argv[3], dpi=110)
