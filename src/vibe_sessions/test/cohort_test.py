#!/usr/bin/env python3
"""Cohorts with a program that stands in for a session: resuming, other plans, killed children, bad scenes, Dask."""
import contextlib
import dataclasses
import glob
import io
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
import warnings
from unittest import mock

from in_folder import InFolder

from vibe_sessions import cohort
from vibe_sessions.cohort_plan import Plan
from vibe_sessions.cohort_plot import organ_names
from vibe_sessions.cohort_progress import Progress
from vibe_sessions.cohort_session import check_files
from vibe_sessions.headless import SessionError

HERE = os.path.dirname(os.path.abspath(__file__))


class CohortTest(InFolder):
    def setUp(self):
        super().setUp()
        programs = os.path.join(self.folder, "prefix", "lib", "vibe_core")
        os.makedirs(programs)
        shutil.copy(os.path.join(HERE, "fake_headless.py"), os.path.join(programs, "vibe_headless"))
        self.marks = os.path.join(self.folder, "marks")
        os.makedirs(self.marks)
        self.before = dict(os.environ)
        self.addCleanup(self.restore)
        os.environ.update(CMAKE_PREFIX_PATH=os.path.join(self.folder, "prefix"), VIBE_FAKE=self.marks)
        self.scene = self.write("scene.yaml", "name: scene\n")
        self.script = self.write("script.yaml", "goals: []\n")

    def restore(self):
        os.environ.clear()
        os.environ.update(self.before)

    def arguments(self, name, *more):
        return ["--output", os.path.join(self.folder, name), "--script", self.script, "--scene", self.scene,
                "--count", "4", "--novice", "0", "0.5", "1", *more]

    def call(self, *arguments):
        """(status, standard error)"""
        said = io.StringIO()
        warnings.simplefilter("ignore", DeprecationWarning)  # of Dask's own
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            try:
                status = cohort.main(list(arguments))
            except SystemExit as end:
                status = end.code
        return status, said.getvalue()

    def read(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as stream:
            return stream.read()

    def began(self, pattern="*"):
        return len(glob.glob(os.path.join(self.marks, f"began-{pattern}")))

    def background(self, *arguments):
        """The command line in a process of its own."""
        code = "import sys; from vibe_sessions.cohort import main; sys.exit(main(sys.argv[1:]))"
        return subprocess.Popen([sys.executable, "-c", code, *arguments], stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)

    def wait_for(self, condition, patience=60):
        end = time.monotonic() + patience
        while not condition():
            self.assertLess(time.monotonic(), end, "waited in vain")
            time.sleep(0.05)


class LocalTest(CohortTest):
    def test_a_row_per_session_in_order(self):
        status, said = self.call(*self.arguments("a"))
        self.assertEqual(status, 0, said)
        rows = [line.split(",") for line in self.read("a/cohort.csv").splitlines()]
        self.assertEqual(rows[0][:4], ["scene", "mesh", "novice", "seed"])
        self.assertEqual([row[2:4] for row in rows[1:]], [[n, str(s)] for n in ("0", "0.5", "1") for s in range(1, 5)])
        self.assertIn("12 of 12 sessions", said)

    def test_other_jobs_the_same_table(self):
        self.call(*self.arguments("a", "--jobs", "1"))
        self.call(*self.arguments("b", "--jobs", "5"))
        self.assertEqual(self.read("a/cohort.csv"), self.read("b/cohort.csv"))

    def test_goes_on_where_it_ended(self):
        self.call(*self.arguments("a"))
        table = self.read("a/cohort.csv")
        for name in ("scene_novice0_seed2", "scene_novice1_seed4"):
            os.remove(os.path.join(self.folder, "a", "rows", name + ".json"))
        status, said = self.call("--output", os.path.join(self.folder, "a"))
        self.assertEqual((status, self.began()), (0, 14), said)
        self.assertEqual(self.read("a/cohort.csv"), table)

    def test_another_plan_is_refused(self):
        self.call(*self.arguments("a"))
        for more, word in (("--count", "5"), "count was 4"), (("--novice", "0"), "novice was"):
            status, said = self.call(*self.arguments("a"), *more)
            self.assertEqual((status, said.count("\n")), (2, 1))
            self.assertIn(word, said)
        self.write("scene.yaml", "name: other\n")
        status, said = self.call("--output", os.path.join(self.folder, "a"))
        self.assertEqual(status, 2)
        self.assertIn("scene.yaml' has changed", said)
        self.assertEqual(self.began(), 12)

    def test_another_build_is_refused(self):
        self.call(*self.arguments("a"))
        with open(os.path.join(self.folder, "prefix/lib/vibe_core/vibe_headless"), "a", encoding="utf-8") as stream:
            stream.write("# another build\n")
        status, said = self.call("--output", os.path.join(self.folder, "a"))
        self.assertEqual(status, 2)
        self.assertIn("another build", said)

    def test_a_changed_base_is_another_plan(self):
        self.write("base.yaml", "a: 1\n")
        self.write("scene.yaml", "base: base.yaml\n")
        self.call(*self.arguments("a"))
        self.write("base.yaml", "a: 2\n")
        self.assertEqual(self.call("--output", os.path.join(self.folder, "a"))[0], 2)

    def test_changed_landmarks_and_a_changed_scope_are_another_plan(self):
        for scene, name in (("geometry: {kind: mesh, file: organ.obj}\n", "organ.obj.landmarks.yaml"),
                            ("scope: {urdf: scope.urdf}\n", "scope.urdf")):
            self.write("organ.obj", "v 0 0 0\n")
            self.write("scene.yaml", scene)
            self.write(name, "a: 1\n")
            output = os.path.join(self.folder, "cohort of " + name)
            self.call(*self.arguments(output))
            self.assertEqual(self.call("--output", output)[0], 0)
            self.write(name, "a: 2\n")
            self.assertEqual(self.call("--output", output)[0], 2, name)

    def test_a_killed_child_is_tried_again(self):
        self.write("marks/kill-3")
        status, said = self.call(*self.arguments("a"))
        self.assertEqual((status, self.began("*-3-*"), self.began()), (0, 6, 15), said)
        self.call(*self.arguments("b"))
        self.assertEqual(self.read("a/cohort.csv"), self.read("b/cohort.csv"))

    def test_a_session_that_always_dies_is_listed(self):
        self.write("marks/always-kill-2")
        status, said = self.call(*self.arguments("a"))
        self.assertEqual((status, self.began("*-2-*")), (1, 9))
        self.assertIn("SIGKILL. Tried 3 times.", said)
        self.assertEqual(len(self.read("a/cohort.csv").splitlines()), 1 + 9)
        self.assertEqual(len(self.read("a/failed.csv").splitlines()), 1 + 3)
        os.remove(os.path.join(self.marks, "always-kill-2"))
        self.assertEqual(self.call("--output", os.path.join(self.folder, "a"))[0], 0)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "a", "failed.csv")))

    def test_a_bad_scene_is_one_sentence_and_the_others_go_on(self):
        bad = self.write("bad.yaml", "colour: red\n")
        arguments = self.arguments("a")
        arguments.insert(arguments.index(self.scene), bad)
        status, said = self.call(*arguments)
        self.assertEqual(status, 1)
        self.assertIn("bad_novice0_seed1 and 11 more failed: bad.yaml:3: unknown key 'colour'; remove it.\n", said)
        self.assertEqual(self.began(), 24)  # no second try: it would fail again
        self.assertEqual(len(self.read("a/cohort.csv").splitlines()), 1 + 12)

    def test_ctrl_c_ends_the_children_and_says_how_to_go_on(self):
        self.write("marks/hang")
        process = self.background(*self.arguments("a", "--jobs", "2"))
        self.wait_for(lambda: self.began() >= 2)
        children = [int(name.rsplit("-", 1)[1]) for name in os.listdir(self.marks) if name.startswith("began")]
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("scripts/cohort --output", said)
        for child in children:
            self.assertFalse(os.path.exists(f"/proc/{child}"))
        os.remove(os.path.join(self.marks, "hang"))
        self.assertEqual(self.call("--output", os.path.join(self.folder, "a"))[0], 0)

    @unittest.skipUnless(shutil.which("setpriv"), "no setpriv")
    def test_no_child_outlives_a_killed_cohort(self):
        self.write("marks/hang")
        process = self.background(*self.arguments("a", "--jobs", "1"))
        self.wait_for(lambda: self.began() >= 1)
        child = next(int(name.rsplit("-", 1)[1]) for name in os.listdir(self.marks) if name.startswith("began"))
        process.kill()
        process.communicate()
        self.wait_for(lambda: not os.path.exists(f"/proc/{child}"), 10)

    def test_one_cohort_at_a_time_in_a_folder(self):
        self.write("marks/hang")
        process = self.background(*self.arguments("a", "--jobs", "1"))
        self.wait_for(lambda: self.began() >= 1)
        status, said = self.call("--output", os.path.join(self.folder, "a"))
        process.terminate()
        process.communicate(timeout=20)
        self.assertEqual(status, 2)
        self.assertIn("Another cohort is at work", said)

    def test_equal_names_of_scenes_are_told_apart(self):
        os.makedirs(os.path.join(self.folder, "other"))
        other = self.write("other/scene.yaml", "name: other\n")
        self.call(*self.arguments("a", "--scene", self.scene, other))
        self.assertTrue(os.path.exists(os.path.join(self.folder, "a/rows/scene_2_novice1_seed4.json")))
        self.assertEqual(len(self.read("a/cohort.csv").splitlines()), 1 + 24)

    def test_wrong_calls(self):
        for arguments in ([], ["--output", "a", "--novice", "2"], ["--output", "a", "--count", "0"],
                          ["--output", "a", "--no-such"], ["--output", "/proc/none"], ["--plot", self.folder]):
            status, said = self.call(*arguments)
            self.assertEqual((status, said.count("\n")), (2, 1), said)


