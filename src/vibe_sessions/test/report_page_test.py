"""The pages: whole, in one file, safe from what a recording says; and the program, with many bags and with bad ones."""

import base64
import csv
import html.parser
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from contextlib import redirect_stderr, redirect_stdout

import numpy
from report_bags import RADIUS, SyntheticSession

from vibe_sessions.report import main as program
from vibe_sessions.report import organ, page as pages
from vibe_sessions.report.distributions import MOST_GROUPS
from vibe_sessions.report.drawing import POINTS
from vibe_sessions.report.main import COMPARED
from vibe_sessions.report.overlay import trace_of
from vibe_sessions.report.recording import read_recording
from vibe_sessions.report.session_work import names_of, page_names
from vibe_sessions.report.tables import shown
from vibe_sessions.report.viewer import viewer_script
from vibe_sessions.report.workers import run_all

NASTY = "<script>alert('x')</script> & \"quotes\" \u202e ]]>"


class Page(html.parser.HTMLParser):
    """What a page refers to, its text, and whether its elements are closed."""

    VOID = {"meta", "img", "br", "link", "input", "hr"}

    def __init__(self, text):
        super().__init__()
        self.links, self.ids, self.text, self.open, self.scripts = [], set(), [], [], 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.links += [named[name] for name in ("src", "href", "action", "data", "srcset") if name in named]
        self.ids.add(named.get("id"))
        self.scripts += tag == "script"
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, "</{}> closes {}".format(tag, self.open[-3:])
        self.open.pop()

    def handle_data(self, data):
        self.text.append(data)


class PageTest(unittest.TestCase):
    def setUp(self):
        organ.DPI = 40  # so that the tests are quick
        pages.viewer_script = lambda: ""
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.output = os.path.join(self.folder, "out")

    def path(self, *names):
        path = os.path.join(self.folder, *names)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def make(self, *names, **options):
        return SyntheticSession(self.path(*names), **{"duration": 1.0, **options}).write()

    def report(self, *words):
        """Status and what was said on stdout and stderr."""
        said, complained = io.StringIO(), io.StringIO()
        with redirect_stdout(said), redirect_stderr(complained):
            try:
                status = program.main([*words, "--output", self.output])
            except SystemExit as end:
                status = end.code
        return status, said.getvalue(), complained.getvalue()

    def read(self, name):
        with open(os.path.join(self.output, name), encoding="utf-8", newline="") as file:
            return file.read()

    def check_whole(self, name):
        text = self.read(name)
        page = Page(text)
        self.assertEqual(page.open, [])
        for link in page.links:
            if link.startswith("#"):
                self.assertIn(link[1:], page.ids)
            elif not link.startswith("data:image/"):
                self.assertRegex(link, r"^[\w.-]+\.html$")
                self.assertTrue(os.path.exists(os.path.join(self.output, link)), link)
        for part in ("http://", "https://", "@import", "url(", "file://"):
            self.assertNotIn(part, re.sub(r"data:image/[a-z+]+;base64,[A-Za-z0-9+/=]+", "", text))
        return page


