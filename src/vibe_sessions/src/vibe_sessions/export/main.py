"""Exports of some recordings: each is read once for all formats, and what is complete is kept."""

import contextlib
import errno
import fcntl
import json
import os
import shutil
import struct
import subprocess
import sys

from ..report.bag_file import BagError
from ..report.main import find_bags
from ..report.session_work import names_of
from ..whole_file import digest, flush
from .mcap import Mcap
from .mesh import KEPT, Mesh
from .options import check, parser
from .source import Source
from .tables import Csv, Parquet

WRITERS = {"csv": Csv, "parquet": Parquet, "mcap": Mcap, "mesh": Mesh}
ABOUT = "export.json"  # in each folder: of what it is


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


class Folder:
    """The folder of a format: made under another name, and renamed when all in it is on the disk."""

    def __init__(self, place, name, arguments, *options, **about):
        about.update({each: getattr(arguments, each) for each in ("begin", "end", "rate", *options)}, format=name)
        self.path, self.part = os.path.join(place, name), os.path.join(place, "." + name + ".part")
        self._about = json.dumps(about, indent=1, sort_keys=True) + "\n"

    def is_complete(self):
        about = os.path.join(self.path, ABOUT)
        if os.path.exists(about) and read(about) == self._about:
            print("{}: complete, kept".format(self.path), flush=True)
        elif os.path.lexists(self.path):
            raise BagError("{}: is there already, of another recording or other options; remove it, or give another --output".format(
                self.path))  # fmt: skip
        return os.path.lexists(self.path)

    @contextlib.contextmanager
    def begun(self):
        """What was not finished does not take the room of the next call; after a kill it is still there."""
        shutil.rmtree(self.part, ignore_errors=True)
        try:
            os.makedirs(self.part)
            yield self.part
        finally:
            shutil.rmtree(self.part, ignore_errors=True)

    def end(self, what):
        with open(os.path.join(self.part, ABOUT), "w", encoding="utf-8") as file:
            file.write(self._about)
        for folder, _, names in os.walk(self.part, topdown=False):
            for name in [*names, "."]:
                flush(os.path.join(folder, name))
        os.rename(self.part, self.path)
        flush(os.path.dirname(self.path))
        print("{}: {}".format(self.path, what), flush=True)


@contextlib.contextmanager
def whole(bag, scratch, is_asked):
    """The path of a recording, or, if it is asked for, of the same with every message, from repeating it."""
    if not is_asked:
        yield bag
        return
    shutil.rmtree(scratch, ignore_errors=True)  # of an export that was interrupted
    os.makedirs(scratch)
    try:
        path, said = os.path.join(scratch, "whole.bag"), os.path.join(scratch, "said.txt")
        print("repeating {}, to have every message of it".format(bag), flush=True)
        with open(said, "w", encoding="utf-8") as file:
            command = ["rosrun", "vibe_sim", "vibe_replay", "--fill", path, bag]
            status = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode
        if status not in (0, 3):  # 3: an older release has no hashes to compare with
            last = (read(said).strip().splitlines() or ["it says nothing"])[-1]
            raise BagError("{}: does not repeat, so what it leaves out cannot be added ({}); export what it has to csv, parquet "
                           "or mcap without --fill".format(bag, last))  # fmt: skip
        yield path
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def write(arguments, path, folders):
    """Some formats of one recording, which is read once."""
    with Source(path, arguments.topics, arguments.begin, arguments.end, arguments.rate) as source, contextlib.ExitStack() as files:
        writers = {}
        for name, folder in folders.items():
            writers[name] = WRITERS[name](files.enter_context(folder.begun()), source, files)
        for message in source.messages(set().union(*(writer.connections for writer in writers.values()))):
            for writer in writers.values():
                if message.number in writer.connections:
                    try:
                        writer.add(message)
                    except (struct.error, ValueError, KeyError) as error:
                        raise source.damaged(message.connection, message.received, error) from None
        for name, writer in writers.items():
            folders[name].end(writer.finish())


def export_one(arguments, bag, place):
    """All formats of one recording that are not complete."""
    with Source(bag, None if arguments.fill else arguments.topics) as source:
        is_compact = source.is_compact()
    about = {"recording": os.path.basename(bag), "sha256": digest(bag)}
    folders = {name: Folder(place, name, arguments, "topics", "fill", **about) for name in arguments.to if name in WRITERS}
    left = {name: folder for name, folder in folders.items() if not folder.is_complete()}
    for fill in (False, True):
        asked = {name: folder for name, folder in left.items()
                 if fill == (is_compact and (arguments.fill or (name == "mesh" and (arguments.rate or 0) > KEPT)))}  # fmt: skip
        if asked:
            os.makedirs(place, exist_ok=True)
            with whole(bag, os.path.join(place, ".filling"), fill) as path:
                write(arguments, path, asked)


def export_set(arguments, bags):
    """The data set of all recordings."""
    from . import lerobot

    recordings = [[os.path.basename(bag), digest(bag)] for bag in bags.values()]
    folder = Folder(arguments.output, "lerobot", arguments, "lerobot_version", "images", recordings=recordings)
    if folder.is_complete():
        return
    with folder.begun():
        made, rows = lerobot.DataSet(folder.part, arguments), ["session,episodes so far"]
        for name, bag in bags.items():
            with Source(bag) as source:
                fill = source.is_compact() and bool(lerobot.lacks(source))
            with whole(bag, os.path.join(arguments.output, ".filling"), fill) as path:
                with Source(path, None, arguments.begin, arguments.end) as source:
                    rows.append("{},{}".format(name, made.add(source)))
        with open(os.path.join(folder.part, "sessions.csv"), "w", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")
        folder.end(rows[-1].rsplit(",", 1)[1] + " episodes")


def export(arguments, fail):
    """Returns the exit status; one bad recording does not stop the others."""
    status, paths = 0, find_bags(arguments, fail)
    if arguments.images and len(paths) > 1:
        fail("--images goes with one recording")
    names = names_of(paths) if len(paths) > 1 else [os.path.basename(names_of(paths)[0])]
    for name, bag in zip(names, paths):
        try:
            export_one(arguments, bag, os.path.join(arguments.output, name))
        except BagError as problem:
            print("export: {}".format(problem), file=sys.stderr)
            status = 2
    if "lerobot" in arguments.to and status == 0:
        export_set(arguments, dict(zip(names, paths)))
    return status


def run(arguments, fail):
    """Returns the exit status."""
    try:
        os.makedirs(arguments.output, exist_ok=True)
        handle = os.open(arguments.output, os.O_RDONLY)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return export(arguments, fail)
        finally:
            os.close(handle)
    except BlockingIOError:
        said = "{}: another export writes there; wait for it, or give another --output".format(arguments.output)
    except BagError as problem:
        said = str(problem)
    except OSError as error:
        where = " '{}'".format(error.filename) if error.filename else " of '{}'".format(arguments.output)
        remedy = "make room there" if error.errno == errno.ENOSPC else "see to it"
        said = "{}{}; {}, and the same command goes on: formats that are complete are kept".format(
            error.strerror or error, where, remedy)  # fmt: skip
    except KeyboardInterrupt:
        said = "interrupted; the same command goes on, and formats that are complete are kept"
    print("export: " + said, file=sys.stderr)
    return 2


def main(words=None):
    made = parser()
    arguments = made.parse_args(words)
    check(arguments, made.error)
    return run(arguments, made.error)
