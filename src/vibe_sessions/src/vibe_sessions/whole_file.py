"""Files that are there whole or not at all, also after a power cut, a full disk or kill -9. Standard library only."""
import contextlib
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
        _flush(part)
        os.replace(part, target)
        _flush(folder)
    except BaseException:
        with contextlib.suppress(OSError):
            os.remove(part)
        raise


def write_whole(path, text):
    """A text, as UTF-8; bytes as they are."""
    data = text if isinstance(text, bytes) else text.encode("utf-8", "replace")
    with whole(path) as part, open(part, "wb") as file:
        file.write(data)


def _flush(path):
    """From memory to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
