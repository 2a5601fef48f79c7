#!/usr/bin/env python3
"""Growth of memory is told from noise."""

import unittest

from vibe_system_tests.soak import slope
from vibe_system_tests.soak_rviz import HALF_HOUR


class SlopeTest(unittest.TestCase):
    def test_a_megabyte_a_minute_is_growth(self):
        leak = [(time, 300 + time / 60) for time in range(0, 1800, 20)]
        self.assertLess(abs(HALF_HOUR * slope(leak) - 30), 1e-6)

    def test_noise_of_ten_megabytes_around_one_value_is_none(self):
        noise = [(time, 300 + 10 * (k % 2)) for k, time in enumerate(range(0, 1800, 20))]
        self.assertLess(abs(HALF_HOUR * slope(noise)), 1)


if __name__ == "__main__":
    unittest.main()
