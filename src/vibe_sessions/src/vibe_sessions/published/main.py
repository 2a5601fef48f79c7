"""Makes a set of sessions to be published."""
import csv
import functools
import os
import resource
import time

from vibe_sessions.cohort import perform_all, report
from vibe_sessions.cohort_options import _number, _Parser
from vibe_sessions.cohort_store import Store
from vibe_sessions.headless import status_of
from vibe_sessions.published.baselines import COLUMNS, baselines
from vibe_sessions.published.card import LICENCE, card
from vibe_sessions.published.member import make_member
from vibe_sessions.published.plan import MOST, SetPlan, key_of, member, split_of, write_scenes
from vibe_sessions.whole_file import digest, open_whole

DESCRIPTION = """\
Makes sessions of experts and novices on all shipped stomachs in three grades of breathing, with forces, contacts, deformation,
pictures, splits, checksums, a card and baselines. The same call goes on after an interruption. Page: docs/data_set.md."""


def parse(words):
    parser = _Parser(prog="publish_set", allow_abbrev=False, description=DESCRIPTION)
    count = _number(int, 1, MOST, f"a whole number from 1 to {MOST}")
    parser.add_argument("--output", metavar="DIR", required=True, help="folder of the set; of workers, too")
    parser.add_argument("--count", metavar="N", type=count, default=200, help="sessions (default: 200)")
    parser.add_argument("--rate", metavar="HZ", type=_number(float, 0.1, 60, "a rate from 0.1 to 60"), default=1.0,
                        help="pictures per second (default: 1)")
    parser.add_argument("--duration", metavar="S", type=_number(float, 0, 1e6, "a number of seconds"), default=0.0,
                        help="of a session at most (default: until its goals have ended)")
    parser.add_argument("--jobs", metavar="N", type=_number(int, 1, 1000, "a whole number from 1 to 1000"), help="sessions at a time")
    parser.add_argument("--scheduler", metavar="HOST:PORT", help="make them on the workers of this Dask scheduler")
    return parser.parse_args(words)


def files_below(folder):
    """Their paths in the folder, in order; not those by which an interrupted call goes on."""
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if name != "rows" and not name.startswith("."))
        yield from (os.path.relpath(os.path.join(place, name), folder) for name in sorted(names)
                    if not name.startswith(".") and name not in ("SHA256SUMS", "cohort.yaml"))


def describe(plan, folder):
    """Everything beside the sessions."""
    place = functools.partial(os.path.join, folder)
    with open_whole(place("splits.csv"), newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("session", "organ", "breathing", "person", "skill", "split"))
        writer.writerows((key_of(k), *member(k), "novice" if member(k)[2] % 2 else "expert", split_of(k)) for k in range(len(plan)))
    rows = baselines(folder, len(plan))
    with open_whole(place("baselines.csv"), newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])
    for name, text in (("README.md", card(plan, rows)), ("LICENSE", LICENCE)):
        with open_whole(place(name)) as file:
            file.write(text)
    with open_whole(place("SHA256SUMS")) as file:
        file.writelines(f"{digest(place(name))}  {name}\n" for name in files_below(folder))


def say_cost(made, begin, folder, count):
    """What this call took, and what 200 sessions would, by the rule of three."""
    if made == 0:
        return
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds, cpu = time.monotonic() - begin, used.ru_utime + used.ru_stime
    size = sum(os.path.getsize(os.path.join(folder, name)) for name in files_below(folder)) / count
    print(f"{made} sessions in {seconds:.0f} s, {cpu / made:.0f} s of CPU time and {size / 1e6:.1f} MB each; 200 would take about "
          f"{200 * cpu / made / 3600:.1f} core hours and {200 * size / 1e9:.1f} GB (computed from these)")


def run(options):
    store, begin = Store(options.output), time.monotonic()
    try:
        write_scenes(store.path("scenes"))
        plan = SetPlan.make(options)
        store.adopt(plan)
        open_before = sum(not store.has(session) for session in plan.sessions())
        work = functools.partial(make_member, folder=os.path.abspath(options.output), rate=options.rate)
        failures = perform_all(plan, store, options, work)
        store.write_table(plan)
        store.write_failures(failures)
        report(store, failures)
        if failures:
            return 1
        describe(plan, options.output)
        say_cost(open_before if not options.scheduler else 0, begin, options.output, len(plan))
        print(store.path("README.md"))
        return 0
    finally:
        store.close()


def main(words):
    options = parse(words)
    return status_of("publish_set", lambda: run(options), "what is done is kept, and the same call goes on")
