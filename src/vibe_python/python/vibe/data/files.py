"""Files that are there whole or not at all, on a full disk and after a kill, too."""

import contextlib
import importlib
import os

import vibe

PARTIAL = ".part"  # ending of a file that is being written


def needed(module, where):
    """A module that is optional, or vibe.Error with the place to get it from."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise vibe.Error(f"This data set needs the Python module {module} ({error}); install it: {where}.") from None


@contextlib.contextmanager
def replacing(path):
    """The name to write a file under; it becomes `path` when all of it is on the disk, and what was there stays until then."""
    partial = os.fspath(path) + PARTIAL
    try:
        os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
        yield partial
        with open(partial, "rb") as file:
            os.fsync(file.fileno())
        os.replace(partial, path)
        folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
        os.fsync(folder)
        os.close(folder)
    except OSError as error:
        raise vibe.Error(f"{path} cannot be written ({error.strerror or error}); finished episodes are kept: make room or permit it, "
                         "and the same call goes on.") from None
    finally:
        with contextlib.suppress(OSError):
            os.remove(partial)


def write(path, data):
    with replacing(path) as partial, open(partial, "wb") as file:
        file.write(data)


def compare(place, there, here):
    """Both are dictionaries; raises vibe.Error with the first thing in which what is there is another than what is wanted."""
    for name in dict.fromkeys([*there, *here]):
        if there.get(name) != here.get(name):
            old, new = there.get(name), here.get(name)
            if isinstance(old, dict) and isinstance(new, dict):
                compare(place, {f"{name} {key}": old[key] for key in old}, {f"{name} {key}": new[key] for key in new})
            raise vibe.Error(f"{place} is of other settings: its {name} is {old!r}, and here it is {new!r}; go on with the same, or name another place.")


def same_names(what, given, wanted):
    missing, strange = [name for name in wanted if name not in given], [name for name in given if name not in wanted]
    if missing or strange:
        raise vibe.Error(f"The {what} {'lack' if missing else 'have'} {(missing or strange)[0]!r}; give {', '.join(wanted) or 'none'}.")
