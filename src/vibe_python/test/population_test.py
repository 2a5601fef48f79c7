#!/usr/bin/env python3
"""vibe_population: what is drawn has the published distributions, what is written is valid, and what is valid moves."""
import importlib.util
import os
import tempfile
import unittest

import numpy as np

if not importlib.util.find_spec("scipy"):
    raise unittest.SkipTest("python3-scipy is not installed")

from vibe.patient import population


class PopulationTest(unittest.TestCase):
    def test_what_is_drawn_has_the_published_means_spreads_and_ranges(self):
        drawn = [population.draw(np.random.default_rng([3, number])) for number in range(1500)]
        for name, key in (("wall of the body", "wall"), ("width of the fundus", "fundus"), ("angle of the antrum", "antrum")):
            _, factor, mean, spread, (least, most), _ = population.PUBLISHED[name]
            values = factor * np.array([stomach[key] for stomach in drawn])
            self.assertLess(abs(values.mean() - mean), 0.12 * spread, name)
            self.assertAlmostEqual(values.std() / spread, 1, delta=0.1, msg=name)
            self.assertGreaterEqual(values.min(), least)
            self.assertLessEqual(values.max(), most)
        shares = {word: np.mean([stomach["shape"] == word for stomach in drawn]) for word in population.SHAPES}
        for word, share in population.SHAPES.items():
            self.assertAlmostEqual(shares[word], share / sum(population.SHAPES.values()), delta=0.05)

    def test_scenes_measure_what_was_drawn_and_move(self):
        with tempfile.TemporaryDirectory() as folder:
            for number in range(10):
                stomach = population.draw(np.random.default_rng([5, number]))
                scene = os.path.join(folder, "stomach.yaml")
                with open(scene, "w", encoding="utf-8") as text:
                    text.write(population.scene_text(stomach, number, 5))
                with self.subTest(number=number):
                    self.assertEqual(population.move(scene), [])
                    if number < 4:
                        measured = population.measure(scene, stomach)
                        rise = (measured["volume at 10 mmHg"] - stomach["volume"]) / 10  # [m^3/mmHg], a secant
                        self.assertLess(abs(measured["compliance at 10 mmHg"] / rise - 1), 0.35)
                        self.assertGreater(measured["volume at 10 mmHg"], 0.75e-3)
                        self.assertLess(measured["volume at 10 mmHg"], 1.9e-3)

    def test_equal_seeds_give_equal_scenes_and_others_others(self):
        text = [population.scene_text(population.draw(np.random.default_rng([seed, 0])), 0, 1) for seed in (1, 1, 2)]
        self.assertEqual(text[0], text[1])
        self.assertNotEqual(text[0], text[2])

    def test_a_wall_that_is_too_soft_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(folder, "soft.yaml")
            with open(scene, "w", encoding="utf-8") as text:
                text.write("base: package://vibe_core/scenes/stomach.yaml\ntissue: {young_modulus: 100 Pa}\ngas: {flow_limit: 1 L/s}\n")
            self.assertNotEqual(population.move(scene), [])


if __name__ == "__main__":
    unittest.main()
