"""Options of cohorts, and their checks. Standard library only: a call is checked before anything is built."""
import argparse
import sys

DEFAULTS = {"script": "package://vibe_core/trainees/first.yaml", "scene": ["package://vibe_core/scenes/stomach.yaml"],
            "mesh": [], "count": 20, "first_seed": 1, "novice": [0.0, 1.0], "duration": 0.0}
DESCRIPTION = """\
Virtual trainees of several skills and seeds perform a protocol on one or more organs, each session in a process of its
own. DIR/cohort.csv has one row per session in the end. The same call goes on after an interruption, and --output DIR is
enough for it."""
EPILOG = "Exit status: 0; 1 if a session failed; 2 if the call is wrong; 130 if interrupted."


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


def add_options(parser):
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


def check(options, fail):
    if bool(options.output) == bool(options.plot):
        fail("it needs either --output DIR or --plot DIR")


def parse(arguments):
    parser = _Parser(prog="cohort", allow_abbrev=False, description=DESCRIPTION, epilog=EPILOG)
    add_options(parser)
    options = parser.parse_args(arguments)
    check(options, parser.error)
    return options
