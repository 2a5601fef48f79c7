"""The memory of what reads recordings is that of a short one, whatever their length."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

from report_bags import SyntheticSession

SHORT, LONG = 20.0, 200.0  # [s]
FEW = 5.0  # MB
EXPORT = "from vibe_sessions.export.main import main; main([BAG, '--to', 'csv,mcap,mesh,gltf', '--output', OUT])"
REPORT = "from vibe_sessions.report.session_work import Task, report_on; report_on(Task(BAG, '', '', None, '', ''))"
KEEP_ALL = "from vibe_sessions.export.source import Source; s = Source(BAG); kept = list(s.messages(s.chosen))"


class LongBagTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="vibe_long_bag_")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.bags = [SyntheticSession(os.path.join(cls.folder.name, name), duration=duration, identity=1).write()
                    for name, duration in (("short.bag", SHORT), ("long.bag", LONG))]  # fmt: skip

    def peak(self, program, bag):
        """Of a process of its own [MB]; rusage would have that of this one, from which it is forked."""
        output = tempfile.mkdtemp(dir=self.folder.name)
        words = "BAG, OUT = {!r}, {!r}; {}; print(open('/proc/self/status').read())".format(bag, output, program)
        said = subprocess.run([sys.executable, "-B", "-c", words], stdout=subprocess.PIPE, check=True, encoding="utf-8").stdout
        return int(re.search(r"VmHWM:\s*(\d+) kB", said)[1]) / 1024

    def growth(self, program):
        short, long = (self.peak(program, bag) for bag in self.bags)
        return long - short

    def test_export(self):
        self.assertLess(self.growth(EXPORT), FEW)

    def test_report(self):
        self.assertLess(self.growth(REPORT), FEW)

    def test_what_keeps_every_message_is_noticed(self):
        self.assertGreater(self.growth(KEEP_ALL), FEW)


if __name__ == "__main__":
    unittest.main()
