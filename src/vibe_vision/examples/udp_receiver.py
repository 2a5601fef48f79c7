#!/usr/bin/env python3
"""Prints where the instruments are now: udp_receiver.py [port]. Layout of the datagrams: docs/vision.md, "Datagram"."""
import math
import socket
import struct
import sys
import time

HEADER = struct.Struct("<4sHBxIfQdff")  # magic, version, instruments, sequence, exposure, frame, stamp, age, t
INSTRUMENT = struct.Struct("<BBBxf4d10f4d10f")  # tracked, reason, has_rotation, score, slide, rotation


def extrapolate(coordinate, dt, t):
    """Position in dt seconds: the acceleration goes on, the jerk fades away with the time constant t."""
    position, velocity, acceleration, jerk = coordinate
    x = dt / t
    fade = t**3 * (1 - x + x * x / 2 - math.exp(-x))
    return position + velocity * dt + acceleration * dt * dt / 2 + jerk * fade


def decode(data):
    """Stamp, t and rows of instruments; no rows for bytes that are not a datagram."""
    if len(data) < HEADER.size or data[:6] != b"VIBT\1\0" or len(data) != HEADER.size + data[6] * INSTRUMENT.size:
        return 0, 1, []
    *_, stamp, _, t = HEADER.unpack_from(data)
    return stamp, t, INSTRUMENT.iter_unpack(data[HEADER.size :])


if __name__ == "__main__":
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("", int(sys.argv[1]) if len(sys.argv) > 1 else 9870))
    while True:
        stamp, t, instruments = decode(receiver.recv(2048))
        dt = min(max(time.time() - stamp, 0), 0.1)
        for i, (tracked, reason, has_rotation, _, *rest) in enumerate(instruments):
            coordinates = [rest[:4], rest[14:18]][: 1 + has_rotation]
            text = " ".join("%.6f" % extrapolate(c, dt, t) for c in coordinates) if tracked else "lost %d" % reason
            print(i, "%.6f" % (stamp + dt), text, flush=True)