class WorkerTest(CohortTest):
    def test_another_build_on_a_worker_is_refused(self):
        self.call(*self.arguments("a"))
        session = next(iter(Plan.load(os.path.join(self.folder, "a", "cohort.yaml")).sessions()))
        check_files(session)
        other = dataclasses.replace(session, versions=tuple((name, "other") for name, _ in session.versions))
        with self.assertRaisesRegex(SessionError, "is .* here and other in the plan"):
            check_files(other)


class PlotTest(unittest.TestCase):
    def test_organs_of_equal_names_are_told_apart(self):
        rows = [{"scene": f"/{folder}/stomach.yaml", "mesh": ""} for folder in ("a", "b", "a")]
        self.assertEqual(list(organ_names(rows).values()), ["stomach", "stomach (2)"])


class ProgressTest(unittest.TestCase):
    def test_counts_rate_and_time_left(self):
        now, stream = [0.0], io.StringIO()
        progress = Progress(10, 4, stream, lambda: now[0])
        for _ in range(3):
            now[0] += 20
            progress.add()
        self.assertEqual(progress.line(), "7 of 10 sessions, 180 per hour, 60 s left")
        progress.add(failed=True)
        self.assertTrue(progress.line().endswith(", 1 failed"))


def dask_command(name):
    found = shutil.which(f"dask-{name}")
    return [found] if found else [sys.executable, "-m", f"distributed.cli.dask_{name}"]


