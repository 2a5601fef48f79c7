"""Cohorts of virtual trainees. The command line; see vibe_sessions."""

from vibe_sessions import cohort_options

from . import cli

USAGE = "--output DIR [options]"


def parse(words):
    made = cli.Parser("cohort", USAGE, cohort_options.DESCRIPTION, cohort_options.EPILOG)
    cohort_options.add_options(made.options)
    arguments = made.parse(words)
    cohort_options.check(arguments, made.error)
    return arguments


def run(arguments):
    from vibe_sessions.cohort import perform

    return perform(arguments)
