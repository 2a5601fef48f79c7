"""Files that are there whole or not at all, also after a power cut, a full disk or kill -9. Standard library only."""
import contextlib
import hashlib
import os


@contextlib.contextmanager
def whole(path):
    """The path of a file beside `path`, .part-NAME, to write to; once it is complete and on the disk, it takes the place
    of `path`. If writing fails, what was there before is there still. What is no ordinary file, as /dev/stdout, is
    written directly. After kill -9 the .part-NAME is left, and the next writer of NAME begins it anew."""
    if os.path.exists(path) and not os.path.isfile(path):
        yield path
        return
    target = os.path.realpath(path)  # a link stays a link
    folder, name = os.path.split(target)
    part = os.path.join(folder, ".part-" + name)
    try:
        yield part
        flush(part)
        os.replace(part, target)
        flush(folder)
    except BaseException as error:
        if isinstance(error, OSError) and error.filename in (None, part):
            error.filename = path  # of a full disk, too, the sentence says which file it is
        with contextlib.suppress(OSError):
            os.remove(part)
        raise


@contextlib.contextmanager
def open_whole(path, mode="w", encoding="utf-8", **how):
    """A file to write to, of which the same holds. Text is UTF-8."""
    with whole(path) as part, open(part, mode, encoding=None if "b" in mode else encoding, **how) as file:
        yield file


def flush(path):
    """A file or folder, from memory to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def digest(path):
    """SHA-256 of a file."""
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
