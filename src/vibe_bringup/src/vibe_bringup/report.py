"""Reports of recorded sessions. The command line; see vibe_sessions."""

import os
import shutil
import subprocess
import sys
import tempfile

from vibe_sessions.report import options

from . import cli


def parse(words):
    made = cli.Parser("report", "[options] BAG...", options.DESCRIPTION, options.EPILOG)
    options.add_options(made.options)
    made.options.add_argument("--picture", metavar="FILE", help="also takes a picture (PNG) of the top of the page; "
                              "needs chromium")  # fmt: skip
    arguments = made.parse(words)
    options.check(arguments, made.error)
    if arguments.picture and not shutil.which("chromium"):
        made.error("--picture needs a program that is not there; apt-get install chromium, or leave it out")
    arguments.fail = made.error
    return arguments


def take_picture(page, picture):
    """What a browser shows of the top of a page; whether it could."""
    with tempfile.TemporaryDirectory() as profile:
        command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                   "--window-size=1100,1650", "--user-data-dir=" + profile, "--screenshot=" + picture,
                   "file://" + os.path.realpath(page)]  # fmt: skip
        status = subprocess.run(command, capture_output=True, check=False).returncode
    if status == 0 and os.path.exists(picture) and os.path.getsize(picture) > 0:
        return True
    print("report: chromium could not write '{}'".format(picture), file=sys.stderr)
    return False


def run(arguments):
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the recordings share the cores
    from vibe_sessions.report.main import report

    status, shown = report(arguments, arguments.fail)
    if shown:
        print(shown, flush=True)
    if arguments.picture and shown and shown.endswith(".html") and not take_picture(shown, arguments.picture):
        return 1
    return status
