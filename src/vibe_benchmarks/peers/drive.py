"""Runs a scene in an engine, frame by frame."""

import math
import time
from dataclasses import dataclass

import numpy as np

from scenes import FRAME


@dataclass
class Outcome:
    recorded: np.ndarray = None  # displacements of the recorded nodes (frame, node, xyz), the start first
    cpu: float = math.nan  # of all threads, per simulated second [s]
    force: float = math.nan  # [N]
    note: str = ""


def gas_forces(positions, triangles, pressure):
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    share = np.repeat((pressure / 6 * np.cross(b - a, c - a))[:, None], 3, 1).reshape(-1, 3)
    nodes = triangles.ravel()
    return np.stack([np.bincount(nodes, share[:, k], len(positions)) for k in range(3)], 1)


def drive(engine, scene, limit):
    """Only the engine's own steps count; loads that a user computes, and reading positions, do not.
    @param limit  CPU time after which a run is given up [s]"""
    steps = max(1, round(FRAME / engine.step_size))
    recorded, cpu = [np.zeros((len(scene.record), 3))], 0.0
    frames = round(scene.duration / FRAME)
    positions = scene.nodes
    for frame in range(frames):
        for i in range(steps):
            now = frame * FRAME + (i + 1) * engine.step_size
            engine.place(now)
            if scene.pressure:
                positions = engine.positions()
                engine.apply(gas_forces(positions, scene.triangles, scene.pressure * min(now, 1)))
            start = time.process_time()
            engine.step()
            cpu += time.process_time() - start
        positions = engine.positions()
        moved = positions[scene.record] - scene.nodes[scene.record]
        if not np.isfinite(positions).all() or abs(moved).max() > 1:
            return Outcome(note=f"unstable at {now:.2f} s")
        recorded.append(moved)
        if cpu > limit and frame + 1 < frames:
            return Outcome(cpu=cpu / now, note=f"given up after {cpu:.0f} s at {now:.2f} s")
    return Outcome(np.array(recorded), cpu / scene.duration, engine.force() if scene.force else math.nan)
