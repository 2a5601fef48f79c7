"""Training sets in the formats of the field: lerobot (v2.1, v3.0), robomimic and minari (HDF5).

Each is written an episode at a time, whole or not at all: whatever stops a program, finished episodes stay readable, and the
same call goes on after the last one. Needs no ROS; what a format needs besides numpy is named when it is missing.
"""
