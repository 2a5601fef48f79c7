#!/usr/bin/env python3
"""The output of a guest becomes results: what failed, and what was never heard of, is not ok."""

import contextlib
import io
import unittest

from vibe_system_tests.hid_kernel import Report

OUTPUT = """\
[ RUN      ] A.good
[       OK ] A.good (1 ms)
[ RUN      ] A.bad
bad.cpp:1: Failure
[  FAILED  ] A.bad (2 ms)
[ RUN      ] A.without
no board
[  SKIPPED ] A.without (0 ms)
figure x: 1 ms
[  FAILED  ] 1 test, listed below:
[  FAILED  ] A.bad"""


class ReportTest(unittest.TestCase):
    def test_what_fails_or_is_never_heard_of_is_not_ok(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            report = Report(["A.good", "A.bad", "A.without", "A.silent"])
            for line in OUTPUT.splitlines():
                report.read(line)
            self.assertFalse(report.end())
        lines = said.getvalue().splitlines()
        self.assertEqual(
            [line for line in lines if not line.startswith(" ")],
            ["ok A.good", "not ok A.bad", "skipped A.without", "figure x: 1 ms", "not ok A.silent"],
        )
        self.assertIn("    bad.cpp:1: Failure", lines)


if __name__ == "__main__":
    unittest.main()
