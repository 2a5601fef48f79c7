#!/usr/bin/env python3
"""Command lines: what is refused and in which words, defaults, and that a check leaves nothing behind."""

import argparse
import concurrent.futures
import contextlib
import importlib
import io
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import yaml

from vibe_bringup import dataset, drivers, graph, places, run, session, vision

PROGRAMS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "programs")
NAMES = sorted(os.listdir(PROGRAMS))


def call(name, *words):
    """(arguments or None, exit status or None, standard output, standard error) of a command line."""
    said, complained = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
        try:
            return importlib.import_module("vibe_bringup." + name).parse(list(words)), None, "", ""
        except SystemExit as end:
            return None, end.code, said.getvalue(), complained.getvalue()


class OptionsTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="vibe-options-")
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        self.file = os.path.join(self.folder, "file.yaml")
        with open(self.file, "w", encoding="utf-8") as file:
            file.write("name: file\n")
        environment = mock.patch.dict(os.environ)
        environment.start()
        self.addCleanup(environment.stop)
        for name in ("VIBE_WORKSPACE", "DISPLAY"):
            os.environ.pop(name, None)

    def refuses(self, sentence, name, *words):
        arguments, status, said, complained = call(name, *words)
        self.assertIsNone(arguments, words)
        self.assertEqual((status, said, complained.count("\n")), (2, "", 1), complained)
        self.assertTrue(complained.startswith(name + ": "), complained)
        self.assertIn(sentence, complained)
        self.assertIn("(rosrun vibe_bringup {} --help lists what there is)".format(name), complained)

    def accepts(self, name, *words):
        arguments, _, _, complained = call(name, *words)
        self.assertIsNotNone(arguments, complained)
        self.assertEqual(os.listdir(self.folder), ["file.yaml"])  # a check leaves nothing behind
        return arguments


class EveryProgram(OptionsTest):
    def test_there_are_ten(self):
        self.assertEqual(" ".join(NAMES), "cohort dataset export latency picture record replay report run views")

    def test_help(self):
        for name in NAMES:
            _, status, said, complained = call(name, "--help")
            self.assertEqual((status, complained), (0, ""))
            self.assertTrue(said.startswith("Usage: rosrun vibe_bringup " + name), said)
            self.assertLessEqual(max(map(len, said.splitlines())), 120)

    def test_unknown_options(self):
        for name in NAMES:
            self.refuses("unknown option '--no-such-option'", name, "--no-such-option")

    def test_the_name_of_the_script_is_said_in_a_workspace(self):
        os.environ["VIBE_WORKSPACE"] = "/somewhere"
        self.assertIn("(scripts/run --help lists", call("run", "--foo")[3])
        self.assertTrue(call("run", "--help")[2].startswith("Usage: scripts/run [options]"))

    def test_a_check_imports_no_ros(self):
        code = "import sys, vibe_bringup.{}; sys.exit({{'rospy', 'rosbag', 'numpy', 'yaml'}} & set(sys.modules) or 0)"
        for name in NAMES:
            subprocess.run([sys.executable, "-B", "-c", code.format(name)], check=True)

    def test_a_check_ends_before_the_program(self):
        program = [sys.executable, "-B", os.path.join(PROGRAMS, "run"), "--check"]
        done = subprocess.run([*program, "--fast"], capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, b"needs: session\n", b""))
        done = subprocess.run([*program, "--drive", "gamepad"], capture_output=True, check=False)
        self.assertEqual(done.stdout, b"needs: session devices\n")
        for words in (["--web"], ["--drive", "web", "--headless"]):
            done = subprocess.run([*program, *words], capture_output=True, check=False)
            self.assertEqual(done.stdout, b"needs: session web\n", done.stderr)
        self.assertEqual(subprocess.run([*program, "--fats"], capture_output=True, check=False).returncode, 2)


