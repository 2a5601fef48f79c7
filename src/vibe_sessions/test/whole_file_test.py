#!/usr/bin/env python3
"""Files are there whole or not at all: writers that are killed, and programs on a full disk."""
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import unittest

from in_folder import InFolder

from vibe_sessions.headless import find_in_package
from vibe_sessions.whole_file import open_whole, whole

OLD, NEW = "old " * 5000, "new " * 9000
WRITER = """
import os, signal, sys
from vibe_sessions.whole_file import open_whole
path, at, text = sys.argv[1], int(sys.argv[2]), "new " * 9000
with open_whole(path) as file:
    file.write(text[:at])
    file.flush()
    if at < len(text):
        os.kill(os.getpid(), signal.SIGKILL)
"""
SPHERE = "package://vibe_core/scenes/sphere.yaml"
PROGRAMS = {  # arguments that write OUT, and how large a file they may write [bytes]
    "vibe_headless --csv": (("vibe_core", "vibe_headless", "--scene", SPHERE, "--duration", "2", "--quiet", "--csv", "OUT"), 4096),
    "vibe_headless --measures": (("vibe_core", "vibe_headless", "--scene", SPHERE, "--duration", "0.1", "--measures", "OUT"), 1024),
    "vibe_headless --snapshot": (("vibe_core", "vibe_headless", "--scene", SPHERE, "--duration", "0.1", "--snapshot", "OUT"), 4096),
    "vibe_replay --record": (("vibe_sim", "vibe_replay", "--record", "OUT", "BAG"), 8192),
    "vibe_replay --fill": (("vibe_sim", "vibe_replay", "--fill", "OUT", "BAG"), 8192),
    "cohort": (("vibe_sessions", "cohort", "--output", "OUT", "--scene", SPHERE, "--count", "1", "--novice", "0", "--duration", "0.1",
                "--jobs", "1"), 512),
    "import": (("vibe_sessions", "import", "CSV", "--map", "MAP", "--output", "OUT"), 4096),
}


class WholeFileTest(InFolder):
    def path(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def test_a_writer_that_is_killed_leaves_what_was_there(self):
        chance = random.Random(5)
        for at in [0, 1, len(NEW) - 1] + [chance.randrange(len(NEW)) for _ in range(6)] + [len(NEW)]:
            self.write("state", OLD)
            done = subprocess.run([sys.executable, "-B", "-c", WRITER, self.path("state"), str(at)], check=False)
            self.assertEqual(done.returncode, 0 if at == len(NEW) else -signal.SIGKILL)
            self.assertEqual(self.read("state"), NEW if at == len(NEW) else OLD)
        self.assertNotIn(".part-state", os.listdir(self.folder))  # the last one began it anew

    def test_a_writer_that_fails_leaves_what_was_there_and_names_the_file(self):
        self.write("state", OLD)
        for failure in (ValueError(), KeyboardInterrupt(), OSError(28, "No space left on device")):
            with self.assertRaises(type(failure)) as caught, open_whole(self.path("state")) as file:
                file.write(NEW)
                raise failure
        self.assertEqual(caught.exception.filename, self.path("state"))
        self.assertEqual((self.read("state"), os.listdir(self.folder)), (OLD, ["state"]))

    def test_links_devices_and_endings(self):
        self.write("state", OLD)
        os.symlink("state", self.path("link"))
        with open_whole(self.path("link")) as file:
            file.write(NEW)
        self.assertTrue(os.path.islink(self.path("link")))
        self.assertEqual(self.read("state"), NEW)
        with whole("/dev/null") as part:
            self.assertEqual(part, "/dev/null")
        with whole(self.path("picture.png")) as part:  # programs tell the kind of a file by its ending
            self.assertTrue(part.endswith(".png"))
            self.write(part, "x")

    @unittest.skipUnless(find_in_package("vibe_sim", "vibe_replay"), "vibe_replay is not built")
    def test_programs_say_one_sentence_when_the_disk_is_full(self):
        self.write("motion.csv", "t,x\n" + "".join(f"{k / 30},{0.05 + k * 1e-4}\n" for k in range(30)))
        self.write("map.yaml", "time: {from: t}\njoints: {insertion: {from: x}}\n")
        self.bag()
        # else Python cuts off what it caches beside the sources, and every later test reads that
        environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
        places = {"OUT": self.path("out"), "BAG": self.path("in.bag"), "CSV": self.path("motion.csv"), "MAP": self.path("map.yaml")}
        for name, ((package, program, *words), size) in PROGRAMS.items():
            with self.subTest(name):
                limit = lambda size=size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))  # noqa: E731
                done = subprocess.run([find_in_package(package, program), *(places.get(word, word) for word in words)], text=True,
                                      preexec_fn=limit, env=environment, capture_output=True, check=False, timeout=120)
                self.assertIn(done.returncode, (1, 2), (name, done.returncode, done.stderr))
                said = done.stderr.strip().splitlines()
                self.assertRegex(said[-1], "writ|break|room", done.stderr)
                self.assertNotIn("Traceback", done.stderr)
                left = [file for _, _, files in os.walk(self.folder) for file in files]
                for file in left:  # nothing that is cut off has the name of what is whole
                    self.assertFalse(file in ("out", "commands.bag", "session.bag", "cohort.csv") or file.endswith(".json"), (name, left))
                shutil.rmtree(places["OUT"], ignore_errors=True)
                for file in left:
                    if file.startswith("out."):
                        os.remove(self.path(file))

    def bag(self):
        import numpy
        from vibe_sessions.imports.session import write_commands
        write_commands(self.path("in.bag"), SPHERE, 1 / 60, numpy.zeros((20, 7)), numpy.zeros((20, 6), numpy.uint8))


if __name__ == "__main__":
    unittest.main()