class SessionPageTest(PageTest):
    def test_one_session(self):
        status, said, complained = self.report(self.make("a.bag"))
        self.assertEqual((status, complained), (0, ""))
        self.assertEqual(said.strip(), os.path.join(self.output, "index.html"))
        page = self.check_whole("index.html")
        self.assertEqual(page.scripts, 1)
        text = " ".join(page.text)
        for part in ("13.1 ± 5.2", "34.6", "Trejos", "None of this is a grade", "suture", "0123456789abcdef"):
            self.assertIn(part, text)
        self.assertEqual(len([link for link in page.links if link.startswith("data:image/")]), 4)

    def test_which_part_of_the_wall_was_missed(self):
        metrics = {"coverage": 0.62, "coverage_region": [0.1, 0.4, 0.9, 0.8, 0.7], "coverage_wall": [0.5, 0.6, 0.7, 0.55]}
        self.report(self.make("a.bag", metrics=metrics))
        text = " ".join(" ".join(self.check_whole("index.html").text).split())
        self.assertRegex(text, r"62\.0 % of the wall seen .* Wall seen, by region and by side .* cardia 10\.0 fundus 40\.0 ")
        self.report(self.make("b.bag"))
        self.assertNotIn("by region and by side", " ".join(self.check_whole("index.html").text))  # control

    def test_organ_to_turn(self):
        pages.viewer_script = lambda: "look();"
        self.report(self.make("a.bag"))
        page = self.check_whole("index.html")
        self.assertEqual(page.scripts, 3)
        data = json.loads(next(text for text in page.text if text.startswith('{"lowest"')))
        places = numpy.frombuffer(base64.b64decode(data["places"]), "<u2").reshape(-1, 3)
        rest = numpy.frombuffer(base64.b64decode(data["rest"]), "<f4").reshape(-1, 3)
        points = numpy.array(data["lowest"]) + places * numpy.array(data["step"])
        self.assertLess(numpy.abs(points - rest).max(), 2e-6)  # half a step [m]
        self.assertEqual(len(data["sutures"]["sets"][0]["bites"]), 2)
        self.assertIn("look();", page.text)

    @unittest.skipUnless(shutil.which("chromium") and viewer_script(), "needs Chromium and the page of vibe_web")
    def test_a_browser_draws_the_organ_without_network(self):
        pages.viewer_script = viewer_script
        self.report(self.make("a.bag"))
        words = "--headless --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --ignore-gpu-blocklist"
        shown = subprocess.run(
            ["chromium", *words.split(), "--disable-dev-shm-usage", "--host-resolver-rules=MAP * ~NOTFOUND", "--dump-dom",
             "--virtual-time-budget=5000", "file://" + os.path.join(self.output, "index.html")],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=120,
        ).stdout  # fmt: skip
        drawn = re.search(r'<canvas id="organ-canvas"[^>]* data-triangles="(\d+)"', shown)
        self.assertTrue(drawn and int(drawn.group(1)) >= 2 * 384, shown[:300])  # both sides of the wall

    def test_text_of_a_recording_is_only_text(self):
        self.report(self.make("a.bag", scene_name=NASTY, event_text=NASTY, caller="/<b>me", origin=1.7e9))
        page = self.check_whole("index.html")
        self.assertEqual(page.scripts, 1)
        self.assertIn(NASTY, page.text)
        self.assertGreaterEqual("".join(page.text).count(NASTY), 2)  # the scene and the warning
        self.assertIn("<b>me", "".join(page.text))

    def test_the_parser_of_this_test_finds_what_it_must(self):
        self.assertEqual(Page("<p><script>1</script></p>").scripts, 1)
        self.assertEqual(Page('<img src="http://x/y.png">').links, ["http://x/y.png"])
        self.assertRaises(AssertionError, Page, "<p></b></p>")

    def test_person_and_notes(self):
        bag, about = self.make("a.bag"), self.path("a.about.yaml")
        for said, shown in ((None, None), ("person: " + json.dumps(NASTY), NASTY), ("notes: 17", None), ("", None)):
            if said is not None:
                with open(about, "w", encoding="utf-8") as file:
                    file.write(said)
            self.assertEqual(self.report(bag)[0], 0)
            session = json.loads(self.read("sessions.json"))["sessions"][0]["session"]
            self.assertEqual((session["person"], session["notes"]), (shown, "17" if said == "notes: 17" else None))
            row = next(csv.DictReader(io.StringIO(self.read("sessions.csv"))))
            self.assertEqual(row["person"], shown or "")
            self.assertEqual(NASTY in self.check_whole("index.html").text, shown is not None)

    def test_what_is_wrong_beside_a_recording_is_told(self):
        bag = self.make("a.bag")
        for said in ("persons: Ada", "[person", "just a name"):
            with open(self.path("a.about.yaml"), "w", encoding="utf-8") as file:
                file.write(said)
            status, _, complained = self.report(bag)
            self.assertEqual((status, complained.count("\n")), (1, 1), complained)
            self.assertIn("a.about.yaml: cannot be read", complained)
            self.assertIn("write 'person: NAME'", complained)

    def test_almost_nothing_was_recorded(self):
        only = ("applied_input", "scene")
        session = SyntheticSession(self.path("a.bag"), duration=0.1)
        put = session.put
        session.put = lambda topic, *rest, **more: put(topic, *rest, **more) if topic in only else None
        status, _, _ = self.report(session.write())
        self.assertEqual(status, 0)
        self.assertIn("no surface of the organ", " ".join(self.check_whole("index.html").text))

    def test_the_same_recording_gives_the_same_page(self):
        bag = self.make("a.bag")
        self.report(bag)
        first = self.read("index.html")
        self.report(bag)
        self.assertEqual(first, self.read("index.html"))