class Run(OptionsTest):
    def test_defaults(self):
        arguments = self.accepts("run")
        self.assertEqual(arguments.scene, os.path.realpath(places.find(places.SCENE)))
        self.assertTrue(arguments.script.endswith("vibe_core/trainees/first.yaml"), arguments.script)
        self.assertEqual((arguments.drive, arguments.fast, arguments.duration), ("trainee", False, None))
        self.assertTrue(arguments.output.startswith(os.path.realpath("sessions")), arguments.output)

    def test_output_lies_in_the_workspace(self):
        os.environ["VIBE_WORKSPACE"] = self.folder + "/workspace"
        self.assertIn("/workspace/sessions/", self.accepts("run").output)

    def test_values(self):
        arguments = self.accepts("run", "--fast", "--realtime", "--fast", "--duration", ".5", "--script", "grabs")
        self.assertEqual((arguments.fast, arguments.duration), (True, 0.5))
        self.assertTrue(arguments.script.endswith("vibe_core/trainees/demo/grabs.yaml"), arguments.script)
        self.assertEqual(self.accepts("run", "--mesh", "file.yaml").mesh, os.path.realpath(self.file))
        self.assertTrue(self.accepts("run", "--drive", "emulator").hand.endswith("demo/grabs.yaml"))
        self.assertEqual(self.accepts("run", "--drive", "emulator", "--hand", "random").hand, "random")
        self.assertTrue(self.accepts("run", "--drive", "gamepad").mapping.endswith("gamepads/two_stick.yaml"))

    def test_defaults_for_other_programs(self):
        arguments = run.defaults(fast=True, output="x")
        self.assertEqual((arguments.fast, arguments.output, arguments.duration), (True, "x", 0))

    def test_wrong_values(self):
        for sentence, words in (
            ("--mesh needs a value", "--mesh"),
            ("--drive needs a value", "--drive"),
            ("--script needs a value", "--script --fast"),
            ("--scene: there is no file 'nowhere.yaml'", "--scene nowhere.yaml"),
            ("no file 'package://vibe_core/no.yaml'", "--scene package://vibe_core/no.yaml"),
            ("--duration needs a number of seconds above zero, not 'long'", "--duration long"),
            ("not '0.0'", "--duration 0.0"),
            ("--drive: nobody is called 'walk'; choose one of trainee device", "--drive walk"),
            ("'left' is not known; write script:FILE", "--drive emulator --hand left"),
            ("no file 'nowhere.yaml'", "--drive emulator --hand script:nowhere.yaml"),
            ("no file 'nowhere.yaml'", "--drive gamepad --mapping nowhere.yaml"),
            ("no file 'nowhere.evemu'", "--drive gamepad --replay-pad nowhere.evemu"),
            ("no file 'nowhere.yaml'", "--drive emulator --instruments camera --vision-config nowhere.yaml"),
            ("--instruments: 'eyes' is not known; write camera", "--drive emulator --instruments eyes"),
            ("cannot write to '/proc/session' (", "--output /proc/session"),
            ("file.yaml' (it is a file); give a folder", "--output file.yaml"),
            ("--scene: '.' is a folder, not a file", "--scene ."),
            ("no file 'nobody', and vibe_core has no trainee of that name; it has expert, first", "--script nobody"),
            ("unknown option 'foo'", "foo"),
        ):
            self.refuses(sentence, "run", *words.split())

    def test_what_goes_with_what(self):
        for sentence, words in (
            ("--hand goes with --drive emulator", "--hand random"),
            ("--pad goes with --drive gamepad", "--drive device --pad Xbox"),
            ("--mapping goes with --drive gamepad", "--mapping file.yaml"),
            ("--replay-pad goes with --drive gamepad", "--replay-pad file.yaml"),
            ("--config goes with --drive emulator", "--config file.yaml"),
            ("exclude each other", "--drive gamepad --pad X --replay-pad file.yaml"),
            ("go with --instruments camera; add it", "--drive emulator --camera gige:"),
            ("'trainee' moves the instruments itself", "--instruments camera"),
            ("'gamepad' moves the instruments itself", "--drive gamepad --instruments camera --camera fake"),
            ("add --vision-config FILE", "--drive emulator --instruments camera"),
            ("remove one of them", "--drive device --instruments camera --camera fake --vision-config file.yaml"),
            ("DISPLAY is not set", "--drive keyboard"),
            ("remove --headless", "--drive keyboard --headless"),
            ("--lan goes with --web or --drive web", "--lan"),
            ("--port goes with --web or --drive web", "--drive gamepad --port 8000"),
            ("--port needs a number from 1 to 65535, not '0'", "--web --port 0"),
            ("not '65536'", "--web --port 65536"),
            ("--behind goes with --web or --drive web", "--behind https://lab.example/"),
            ("--behind needs an address such as https://lab.example/vibe/, not 'lab.example'", "--web --behind lab.example"),
            ("not 'https://lab.example/#top'", "--web --behind https://lab.example/#top"),
            ("--camera needs gige:,", "--drive emulator --instruments camera --camera eye --vision-config file.yaml"),
            ("not 'v4l2:'", "--drive emulator --instruments camera --camera v4l2: --vision-config file.yaml"),
        ):
            self.refuses(sentence, "run", *words.split())
        for driver in ("device", "emulator", "gamepad", "keyboard", "web"):
            self.refuses("'{}' drives in wall time".format(driver), "run", "--drive", driver, "--fast")
            sentence = "--script goes with --drive trainee, not with --drive " + driver
            self.refuses(sentence, "run", "--drive", driver, "--script", "first")
        self.refuses("--behind needs an address", "run", "--web", "--behind", "")
        self.accepts("run", "--drive", "device", "--config", "file.yaml")
        for address in ("https://lab.example", "HTTP://localhost:80/a/b"):
            self.assertEqual(self.accepts("run", "--web", "--behind", address).behind, address)
        words = ("--drive", "emulator", "--instruments", "camera")
        self.accepts("run", *words, "--camera", "fake")
        self.accepts("run", *words, "--camera", "gige:", "--vision-config", "file.yaml")

    def started(self, *words):
        """Names of the nodes of a session that is only pretended to start."""
        arguments = self.accepts("run", *words)
        arguments.output, arguments.headless = tempfile.mkdtemp(), True
        self.addCleanup(shutil.rmtree, arguments.output)
        with contextlib.ExitStack() as patches, contextlib.redirect_stdout(io.StringIO()):
            for name in ("start_master", "set_parameter"):
                patches.enter_context(mock.patch.object(graph.Graph, name))
            for each in (drivers.Emulator, "wait_for_devices"), (vision, "serves"):
                patches.enter_context(mock.patch.object(*each))
            patches.enter_context(mock.patch.object(places, "program", lambda _, name: name))
            start = patches.enter_context(mock.patch.object(graph.Graph, "start"))
            made = session.Session(arguments)
            self.addCleanup(made.driver.clean_up)
            made.start()
        return arguments, {call.args[0] for call in start.call_args_list}

    def test_a_session_ends_no_node_of_the_users_master(self):
        others = {"vibe_emulator", "vibe_fake_camera"}  # which are no nodes
        emulator = ("--drive", "emulator", "--instruments", "camera", "--camera", "fake")
        for words in (("--web",), ("--drive", "gamepad"), ("--drive", "device"), ("--drive", "web"), emulator):
            arguments, started = self.started("--master", *words)
            names = set(session.node_names(arguments))
            self.assertEqual(started - others, names - {"vibe_trainee"} | started & {"vibe_trainee"})
            for name in (*names, "rosout", "my_node"):
                self.check_refusal(arguments, name, name in names)

    def check_refusal(self, arguments, there, refused):
        """With a node of this name at the master: refused before there is a folder, or the session begins."""
        folder, complained = os.path.join(self.folder, "new"), io.StringIO()
        asked = argparse.Namespace(**{**vars(arguments), "output": folder})
        with contextlib.ExitStack() as patches:
            patches.enter_context(mock.patch.object(graph.Graph, "has_node", lambda _, name: name in ("/rosout", "/" + there)))
            patches.enter_context(contextlib.redirect_stderr(complained))
            begin = patches.enter_context(mock.patch.object(session, "Session"))
            patches.enter_context(mock.patch.object(session, "carry_out", return_value=0))
            self.assertEqual(session.perform(asked), int(refused), there)
        self.assertEqual((begin.called, os.path.exists(folder)), (not refused, False))
        self.assertEqual("/{} runs already".format(there) in complained.getvalue(), refused)

    def watched(self, drive, **statuses):
        """Of a session whose page, or rviz, has ended with this status, and whose simulator ends a moment later."""
        log = os.path.join(self.folder, "viewer.log")
        shown = {name: None for name in ("rviz", "page")}
        for name, status in statuses.items():
            shown[name] = mock.Mock(log=log, last_words=lambda: "words", status=lambda status=status: status)
            shown[name].name = name
        graph_ = mock.Mock(dead=lambda: shown["page"] if drive.needs_page else None)
        sim = mock.Mock(status=mock.Mock(side_effect=[None, None, None, 0, 0]))
        made = mock.Mock(spec=session.Session, sim=sim, graph=graph_, deaths={}, driver=drive, summary=self.file, **shown)
        for name in ("note_death", "is_closed"):
            setattr(made, name, getattr(session.Session, name).__get__(made))
        drive.is_done = lambda: False
        with contextlib.redirect_stdout(io.StringIO()) as said:
            session.Session.watch(made)
        return made.deaths, said.getvalue()

    def test_a_session_goes_on_without_what_only_shows_it(self):
        trainee, page, keyboard = (drivers.DRIVERS[name](None) for name in ("trainee", "web", "keyboard"))
        for shown in ({"page": -6}, {"rviz": -9}):
            deaths, said = self.watched(trainee, **shown)
            self.assertEqual((list(deaths), said.count("the session goes on without it")), (list(shown), 1))
        for drive, shown in ((page, {"page": -6}), (keyboard, {"rviz": -9}), (trainee, {"page": 1})):  # 1: no port
            with self.assertRaisesRegex(graph.GraphError, "died with status"):
                self.watched(drive, **shown)
        self.assertEqual(self.watched(trainee, page=None, rviz=None), ({}, ""))

    def test_a_page_that_was_not_built_is_said_before_anything_starts(self):
        complained = io.StringIO()
        arguments = self.accepts("run", "--web")
        with mock.patch.dict(os.environ, CMAKE_PREFIX_PATH=self.folder), contextlib.redirect_stderr(complained):
            self.assertEqual(run.run(arguments), 1)
        self.assertIn("install Node 18 or newer and npm", complained.getvalue())
        self.assertEqual(os.listdir(self.folder), ["file.yaml"])

    def test_rviz_is_an_x_client_on_a_wayland_desktop(self):
        for platform, desktop, changed in (
            (None, None, False),
            (None, "wayland-0", True),
            ("wayland;xcb", "wayland-0", True),
            ("wayland", None, True),
            ("xcb", "wayland-0", False),
        ):
            made = graph.Graph(self.folder)
            made.env = {k: v for k, v in (("QT_QPA_PLATFORM", platform), ("WAYLAND_DISPLAY", desktop)) if v}
            said = io.StringIO()
            with mock.patch.object(made, "start") as start, contextlib.redirect_stdout(said):
                made.start_rviz("x.rviz")
            self.assertEqual("QT_QPA_PLATFORM=xcb" in start.call_args[0][1], changed, (platform, desktop))
            self.assertEqual("xcb" in said.getvalue(), changed)

    def test_progress_takes_one_line_of_a_terminal(self):
        shown = graph.on_one_line(b"Open https://x/\nt = 1.00 s\n") + graph.on_one_line(b"t = 2.00 s\nstate hash: 3\n")
        self.assertEqual(shown.count(b"\n"), 2)
        self.assertEqual(shown.split(b"\r")[-1], b"state hash: 3\n")

    def test_a_second_thread_steps_where_four_cores_are(self):
        for cores, threads in ((1, 1), (3, 1), (4, 2), (64, 2)):
            with mock.patch("os.sched_getaffinity", return_value=set(range(cores))):
                self.assertEqual(session.stepping_threads(), threads, cores)

    def test_a_session_is_not_recorded_over(self):
        os.mkdir("old")
        open("old/session.bag", "wb").close()
        self.refuses("'old' already holds a session", "run", "--output", "old")

    def test_names_are_claimed_by_one_only(self):
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            names = list(pool.map(lambda _: places.claim_session("new", free_name=True), range(8)))
        self.assertEqual(sorted(names), ["new"] + ["new-{}".format(k) for k in range(2, 9)])
        for name in ("new", "new-8"):
            with self.assertRaises(FileExistsError):
                places.claim_session(name)

    def test_a_session_that_failed_before_it_recorded_leaves_its_folder(self):
        code = "import sys; sys.path.insert(0, {!r}); from vibe_bringup import places; print(places.claim_session('x'))"
        code = code.format(os.path.dirname(os.path.dirname(places.__file__)))
        for _ in range(2):  # one after the other
            self.assertEqual(subprocess.check_output([sys.executable, "-c", code], text=True), "x\n")
        self.assertFalse(places.holds_session("x"))
        for name in ("session.bag.active", "summary.txt", "session.bag"):
            open("x/" + name, "wb").close()
            self.refuses("already holds a session", "run", "--output", "x")
            self.assertNotEqual(subprocess.call([sys.executable, "-c", code], stderr=subprocess.DEVNULL), 0)
            os.remove("x/" + name)

    def test_what_people_say_of_a_session_stands_beside_its_recording(self):
        for words, said in ((), None), (("--person", "Ada Ö: 1"), {"person": "Ada Ö: 1"}), (("--notes", "a\nb", "--person", "1"),
                                                                                      {"person": "1", "notes": "a\nb"}):  # fmt: skip
            folder = tempfile.mkdtemp(dir=self.folder)
            arguments, _, _, complained = call("run", *words)
            self.assertIsNotNone(arguments, complained)
            session.Session.describe(mock.Mock(arguments=arguments, output=folder))
            file = os.path.join(folder, "session.about.yaml")
            self.assertEqual(os.path.exists(file), said is not None)
            if said:
                with open(file, encoding="utf-8") as text:
                    self.assertEqual(yaml.safe_load(text), said)


