"""An export that is killed at one of its operations on files, as kill -9 and a power cut may do at any."""

import builtins
import contextlib
import itertools
import os
import signal


def killed(at, action):
    """Calls `action` in a process of its own, which SIGKILL ends as it opens, synchronises or renames a file for the `at`-th
    time; its status."""
    child = os.fork()
    if child == 0:
        calls = itertools.count()

        def counted(function):
            def called(*arguments, **options):
                if next(calls) == at:
                    os.kill(os.getpid(), signal.SIGKILL)
                return function(*arguments, **options)

            return called

        status = 70  # of an exception, which may not go on in the tests of the parent
        try:
            with open(os.devnull, "w", encoding="utf-8") as nothing, contextlib.redirect_stdout(nothing):
                for module, name in ((builtins, "open"), (os, "fsync"), (os, "rename"), (os, "replace")):
                    setattr(module, name, counted(getattr(module, name)))
                status = action()
        finally:
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
