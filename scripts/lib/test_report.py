"""What the run of the tests tells: a line for each test, the output of those that fail, and a summary."""

import os

MOST_LINES = 400  # of the output of a failed test
SLOWEST = 10


def say(text):
    print(text, flush=True)


def lines_of(log):
    with open(log, encoding="utf-8", errors="replace") as text:
        return text.read().splitlines()


def number(count, word):
    return "{} {}{}".format(count, word, "" if count == 1 else "s")


def cases_in_words(result):
    parts = [number(result.cases(), "case")]
    for count, word in ((len(result.failures), "failed"), (len(result.skipped), "skipped")):
        if count:
            parts.append("{} {}".format(count, word))
    return ", ".join(parts)


def show_failure(run):
    """The output of a failed test, its end if it is long, and where all of it is."""
    lines = lines_of(run.log)
    shown = "the last {} of {} lines".format(MOST_LINES, len(lines)) if len(lines) > MOST_LINES else "its output"
    say("--- {}: {}; all of it in {}".format(run.test.name, shown, run.log))
    for line in lines[-MOST_LINES:]:
        say(line)
    say("--- end of {}".format(run.test.name))


def show_script(run, verbose):
    """What a script says besides that it passed: what it skipped or, on demand, everything."""
    for line in lines_of(run.log) if verbose or run.test.is_script else []:
        if verbose or line.startswith("skipped "):
            say("          " + line)


def show_run(run, result, place, verdict, verbose):
    """The line of a finished test and what belongs to it."""
    say("{} {:<8} {}  {:.1f} s  ({})".format(place, verdict, run.test.name, run.seconds(), cases_in_words(result)))
    if result.failures:
        show_failure(run)
    else:
        show_script(run, verbose)


def covered(spans):
    """The time in which at least one of the spans (begin, end) lasted [s]."""
    total, reached = 0.0, float("-inf")
    for begin, end in sorted(spans):
        total += max(0.0, end - max(begin, reached))
        reached = max(reached, end)
    return total


def show_table(title, runs, key):
    """Wall time and test seconds of each group of runs."""
    groups = {}
    for run in runs:
        groups.setdefault(key(run), []).append(run)
    say("{:<24} {:>6} {:>12} {:>14}".format(title, "tests", "wall time", "test seconds"))
    for name, members in sorted(groups.items()) + [("all", runs)]:
        spans = [(run.begin, run.end) for run in members]
        tests = len({run.test.name for run in members})
        say("  {:<22} {:>6} {:>10.1f} s {:>12.1f} s".format(name, tests, covered(spans), sum(b - a for a, b in spans)))


def show_times(runs):
    say("Slowest:")
    for run in sorted(runs, key=lambda run: -run.seconds())[:SLOWEST]:
        say("  {:>8.1f} s  {}".format(run.seconds(), os.path.basename(run.log)[: -len(".log")]))
    show_table("Package", runs, lambda run: run.test.group)
    show_table("Kind", runs, lambda run: run.test.kind)


def show_list(title, lines):
    if lines:
        say(title)
        for line in lines:
            say("  " + line)


def skipped_sentences(results):
    """Each sentence once, with how often it was said."""
    counts = {}
    for result in results:
        for sentence in result.skipped:
            counts[sentence] = counts.get(sentence, 0) + 1
    return [s if n == 1 else "{} ({} times)".format(s, n) for s, n in sorted(counts.items())]


def show_summary(outcomes, failures, unstable, runs):
    """Everything but the closing line. `outcomes` are the results that count, `runs` all runs, also repeated ones."""
    show_list("Skipped:", skipped_sentences(outcomes))
    if runs:
        show_times(runs)
    show_list("Unstable:", ["{}: failed, and passed when it ran again alone ({}, {})".format(
        first.test.name, first.log, os.path.basename(second.log)) for first, second in unstable])
    show_list("Failed:", failures)


def closing_line(passed, failed, skipped):
    return "{} passed, {} failed".format(passed, failed) + (", {} skipped".format(skipped) if skipped else "")
