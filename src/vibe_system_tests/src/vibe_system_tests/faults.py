"""Breaks what is around the nodes, in a graph of its own, and looks how they take it.

One group of faults is one graph. For each fault one line goes to the report: `ok`, a tab and its name, or `not ok`,
name and reason. Rows of what was lost, how long it took to recover and what the user sees go to the table.
scripts/test.d/faults.sh has sourced the environment.
"""

import argparse
import subprocess
import sys
import tempfile
import traceback

from vibe_bringup.graph import GraphError
from vibe_bringup.session import Interrupted, interruptible

from .fault_bench import Bench, Failure


def groups():
    """Name of a group -> its class; each imports the messages of half a workspace."""
    from .faults_of_master import Master
    from .faults_of_nodes import Nodes
    from .faults_of_peers import Peers
    from .faults_of_traffic import FastTraffic, Traffic

    return {"nodes": Nodes, "master": Master, "traffic": Traffic, "fast": FastTraffic, "peers": Peers}


def parse_arguments():
    parser = argparse.ArgumentParser(allow_abbrev=False, description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--group", choices=("nodes", "master", "traffic", "fast", "peers"), default="nodes")
    parser.add_argument("--only", default="", help="part of the names of the faults wanted")
    parser.add_argument("--report", default="/dev/stdout", help="file to append to")
    parser.add_argument("--table", default="/dev/stdout", help="file to append to")
    parser.add_argument("--list", action="store_true", help="print group and name of each fault and end")
    return parser.parse_args()


def write(file, line):
    with open(file, "a", encoding="utf-8") as stream:
        stream.write(line + "\n")


def attempt(arguments, name, check):
    """One fault. Returns whether it went well."""
    print("--- " + name, flush=True)
    try:
        for row in check():
            write(arguments.table, row.text())
        write(arguments.report, "ok\t" + name)
    except (Failure, GraphError, OSError, AssertionError, subprocess.CalledProcessError) as error:
        traceback.print_exc()
        write(arguments.report, "not ok\t{}\t{}: {}".format(name, type(error).__name__, error).replace("\n", " / "))


def main():
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory(prefix="vibe-faults-") as folder:
        bench = Bench(folder)
        if arguments.list:
            for group, make in groups().items():
                print("\n".join("{}\t{}".format(group, name) for name, _ in make(bench).faults()))
            return
        group = groups()[arguments.group](bench)
        try:
            with interruptible():
                group.prepare()
                for name, check in group.faults():
                    if arguments.only in name:
                        attempt(arguments, name, check)
        except (Failure, GraphError, Interrupted) as error:
            sys.exit("faults: {}".format(error))
        finally:
            bench.end()


if __name__ == "__main__":
    main()
