"""Cohorts of virtual trainees: the command line."""
import argparse
import collections
import os
import signal
import sys

from vibe_sessions.cohort_local import run_local
from vibe_sessions.cohort_plan import Plan
from vibe_sessions.cohort_progress import Progress
from vibe_sessions.cohort_store import Store
from vibe_sessions.headless import SessionError

DEFAULTS = {"script": "package://vibe_core/trainees/first.yaml", "scene": ["package://vibe_core/scenes/stomach.yaml"],
            "mesh": [], "count": 20, "first_seed": 1, "novice": [0.0, 1.0], "duration": 0.0}


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.stderr.write(f"{self.prog}: {message}; see --help.\n")
        sys.exit(2)


def _number(kind, low, high, what):
    def read(text):
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not low <= value <= high:
            raise argparse.ArgumentTypeError(f"'{text}' is not {what}")
        return value
    return read


def parse(arguments):
    parser = _Parser(prog="cohort", allow_abbrev=False, description="Virtual trainees of several skills and seeds "
                     "perform a protocol on one or more organs, each in a process of its own. Call it again with the "
                     "same folder to go on.")
    count = _number(int, 1, 100000, "a whole number from 1 to 100000")
    parser.add_argument("--output", metavar="DIR", help="folder of the cohort: plan, rows, table")
    parser.add_argument("--plot", metavar="DIR", help="draw the learning curve of that cohort, and end")
    parser.add_argument("--picture", metavar="FILE", help="of --plot (default: DIR/learning_curve.png)")
    parser.add_argument("--script", metavar="F", help="protocol of goals (default: %s)" % DEFAULTS["script"])
    parser.add_argument("--scene", metavar="F", nargs="+", help="scenes (default: %s)" % DEFAULTS["scene"][0])
    parser.add_argument("--mesh", metavar="F", nargs="+", help="surfaces of organs instead of those of the scenes")
    parser.add_argument("--count", metavar="N", type=count, help="trainees per skill and organ (default: 20)")
    parser.add_argument("--first-seed", metavar="S", type=_number(int, 0, 2**53 - 100001, "a seed"),
                        help="of the first of them (default: 1)")
    parser.add_argument("--novice", metavar="P", nargs="+", type=_number(float, 0, 1, "a skill from 0 to 1"),
                        help="skills, 0: expert to 1: novice (default: 0 1)")
    parser.add_argument("--duration", metavar="S", type=_number(float, 0, 1e6, "a number of seconds"),
                        help="simulated seconds at most (default: until the goals have ended)")
    parser.add_argument("--jobs", metavar="N", type=count, help="sessions at a time (default: one per core; with a "
                        "scheduler two per thread of its workers)")
    parser.add_argument("--scheduler", metavar="HOST:PORT", help="perform the sessions on the workers of this Dask "
                        "scheduler")
    options = parser.parse_args(arguments)
    if bool(options.output) == bool(options.plot):
        parser.error("it needs either --output DIR or --plot DIR")
    return options


def plan_for(options, store):
    """The plan of the command line; without any option of a plan, that of the folder with the present versions."""
    given = {key: getattr(options, key) for key in DEFAULTS if getattr(options, key) is not None}
    if given or not store.has_plan():
        return Plan.make(argparse.Namespace(**{**DEFAULTS, **given}))
    there = Plan.load(store.path("cohort.yaml")).content
    return Plan.make(argparse.Namespace(script=there["script"], scene=there["scenes"], mesh=there["meshes"],
                                        **{key: there[key] for key in ("novice", "first_seed", "count", "duration")}))


def outcomes(sessions, options):
    if options.scheduler:
        from vibe_sessions.cohort_dask import run_dask  # takes a second to import
        return run_dask(sessions, options.scheduler, options.jobs or 0)
    return run_local(sessions, options.jobs or len(os.sched_getaffinity(0)))


def perform_all(plan, store, options):
    """Returns the sessions that failed, in the order of the plan: [(key, reason)]."""
    finished = sum(store.has(session) for session in plan.sessions())
    progress, failures = Progress(len(plan), finished), {}
    open_sessions = (session for session in plan.sessions() if not store.has(session))
    results = outcomes(open_sessions, options)
    try:
        for session, row, reason in results:
            if row is None:
                failures[session.key] = reason
            else:
                store.keep(session, row)
            progress.add(failed=row is None)
    finally:
        results.close()
    return [(session.key, failures[session.key]) for session in plan.sessions() if session.key in failures]


def report(store, failures):
    """One line per reason."""
    reasons = collections.defaultdict(list)
    for key, reason in failures:
        reasons[reason].append(key)
    for reason, keys in reasons.items():
        more = f" and {len(keys) - 1} more" if len(keys) > 1 else ""
        sys.stderr.write(f"cohort: {keys[0]}{more} failed: {reason}\n")
    if failures:
        sys.stderr.write(f"cohort: {len(failures)} failed; '{store.path('failed.csv')}' lists them, and the same call "
                         "tries them again.\n")


def run(options):
    store = Store(options.output)
    try:
        plan = plan_for(options, store)
        store.adopt(plan)
        failures = perform_all(plan, store, options)
        store.write_table(plan)
        store.write_failures(failures)
        report(store, failures)
        print(store.path("cohort.csv"))
        return 1 if failures else 0
    finally:
        store.close()


def plot(options):
    from vibe_sessions.cohort_plot import draw  # matplotlib takes a second to import
    picture = options.picture or os.path.join(options.plot, "learning_curve.png")
    draw(os.path.join(options.plot, "cohort.csv"), picture)
    print(picture)
    return 0


def _interrupt(*_):
    raise KeyboardInterrupt


def main(arguments):
    options = parse(arguments)
    signal.signal(signal.SIGTERM, _interrupt)
    try:
        return plot(options) if options.plot else run(options)
    except SessionError as error:
        sys.stderr.write(f"cohort: {error}\n")
        return 2
    except KeyboardInterrupt:
        where = f" --scheduler {options.scheduler}" if options.scheduler else ""
        sys.stderr.write("\ncohort: interrupted; what is done is kept, and "
                         f"`scripts/cohort --output {options.output}{where}` goes on.\n")
        return 130