class DaskTest(CohortTest):
    def setUp(self):
        super().setUp()
        self.processes = []
        self.addCleanup(self.end)
        file = os.path.join(self.folder, "scheduler.json")
        self.start(dask_command("scheduler") + ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show",
                                                "--scheduler-file", file])
        self.wait_for(lambda: os.path.exists(file) and "address" in self.read("scheduler.json"))
        self.address = re.search(r'"address": "tcp://([^"]+)"', self.read("scheduler.json")).group(1)

    def start(self, command):
        with open(os.path.join(self.folder, f"log{len(self.processes)}"), "w", encoding="utf-8") as log:
            self.processes.append(subprocess.Popen(command, stdout=log, stderr=log, cwd=self.folder, process_group=0))
        return self.processes[-1]

    def worker(self):
        return self.start(dask_command("worker") + [self.address, "--host", "127.0.0.1", "--nworkers", "1",
                                                    "--nthreads", "2", "--no-dashboard", "--local-directory",
                                                    self.folder])

    def end(self):
        for process in reversed(self.processes):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()

    def test_the_table_is_that_of_a_local_cohort(self):
        self.worker(), self.worker()
        self.write("marks/kill-3")
        bad = self.write("bad.yaml", "colour: red\n")
        scenes = ("--scene", self.scene, bad)
        status, said = self.call(*self.arguments("a", *scenes, "--scheduler", self.address))
        self.assertEqual(status, 1, said)
        self.assertIn("bad_novice0_seed1 and 11 more failed: bad.yaml:3", said)
        self.assertEqual(self.began("*-3-*"), 6 + 3)  # tried again: those that were killed, not those of the bad scene
        self.call(*self.arguments("b", *scenes))
        self.assertEqual(self.read("a/cohort.csv"), self.read("b/cohort.csv"))
        self.assertEqual(len(self.read("a/cohort.csv").splitlines()), 1 + 12)

    def test_a_killed_worker_loses_its_session_only(self):
        self.write("marks/slow")
        first = self.worker()
        self.worker()
        cohort_process = self.background(*self.arguments("a", "--scheduler", self.address))
        self.wait_for(lambda: self.began() >= 4)
        os.killpg(first.pid, signal.SIGKILL)
        said = cohort_process.communicate(timeout=120)[1]
        self.assertEqual(cohort_process.returncode, 0, said)
        self.assertLessEqual(self.began(), 12 + 2)
        os.remove(os.path.join(self.marks, "slow"))
        self.call(*self.arguments("b"))
        self.assertEqual(self.read("a/cohort.csv"), self.read("b/cohort.csv"))

    def test_ctrl_c_ends_the_children_of_the_workers(self):
        self.write("marks/hang")
        self.worker()
        process = self.background(*self.arguments("a", "--scheduler", self.address))
        self.wait_for(lambda: self.began() >= 2)
        children = [int(name.rsplit("-", 1)[1]) for name in os.listdir(self.marks) if name.startswith("began")]
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=30)[1]
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("--scheduler " + self.address, said)
        self.wait_for(lambda: not any(os.path.exists(f"/proc/{child}") for child in children), 20)

    def test_a_worker_with_other_files_says_so(self):
        self.worker()
        self.write("marks/slow")
        process = self.background(*self.arguments("a", "--scheduler", self.address))
        self.wait_for(lambda: self.began() >= 2)
        self.write("scene.yaml", "name: other\n")
        said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1)
        self.assertIn("scene.yaml' is missing here or differs from that of the plan", said)

    def test_no_scheduler_and_no_worker_are_one_sentence(self):
        with mock.patch("vibe_sessions.cohort_dask.PATIENCE", 1):
            status, said = self.call(*self.arguments("a", "--scheduler", "127.0.0.1:9"))
            self.assertEqual((status, said.count("\n")), (2, 1), said)
            self.assertIn("No Dask scheduler answers", said)
            status, said = self.call(*self.arguments("b", "--scheduler", self.address))
            self.assertEqual((status, said.count("\n")), (2, 1), said)
            self.assertIn("has no worker", said)

    def test_a_lost_scheduler_is_one_sentence(self):
        self.worker()
        self.write("marks/hang")
        code = ("import sys; from vibe_sessions import cohort, cohort_dask; cohort_dask.PATIENCE = 5; "
                "sys.exit(cohort.main(sys.argv[1:]))")
        process = subprocess.Popen([sys.executable, "-c", code, *self.arguments("a", "--scheduler", self.address)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.wait_for(lambda: self.began() >= 2)
        self.processes[0].kill()
        said = process.communicate(timeout=60)[1]
        self.assertEqual((process.returncode, said.count("\n")), (2, 1), said)
        self.assertIn("connection to the Dask scheduler was lost", said)


if __name__ == "__main__":
    unittest.main()
