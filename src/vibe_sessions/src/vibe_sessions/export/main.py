"""Exports of some recordings: each is read once for all formats, and what is complete is kept."""

import contextlib
import errno
import fcntl
import json
import os
import shutil
import struct
import sys

from ..headless import SessionError, call, find_program
from ..report.bag_file import BagError
from ..report.main import find_bags
from ..report.session_work import names_of
from ..whole_file import digest, flush, open_whole
from .gltf import Gltf
from .mcap import Mcap
from .mesh import KEPT, Mesh
from .options import check, parser
from .source import Source
from .tables import Csv, Parquet

WRITERS = {"csv": Csv, "parquet": Parquet, "mcap": Mcap, "mesh": Mesh, "gltf": Gltf}
ABOUT = "export.json"  # in each folder: of what it is


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


class Folder:
    """The folder of a format: made under another name, and renamed when all in it is on the disk. What is finished is kept, and
    nothing that is half done has a final name."""

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

    def resume(self):
        """For what is made of whole parts, which are kept, too, if they were described as those of the same call."""
        about = os.path.join(self.part, ABOUT)
        if os.path.exists(about) and read(about) != self._about:
            print("{}: begins again; what was there is of other options or recordings".format(self.path), flush=True)
        if not os.path.exists(about) or read(about) != self._about:
            shutil.rmtree(self.part, ignore_errors=True)
        os.makedirs(self.part, exist_ok=True)

    def describe(self):
        with open_whole(os.path.join(self.part, ABOUT)) as file:
            file.write(self._about)

    def end(self, what):
        self.describe()
        for folder, _, names in os.walk(self.part, topdown=False):
            for name in [*names, "."]:
                flush(os.path.join(folder, name))
        os.rename(self.part, self.path)
        flush(os.path.dirname(self.path))
        print("{}: {}".format(self.path, what), flush=True)


@contextlib.contextmanager
def whole(bag, sha, scratch, is_asked):
    """The path of a recording, or, if it is asked for, of the same with every message, from repeating it."""
    if not is_asked:
        yield bag
        return
    path = os.path.join(scratch, sha + ".bag")
    try:
        if not os.path.exists(path):  # else an export was killed that had repeated it
            shutil.rmtree(scratch, ignore_errors=True)
            os.makedirs(scratch)
            repeat(bag, path)
        yield path
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def repeat(bag, path):
    print("repeating {}, to have every message of it".format(bag), flush=True)
    try:  # status 3: an older release has no hashes to compare with
        call(["--fill", path, bag], program=find_program("vibe_sim", "vibe_replay"), accepted=(0, 3))
    except SessionError as error:
        raise BagError("{}: does not repeat, so what it leaves out cannot be added ({}); export what it has to csv, parquet "
                       "or mcap without --fill".format(bag, str(error))) from None  # fmt: skip


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
                 if fill == (is_compact and (arguments.fill or (name in ("mesh", "gltf") and (arguments.rate or 0) > KEPT)))}  # fmt: skip
        if asked:
            os.makedirs(place, exist_ok=True)
            with whole(bag, about["sha256"], os.path.join(place, ".filling"), fill) as path:
                write(arguments, path, asked)
    shutil.rmtree(os.path.join(place, ".filling"), ignore_errors=True)  # of an export that was killed


def pictures_digest(folder):
    from .pictures import digest_of

    try:
        return digest_of(folder)
    except OSError as error:
        raise BagError("--images: '{}' is no folder of scripts/dataset ({}); name another".format(folder, error)) from None


def export_set(arguments, bags):
    """The data set of all recordings. Goes on after the last finished episode, and repeats no recording that has all of its own."""
    from . import lerobot

    recordings = [[os.path.basename(bag), digest(bag)] for bag in bags.values()]
    drawn = {"pictures": pictures_digest(arguments.images)} if arguments.images else {}
    folder = Folder(arguments.output, "lerobot", arguments, "lerobot_version", "images", recordings=recordings, **drawn)
    if folder.is_complete():
        return
    folder.resume()
    with Source(next(iter(bags.values()))) as source:
        made, table = lerobot.DataSet(folder.part, arguments, source), os.path.join(folder.part, "sessions.csv")
    folder.describe()
    rows, before = read(table).splitlines() if os.path.exists(table) else ["session,episodes so far"], 0
    if len(rows) > 1:
        before = int(rows[-1].rpartition(",")[2])
    for (name, bag), (_, sha) in list(zip(bags.items(), recordings))[len(rows) - 1 :]:
        with Source(bag) as source:
            fill = source.is_compact() and bool(lerobot.lacks(source))
        with whole(bag, sha, os.path.join(arguments.output, ".filling"), fill) as path:
            with Source(path, None, arguments.begin, arguments.end) as source:
                before = made.add(source, before)
        rows.append("{},{}".format(name, before))
        with open_whole(table) as file:
            file.write("\n".join(rows) + "\n")
    shutil.rmtree(os.path.join(arguments.output, ".filling"), ignore_errors=True)
    folder.end("{} episodes".format(before))


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