class ManyTest(PageTest):
    def test_pages_table_and_numbers(self):
        bags = [self.make(group, name, "session.bag") for group in ("expert", "novice") for name in ("1", "2")]
        status, _, _ = self.report(os.path.join(self.folder), "--group", "folder", "--jobs", "2")
        self.assertEqual(status, 0)
        page = self.check_whole("index.html")
        pages = sorted(link for link in page.links if link.endswith(".html"))
        self.assertEqual(pages, ["expert_1.html", "expert_2.html", "novice_1.html", "novice_2.html"])
        for each in pages:
            self.assertIn("index.html", self.check_whole(each).links)
        rows = list(csv.DictReader(io.StringIO(self.read("sessions.csv"))))
        self.assertEqual([row["group"] for row in rows], ["expert", "expert", "novice", "novice"])
        self.assertEqual([row["file"] for row in rows], bags)
        self.assertEqual(rows[0]["max_force"], "6.0")
        self.assertEqual(rows[0]["log_dimensionless_jerk"], "")  # not defined
        sessions = json.loads(self.read("sessions.json"))["sessions"]
        self.assertEqual([each["name"] for each in sessions], ["expert/1", "expert/2", "novice/1", "novice/2"])
        self.assertEqual(sessions[0]["measures"]["max_force"], 6.0)

    def test_groups_by_pattern_and_by_content(self):
        bags = [self.make("a.bag"), self.make("b.bag", scene_name="other")]
        self.report(*bags, "--no-pages", "--group", "first=*/a.bag", "--group", "second=*/b.bag")
        groups = [each["group"] for each in json.loads(self.read("sessions.json"))["sessions"]]
        self.assertEqual(groups, ["first", "second"])
        self.report(*bags, "--no-pages", "--group", "scene")
        groups = [each["group"] for each in json.loads(self.read("sessions.json"))["sessions"]]
        self.assertEqual(groups, ["test", "other"])
        self.assertEqual(sorted(os.listdir(self.output)), ["index.html", "sessions.csv", "sessions.json"])

    def test_groups_of_folders_with_dots_stay_apart(self):
        bags = [self.make(folder, "1", "session.bag") for folder in ("v1.2", "v12")]
        self.report(*bags, "--no-pages", "--group", "folder")
        groups = [each["group"] for each in json.loads(self.read("sessions.json"))["sessions"]]
        self.assertEqual(groups, ["v1.2", "v12"])

    def test_names_with_dollars_are_not_formulas(self):
        bags = [self.make(folder, "session.bag") for folder in ("$a_{$", "$b")]
        status, _, complained = self.report(*bags, "--no-pages", "--group", "folder")
        self.assertEqual(status, 0, complained)
        self.assertIn("$a_{$", " ".join(self.check_whole("index.html").text))

    def test_groups_that_are_not_drawn_are_told(self):
        bags = [self.make(f"g{k:02}", "session.bag") for k in range(MOST_GROUPS + 2)]
        self.report(*bags, "--no-pages", "--group", "folder")
        told = f"The first {MOST_GROUPS} of {MOST_GROUPS + 2} groups are drawn"
        self.assertTrue(told in self.read("index.html"))
        self.report(*bags[:MOST_GROUPS], "--no-pages", "--group", "folder")
        self.assertFalse("groups are drawn" in self.read("index.html"))

    def test_a_few_sessions_are_drawn_in_the_same_axes(self):
        bags = [self.make(f"{k}.bag") for k in range(COMPARED + 1)]
        pictures = {}
        for count in (2, COMPARED, COMPARED + 1):
            self.report(*bags[:count], "--no-pages")
            page = self.check_whole("index.html")
            pictures[count] = len([link for link in page.links if link.startswith("data:image/svg")])
            self.assertEqual("compared" in page.ids, count <= COMPARED)
        self.assertEqual(pictures, {2: 3, COMPARED: 3, COMPARED + 1: 1})  # distributions; force and path
        for topic, left in (("scope/measured_cf", 2), ("scope/measured_cp", 2), ("tissue/topology", 3)):
            self.report(bags[0], self.make("without.bag", without=(topic,)), "--no-pages")
            page = self.check_whole("index.html")
            self.assertEqual(len([link for link in page.links if link.startswith("data:image/svg")]), left, topic)

    def test_what_is_compared_is_what_was_recorded(self):
        trace = trace_of(read_recording(self.make("a.bag", duration=60)), "a")
        self.assertAlmostEqual(trace.force[:, 1].max(), 6, delta=0.01)
        self.assertLess(len(trace.path), 2 * POINTS)
        radius = numpy.hypot(trace.path[:, 1], trace.path[:, 2])
        self.assertAlmostEqual(radius.min(), RADIUS, delta=1e-6)
        self.assertAlmostEqual(radius.max(), RADIUS, delta=1e-6)

    def test_what_an_earlier_call_wrote_is_not_left(self):
        bags = [self.make("a.bag"), self.make("b.bag")]
        self.report(*bags, "--no-pages")
        status, said, _ = self.report(self.path("gone.bag"))
        self.assertEqual((status, said), (1, ""))
        self.assertFalse(os.path.exists(os.path.join(self.output, "index.html")))

    def test_bad_recordings_stop_nothing(self):
        good, bad, gone = self.make("good.bag"), self.path("bad.bag"), self.path("gone.bag")
        with open(bad, "w") as file:
            file.write(NASTY)
        with open(self.path("empty.bag"), "w"):
            pass
        cut = self.make("cut.bag", duration=3)
        os.truncate(cut, os.path.getsize(cut) // 2)
        status, _, complained = self.report(bad, gone, self.path("empty.bag"), cut, good)
        self.assertEqual(status, 1)
        sentences = [line for line in complained.splitlines() if ".bag: " in line]
        self.assertEqual(len(sentences), 3, complained)
        page = self.check_whole("index.html")
        self.assertIn("Not read", page.text)
        data = json.loads(self.read("sessions.json"))
        self.assertEqual([each["name"] for each in data["sessions"]], ["cut", "good"])
        self.assertEqual(len(data["not_read"]), 3)
        self.assertTrue(data["sessions"][0]["session"]["cut"])
        self.assertIn("was not closed", " ".join(self.check_whole("cut.html").text))

    def test_only_bad_ones(self):
        self.assertEqual(self.report(self.path("x.bag"))[0], 1)
        self.assertEqual(self.report(self.path("x.bag"), self.path("y.bag"))[0], 1)
        self.check_whole("index.html")

    def test_wrong_calls(self):
        bag = self.make("a.bag")
        os.mkdir(self.path("none"))
        for words in ([], ["--foo", bag], [bag, "--jobs", "x"], [bag, "--group", "x"], [self.path("none")]):
            status, said, complained = self.report(*words)
            self.assertEqual((status, said, complained.count("\n")), (2, "", 1), words)
        self.output = bag  # a file
        self.assertEqual(self.report(bag)[0], 2)

    def test_a_worker_that_dies_stops_nothing(self):
        def work(number):
            if number == 3:
                os._exit(9)
            if number == 5:
                raise ValueError("five")
            return 10 * number

        found = sorted(run_all(range(8), work, 2))
        self.assertEqual([each[0] for each in found], list(range(8)))
        self.assertEqual([each[0] for each in found if not each[1]], [3, 5])
        self.assertIn("status 9", found[3][2])
        self.assertEqual(found[5][2], "ValueError: five")
        self.assertEqual(found[7][2], 70)

    def test_names(self):
        self.assertEqual(names_of(["/s/a/session.bag", "/s/b/session.bag"]), ["a", "b"])
        self.assertEqual(names_of(["/s/a/session.bag"]), ["a"])
        self.assertEqual(names_of(["/s/a.bag", "/s/a.bag.active"]), ["a.bag", "a.bag.active"])
        self.assertEqual(page_names(["a/b", "a b", "index", "..", "A_B"]),
                         ["a_b.html", "a_b_2.html", "index_2.html", "session.html", "A_B_3.html"])  # fmt: skip

    def test_numbers_as_text(self):
        self.assertEqual([shown(v) for v in (None, "", True, 3, "x")], ["–", "–", "yes", "3", "x"])
        self.assertEqual(shown(-1234.567, 1, 1), "\u22121\u202f234.6")
        self.assertEqual(shown(-0.001, 1, 1), "0.0")


MEMORY = """
import resource, sys
from vibe_sessions.report.session_work import Task, report_on
task = Task(sys.argv[1], "a", "", None, sys.argv[2], "")
peaks = []
for k in range(int(sys.argv[3])):
    assert report_on(task)[2] is None
    peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print(peaks[int(0.25 * len(peaks))], peaks[-1])
"""


class MemoryTest(PageTest):
    def grown(self, page, count):
        bag = self.make("a.bag", duration=2)
        words = [sys.executable, "-B", "-c", MEMORY, bag, page, str(count)]
        before, after = map(int, subprocess.run(words, stdout=subprocess.PIPE, check=True).stdout.split())
        return after - before  # [KiB]

    def test_many_sessions_in_one_process(self):
        self.assertLess(self.grown("", 120), 3000)

    def test_many_pages_in_one_process(self):
        self.assertLess(self.grown(self.path("page.html"), 8), 15000)


if __name__ == "__main__":
    unittest.main()
