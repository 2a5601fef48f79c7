"""Runs one test for ctest: with folders of its own for ROS and for sockets, and so that nothing it starts outlives it.

Usage: run_test.py SCRATCH LOG RESULT COMMAND [ARGUMENT...]. LOG gets the output. RESULT is the file into which the test
writes its cases, `lines` if it prints them, or empty. LOG.seconds gets the processor time. The test passes if the command ends with status 0, no case has
failed and, where there is a RESULT, there is at least one case.
"""

import os
import resource
import shutil
import signal
import sys

import guard
import test_results


def end_of(status):
    """In words, how a command ended; a shell adds 128 to the number of a signal."""
    number = status - 128
    by_signal = number in signal.valid_signals()
    return "was ended by {}".format(signal.Signals(number).name) if by_signal else "ended with status {}".format(status)


def main():
    scratch, log, result_file, *command = sys.argv[1:]
    guard.prctl(guard.PR_SET_PDEATHSIG, signal.SIGKILL)  # when ctest is killed; the guard's other process sees it
    output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(output, 1)
    os.dup2(output, 2)
    if result_file and os.path.exists(result_file):
        os.remove(result_file)
    scratch = os.path.join(scratch, str(os.getpid()))
    for name, folder in ("ROS_HOME", "ros"), ("XDG_RUNTIME_DIR", "run"):
        os.environ[name] = os.path.join(scratch, folder)
        os.makedirs(os.environ[name], mode=0o700)
    status = guard.run(command)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log + ".seconds", "w", encoding="ascii") as file:  # not whole: a log
        file.write("{:.1f}".format(used.ru_utime + used.ru_stime))
    shutil.rmtree(scratch, ignore_errors=True)
    end = end_of(status)
    if status == 0 and not test_results.read(log, result_file).is_good():
        status, end = 1, "no good case in it"
    if status:
        print(test_results.END + end, flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
