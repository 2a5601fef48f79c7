#!/usr/bin/env python3
"""Draws what Simulation.camera(tool=True) gives, after two marks were made: colour, depth, normals, labels side by side; or with
--outside an episode of Reach from before the patient; or with --motion a wave that runs to the pylorus, and a breath."""

import argparse

import matplotlib.image
import numpy as np

import vibe
from vibe.env import Environment, Expert

PROTOCOL = """
name: two marks
skill: {like: expert}
goals:
  - mark: {along: 0.6, around: 0.2 rad}
  - mark: {along: 0.63, around: -0.1 rad}
"""
FAR = 0.15  # shown white in the picture of depths [m]
REGIONS = np.array([[0, 0, 0], [204, 120, 166], [87, 181, 232], [230, 158, 0], [0, 158, 115], [214, 94, 0],
                    [150, 150, 150], [60, 90, 200]], np.uint8)


def outside():
    environment = Environment("Reach", render_mode="rgb_array", view="outside", organs=[("sthenic", 1.0)])
    seen, _ = environment.reset(seed=1)
    expert = Expert(environment)
    expert.reset()
    for _ in range(15):
        seen = environment.step(expert.action(seen))[0]
    return environment.render()


def marks(size):
    simulation = vibe.Simulation(vibe.load())
    simulation.follow(vibe.Trainee(simulation.model, PROTOCOL))
    simulation.run(90, insertion=simulation.input["insertion"] - 0.05)
    seen = simulation.camera(size, size, 1.7, normals=True, colour=True, tool=True)
    grey = (255 * np.clip(np.nan_to_num(seen["depth"]) / FAR, 0, 1)).astype(np.uint8)
    return np.concatenate([seen["colour"], np.stack([grey] * 3, -1), (127.5 * (seen["normal"] + 1)).astype(np.uint8), REGIONS[seen["label"]]], 1)


def motion(size):
    """Above: the antrum every 3 s, while the tip is held. Below: the organ through a breath of 3.75 s, from before the patient."""
    simulation = vibe.Simulation(vibe.load(motion={"grade": 2}), impedance=False)
    simulation.run(900, insufflate=True)
    simulation.run(180, insertion=0.10, rotation=np.pi / 2)
    simulation.run(240, insertion=0.168, tip_up_down=2.12)
    waves, breath = [], []
    for _ in range(7):
        waves.append(vibe.picture(simulation, size=size))
        simulation.run(180)
    for _ in range(7):
        breath.append(vibe.picture(simulation, "outside", size))
        simulation.run(38)
    return np.concatenate([np.concatenate(row, 1) for row in (waves, breath)])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", help="PNG that is written")
    parser.add_argument("--size", type=int, default=256, help="of each picture [px]")
    parser.add_argument("--outside", action="store_true", help="the picture from outside instead")
    parser.add_argument("--motion", action="store_true", help="a living stomach instead")
    options = parser.parse_args()
    pixels = outside() if options.outside else motion(options.size) if options.motion else marks(options.size)
    matplotlib.image.imsave(options.file, pixels)


if __name__ == "__main__":
    main()
