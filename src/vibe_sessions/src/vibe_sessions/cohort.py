"""Cohorts of virtual trainees."""
import argparse
import collections
import os
import sys

from vibe_sessions.cohort_local import run_local
from vibe_sessions.cohort_options import DEFAULTS, parse
from vibe_sessions.cohort_plan import Plan
from vibe_sessions.cohort_progress import Progress
from vibe_sessions.cohort_session import perform as perform_session
from vibe_sessions.cohort_store import Store
from vibe_sessions.headless import status_of


def plan_for(options, store):
    """The plan of the command line; without any option of a plan, that of the folder with the present versions."""
    given = {key: getattr(options, key) for key in DEFAULTS if getattr(options, key) is not None}
    if given or not store.has_plan():
        return Plan.make(argparse.Namespace(**{**DEFAULTS, **given}))
    there = Plan.load(store.path("cohort.yaml")).content
    return Plan.make(argparse.Namespace(script=there["script"], scene=there["scenes"], mesh=there["meshes"],
                                        **{key: there[key] for key in ("novice", "first_seed", "count", "duration")}))


def outcomes(sessions, options, work):
    if options.scheduler:
        from vibe_sessions.cohort_dask import run_dask  # takes a second to import
        return run_dask(sessions, options.scheduler, options.jobs or 0, work)
    return run_local(sessions, options.jobs or len(os.sched_getaffinity(0)), work)


def perform_all(plan, store, options, work=perform_session):
    """work(session, stopped) makes the row of a session. Returns the sessions that failed, in the order of the plan: [(key, reason)]."""
    finished = sum(store.has(session) for session in plan.sessions())
    progress, failures = Progress(len(plan), finished), {}
    open_sessions = (session for session in plan.sessions() if not store.has(session))
    results = outcomes(open_sessions, options, work)
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


def main(arguments):
    return perform(parse(arguments))


def perform(options):
    """The exit status."""
    where = f" --scheduler {options.scheduler}" if options.scheduler else ""
    return status_of("cohort", lambda: plot(options) if options.plot else run(options),
                     f"what is done is kept, and `scripts/cohort --output {options.output}{where}` goes on")
