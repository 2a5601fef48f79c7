"""Exports of some recordings: each is read once for all formats, and what is complete is kept."""

import contextlib
import errno
import fcntl
import hashlib
import json
import os
import shutil
import struct
import subprocess
import sys
import time

from ..report.bag_file import BagError
from ..report.main import find_bags
from ..report.session_work import names_of
from .mcap import Mcap
from .mesh import Mesh
from .options import check, parser
from .source import Source
from .tables import Csv, Parquet

WRITERS = {"csv": Csv, "parquet": Parquet, "mcap": Mcap, "mesh": Mesh}
ABOUT = "export.json"  # in each folder: of what it is


class Progress:
    """One line on a terminal that is written over."""

    def __init__(self, name):
        self._name, self._said = name, 0.0

    def __call__(self, share):
        if sys.stderr.isatty() and time.monotonic() - self._said > 0.2:
            self._said = time.monotonic()
            print("\r\033[Kexport: {} {:.0f} %".format(self._name, 100 * share), end="", file=sys.stderr, flush=True)

    def end(self):
        if self._said:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def digest_of(path):
    found = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            found.update(block)
    return found.hexdigest()


class Folder:
    """The folder of a format: made under another name, and renamed when all in it is on the disk."""

    def __init__(self, path, about):
        self.path, self._about = path, json.dumps(about, indent=1, sort_keys=True) + "\n"
        self.part = os.path.join(os.path.dirname(path), "." + os.path.basename(path) + ".part")

    def is_complete(self):
        if not os.path.lexists(self.path):
            return False
        about = os.path.join(self.path, ABOUT)
        if not os.path.exists(about) or read(about) != self._about:
            raise BagError("{}: is there already, of another recording or other options; remove it, or give another --output"
                           .format(self.path))  # fmt: skip
        print("{}: complete, kept".format(self.path), flush=True)
        return True

    def begin(self, resume=False):
        """Without what an interrupted export left there, unless it can go on from it."""
        about = os.path.join(self.part, ABOUT)
        if not (resume and os.path.exists(about) and read(about) == self._about):
            shutil.rmtree(self.part, ignore_errors=True)
            os.makedirs(self.part)

    def describe(self):
        with open(os.path.join(self.part, ABOUT), "w", encoding="utf-8") as file:
            file.write(self._about)

    def end(self):
        self.describe()
        for folder, _, names in os.walk(self.part, topdown=False):
            for name in [*names, "."]:
                sync(os.path.join(folder, name))
        os.rename(self.part, self.path)
        sync(os.path.dirname(self.path))


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def sync(path):
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextlib.contextmanager
def whole(bag, scratch):
    """The path of the same recording with every message, from repeating it."""
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


def is_compact(source):
    return source.count("step_result") < 0.9 * source.count("applied_input")


def write(arguments, path, name, folders):
    """Some formats of one recording, which is read once."""
    with Source(path, arguments.topics, arguments.begin, arguments.end, arguments.rate or 0) as source, contextlib.ExitStack() as files:
        writers = {}
        for each, folder in folders.items():
            folder.begin()
            writers[each] = WRITERS[each](folder.part, source, files)
        wanted = {each: writer.connections for each, writer in writers.items()}
        progress = Progress(name)
        for message in source.messages(set().union(*wanted.values()), progress):
            for each, writer in writers.items():
                if message.number in wanted[each]:
                    add(writer, message, source)
        progress.end()
        for each, writer in writers.items():
            print("{}: {}".format(folders[each].path, writer.finish()), flush=True)
            folders[each].end()


def add(writer, message, source):
    try:
        writer.add(message)
    except (struct.error, ValueError, KeyError) as error:
        raise source.damaged(message.connection, message.received, error) from None


def options_of(arguments, *names):
    return {name: getattr(arguments, name) for name in ("begin", "end", "rate", *names)}


def export_one(arguments, bag, name):
    """All formats of one recording that are not complete."""
    with Source(bag, None if arguments.fill else arguments.topics) as source:
        with_more = {each for each in WRITERS if is_compact(source) and (arguments.fill or WRITERS[each].needs_more(arguments))}
    about = {"recording": os.path.basename(bag), "sha256": digest_of(bag), **options_of(arguments, "topics", "fill")}
    place = os.path.join(arguments.output, name)
    folders = {each: Folder(os.path.join(place, each), {"format": each, **about}) for each in arguments.to if each in WRITERS}
    left = {each: folder for each, folder in folders.items() if not folder.is_complete()}
    os.makedirs(place, exist_ok=True)
    recorded = {each: folder for each, folder in left.items() if each not in with_more}
    if recorded:
        write(arguments, bag, name, recorded)
    if recorded.keys() != left.keys():
        with whole(bag, os.path.join(place, ".filling")) as path:
            write(arguments, path, name, {each: left[each] for each in left if each in with_more})


def export_set(arguments, bags):
    """The data set of all recordings, an episode at a time."""
    from . import lerobot

    about = {"format": "lerobot", "recordings": [[os.path.basename(bag), digest_of(bag)] for bag in bags.values()],
             **options_of(arguments, "lerobot_version", "images")}  # fmt: skip
    folder = Folder(os.path.join(arguments.output, "lerobot"), about)
    if folder.is_complete():
        return
    folder.begin(resume=True)
    made = lerobot.DataSet(folder.part, arguments)
    folder.describe()  # from here on it can be resumed
    for number, (name, bag) in enumerate(bags.items()):
        if made.has(number):
            continue
        progress = Progress(name)
        with contextlib.ExitStack() as stack:
            with Source(bag) as source:
                short = is_compact(source) and lerobot.lacks(source)
            path = stack.enter_context(whole(bag, os.path.join(arguments.output, ".filling"))) if short else bag
            try:
                made.add(path, name, progress)
            except made.error as error:
                raise BagError(str(error)) from None
        progress.end()
    print("{}: {}".format(folder.path, made.finish()), flush=True)
    folder.end()


@contextlib.contextmanager
def only_one(folder):
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError:
        raise BagError("{}: another export writes there; wait for it, or give another --output".format(folder)) from None
    finally:
        os.close(handle)


def export(arguments, fail):
    """Returns the exit status."""
    paths = find_bags(arguments, fail)
    if arguments.images and len(paths) > 1:
        fail("--images goes with one recording")
    os.makedirs(arguments.output, exist_ok=True)
    with only_one(arguments.output):
        names = names_of(paths) if len(paths) > 1 else [os.path.basename(names_of(paths)[0])]
        bags = dict(zip(names, paths))
        if set(arguments.to) & set(WRITERS):
            for name, bag in bags.items():
                export_one(arguments, bag, name)
        if "lerobot" in arguments.to:
            export_set(arguments, bags)
    return 0


def main(words=None):
    made = parser()
    arguments = made.parse_args(words)
    check(arguments, made.error)
    return run(arguments, made.error)


def run(arguments, fail):
    try:
        return export(arguments, fail)
    except BagError as problem:
        said = str(problem)
    except OSError as error:
        where = " '{}'".format(error.filename) if error.filename else " of '{}'".format(arguments.output)
        remedy = "make room there" if error.errno == errno.ENOSPC else "see to it"
        said = "{}{}; {}, and the same command goes on: formats that are complete are kept".format(
            error.strerror or error, where, remedy)  # fmt: skip
    print("export: " + said, file=sys.stderr)
    return 2