class OthersTest(OptionsTest):
    def test_recordings(self):
        for name in ("replay", "dataset"):
            self.refuses("which recording?", name)
            self.refuses("there is no file 'no.bag'", name, "no.bag")
            self.refuses("'.' is a folder, not a file", name, ".")
        self.refuses("one recording at a time, not 'b' as well", "dataset", "file.yaml", "--to", "3", "b")
        self.refuses("there is no file 'b'", "replay", "file.yaml", "--to", "3", "b")
        arguments = self.accepts("replay", "--from", "0", "file.yaml", "--to", "3")
        self.assertEqual(arguments.words, ["--from", "0", "--to", "3"])
        self.refuses("--view goes without --from", "replay", "file.yaml", "--view", "--from", "3")
        arguments = self.accepts("replay", "file.yaml", "file.yaml", "--session", "2", "--namespace", "/left")
        self.assertEqual((len(arguments.bags), arguments.words), (2, ["--session", "2", "--namespace", "/left"]))
        self.assertEqual(self.accepts("replay", "--list", "file.yaml").words, ["--list"])
        self.refuses("is there already", "replay", "--fill", "file.yaml", "file.yaml")

    def test_dataset(self):
        self.refuses("where to? --output DIR", "dataset", "file.yaml")
        self.refuses("is not empty", "dataset", "file.yaml", "--output", self.folder)
        self.refuses("is not a folder", "dataset", "file.yaml", "--output", self.file)
        arguments = self.accepts("dataset", "file.yaml", "--output", "a/b", "--no-smoke", "--field-of-view", "90")
        self.assertEqual(arguments.words, ["--field-of-view", "90", "--no-smoke"])
        known = {action.dest for action in dataset.parser()._actions}
        self.assertEqual(known - set(dataset.VALUES + dataset.FLAGS), {"bags", "output"})

    def test_record(self):
        self.refuses("whole seconds above zero, not '0.5'", "record", "--duration", "0.5")
        self.refuses("is there already", "record", "--output", "file.yaml")
        self.assertEqual(self.accepts("record", "--duration", "5").duration, 5)

    def test_pictures(self):
        pictures = self.accepts("picture", "b=2", "--view", "V", "a=1.5@W").pictures
        self.assertEqual([tuple(picture) for picture in pictures], [("a", 1.5, "W"), ("b", 2.0, "V")])
        self.assertEqual(len(self.accepts("picture").pictures), 5)
        for words in ("rest", "rest=0", "rest=x"):
            self.refuses("NAME=SECONDS[@VIEW] with seconds above zero, not '{}'".format(words), "picture", words)
        self.refuses("there is no view 'foo'", "views", "foo")
        self.refuses("--size needs WIDTHxHEIGHT in pixels, not '3'", "views", "--size", "3")
        self.assertEqual([view.name for view in self.accepts("views", "scar").views], ["scar"])
        self.assertEqual(len(self.accepts("views").views), 12)

    def test_latency(self):
        self.refuses("--blinks needs a whole number above zero, not '0'", "latency", "--blinks", "0")
        self.refuses("not 'fast'", "latency", "--rate", "fast")
        self.refuses("at most 100 Hz, not '1000'", "latency", "--rate", "1000")
        self.refuses("not '1001'", "latency", "--steps", "--rate", "1001")
        self.refuses("not '0'", "latency", "--steps", "--minutes", "0")
        self.refuses("no file 'nowhere.yaml'", "latency", "--scene", "nowhere.yaml")
        self.refuses("--lead needs 0 to 200 ms, not '201'", "latency", "--sway", "--lead", "201")
        self.refuses("goes with --sway", "latency", "--lead", "10")
        self.refuses("from 0 to 98", "latency", "--realtime", "99")
        self.refuses("is there already", "latency", "--output", self.folder)
        arguments = self.accepts("latency", "--sway")
        self.assertTrue(arguments.headless and arguments.free and arguments.camera)
        self.assertEqual(self.accepts("latency", "--steps", "--rate", "1000").rate, 1000)

    def test_sessions(self):
        self.refuses("which recording?", "report")
        self.refuses("--jobs needs a number above zero, not '0'", "report", "--jobs", "0", "a.bag")
        self.refuses("--group: 'x' is neither", "report", "--group", "x", "a.bag")
        self.refuses("--output needs a value", "report", "a.bag", "--output")
        self.refuses("which recording?", "export")
        self.refuses("'mcp' is no format; the nearest is 'mcap'", "export", "a.bag", "--to", "csv,mcp")
        self.refuses("--to-time must be later", "export", "a.bag", "--to", "csv", "--output", "x", "--from", "2", "--to-time", "1")
        self.assertEqual(self.accepts("export", "a.bag", "--to", "mesh,csv", "--output", "x").to, ["csv", "mesh"])
        self.refuses("either --output DIR or --plot DIR", "cohort")
        self.assertEqual(self.accepts("cohort", "--output", "a", "--novice", "0", "1", "--count", "2").novice, [0, 1])


if __name__ == "__main__":
    unittest.main()
