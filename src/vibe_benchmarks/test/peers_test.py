#!/usr/bin/env python3
"""Truths of the scenes that other engines run, without those engines: closed forms, convergence, wrong stiffness seen."""
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "peers"))

import beams  # noqa: E402
import drive  # noqa: E402
import meshes  # noqa: E402
import scenes  # noqa: E402


def moved_like(scene, probes):
    """Recorded displacements whose nodes move like the nearer of two probes of a strip."""
    near = np.argmin(abs(scene.nodes[scene.record, 0, None] - scene.probes[:, 0]), axis=1)
    still = np.zeros((1, len(near), 3))
    return np.concatenate([still, probes[:, near]])


class BeamTest(unittest.TestCase):
    def test_a_half_ring_takes_a_small_load_as_the_closed_form_says(self):
        radius, approach = 1 / np.pi, 1e-4
        force = beams.fold(1, 2 * radius - approach, 1, [0.5])[1]
        self.assertAlmostEqual(force * radius**3 * (np.pi / 2 - 4 / np.pi) / approach, 1, delta=2e-3)

    def test_ends_without_moment_have_the_force_of_a_long_strip_between_plates(self):
        gap = 1 / 2.188440  # of the elastica whose ends have no curvature
        self.assertAlmostEqual(beams.fold(1, gap, 1, [0.5])[1] * gap**2, 2.871079, delta=1e-4)

    def test_a_falling_chain_converges(self):
        times = np.array([0.1, 0.2])
        ten, twenty, forty = (beams.falling(0.1, 50e3, 3.5e-3, 1050, 9.81, times, parts) for parts in (10, 20, 40))
        ratio = np.linalg.norm(ten - twenty) / np.linalg.norm(twenty - forty)
        self.assertGreater(ratio, 3)


class SceneTest(unittest.TestCase):
    def test_a_wrong_stiffness_is_an_error(self):
        scene = scenes.make("sheet")
        self.assertLess(scene.error(moved_like(scene, scene.truth)), 1e-9)
        times = np.arange(1, 31) * scenes.FRAME
        stiff = beams.falling(scenes.STRIP, 2 * scene.young, 3.5e-3, 1050, scenes.GRAVITY, times, 40)
        self.assertGreater(scene.error(moved_like(scene, stiff)), 0.02)
        right, wrong = (beams.fold(scenes.STRIP, scenes.GAP, bending, [0.05])[1] for bending in (1, 1.2))
        self.assertAlmostEqual(wrong / right, 1.2, delta=1e-6)

    def test_every_scene_holds_its_nodes_and_has_its_mass(self):
        for name in scenes.NAMES:
            for large, few, many in ((False, 950, 1050), (True, 3550, 3750)):
                scene = scenes.make(name, large)
                self.assertTrue(few < len(scene.nodes) < many, (name, len(scene.nodes)))
                self.assertFalse(np.isnan(scene.masses()).any())
                self.assertEqual(len(np.unique(scene.triangles)), len(scene.nodes), name)
                self.assertLess(scene.error(np.repeat(scene.nodes[None, scene.record] * 0, 32, 0)), 1 + 1e-9)

    def test_the_fold_ends_parallel_at_its_gap(self):
        scene = scenes.make("fold")
        ends = [hold.at(scene.nodes[hold.nodes], 1) for hold in scene.holds.values()]
        edges = [end[np.isclose(end[:, 2], end[:, 2].max())] for end in ends]
        self.assertAlmostEqual(edges[1][0, 0] - edges[0][0, 0], scenes.GAP, delta=1e-9)

    def test_gas_pushes_outwards(self):
        nodes, triangles = meshes.sphere(1, 0.2, 2, 12, 24)
        forces = drive.gas_forces(nodes, triangles, 1.0)
        self.assertAlmostEqual((forces * nodes).sum(), 4 * np.pi, delta=0.4)


if __name__ == "__main__":
    unittest.main()
