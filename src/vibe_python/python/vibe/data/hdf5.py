"""Episodes as groups of one HDF5 file. HDF5 itself is not safe in place: a kill or a full disk in the midst of a write can
lose all of a file. So each new episode is a file of its own in `FILE.parts`, written whole, and FILE, which is replaced as a
whole, links to them; it can be read at any time. When the last one is there, all are copied into one file."""

import contextlib
import io
import json
import os
import shutil

import vibe

from . import files

PLACE = "apt-get install python3-h5py, or pip install h5py"


def opened(file, group="/"):
    """What Episodes has written, with a group that it needs, to be read."""
    h5py = files.needed("h5py", PLACE)
    try:
        found = h5py.File(file, "r")
        found[group], found.attrs["begun"]
        return found
    except (OSError, KeyError) as error:
        raise vibe.Error(f"{file} holds no such episodes as this version writes ({error}); name another file.") from None


class Episodes:
    """The episodes of `file`, which is new or was begun with the same arguments.

    name   of the group of an episode, such as "data/demo_{}"
    begun  dictionary of what they are of; a file that says anything else is refused
    """

    def __init__(self, file, name, begun):
        self._h5py = files.needed("h5py", PLACE)
        self.file, self._name, self.begun = os.path.abspath(file), name, json.loads(json.dumps(begun))
        self._parts, self._part = self.file + ".parts", lambda part: f"{os.path.basename(self.file)}.parts/{part}.hdf5"
        self._said, self._links = [], []  # attributes of each episode; (file, name) where it is elsewhere, or None where it is in `file`
        if os.path.exists(self.file):
            self._take_up()
        else:
            shutil.rmtree(self._parts, ignore_errors=True)
            self._write([], [])

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        """One file of all episodes, also where something has failed; if that is not possible then, it stays as it is."""
        with contextlib.suppress(*([vibe.Error] if kind else [])):
            self.gather()

    @property
    def seeds(self):
        return [int(attributes["seed"]) for attributes in self._said]

    def _take_up(self):
        with opened(self.file) as found:
            there = json.loads(found.attrs["begun"])
            while self._name.format(len(self._links)) in found:
                name = self._name.format(len(self._links))
                link = found.get(name, getlink=True)
                self._links.append((link.filename, link.path) if isinstance(link, self._h5py.ExternalLink) else None)
                self._said.append(dict(found[name].attrs))
        files.compare(self.file, there, self.begun)

    def add(self, content, attributes):
        """One more episode: arrays by name, and its attributes, the seed among them."""
        number = len(self._links)
        if None in self._links:  # all in one file, which becomes the first part
            shutil.rmtree(self._parts, ignore_errors=True)
            os.mkdir(self._parts)
            os.link(self.file, os.path.join(self._parts, "first.hdf5"))
            self._links = [(self._part("first"), self._name.format(k)) for k in range(number)]
        name, image = self._name.format(number), io.BytesIO()
        with self._h5py.File(image, "w") as out:
            group = out.create_group(name)
            group.attrs.update(attributes)
            for key, rows in content.items():
                group.create_dataset(key, data=rows, compression=1)
        files.write(os.path.join(os.path.dirname(self.file), self._part(number)), image.getvalue())
        self._write([*self._links, (self._part(number), name)], [*self._said, attributes])

    def _write(self, links, said):
        """The file with links to episodes; only when it is there do they count."""
        image = io.BytesIO()
        with self._h5py.File(image, "w") as out:
            for number, link in enumerate(links):
                out[self._name.format(number)] = self._h5py.ExternalLink(*link)
            self.finish(out, said)
        files.write(self.file, image.getvalue())
        self._links, self._said = links, said

    def gather(self):
        """Copies all episodes into one file."""
        if not any(self._links):
            return
        with files.replacing(self.file) as partial, open(partial, "w+b") as raw, self._h5py.File(self.file, "r") as found:
            os.posix_fallocate(raw.fileno(), 0, int(1.1 * sum(one.stat().st_size for one in os.scandir(self._parts))) + 1000000)
            reserved = _Reserved(raw)
            with self._h5py.File(reserved, "w") as out:
                for name in map(self._name.format, range(len(self._links))):
                    found.copy(found[name], out, name)
                self.finish(out, self._said)
            raw.truncate(reserved.end)
        self._links = [None] * len(self._links)
        shutil.rmtree(self._parts, ignore_errors=True)

    def finish(self, out, said):
        """Adds to a file what is of all episodes, whose attributes are given; subclasses add more."""
        out.attrs["begun"] = json.dumps(self.begun)


class _Reserved:
    """A file whose place on the disk is reserved: HDF5 ends the process when it cannot write."""

    def __init__(self, raw):
        self._raw, self.end = raw, 0
        self.tell, self.read, self.readinto, self.flush = raw.tell, raw.read, raw.readinto, raw.flush

    def seek(self, offset, whence=os.SEEK_SET):
        return self._raw.seek(self.end + offset) if whence == os.SEEK_END else self._raw.seek(offset, whence)

    def truncate(self, size):
        self.end = size

    def write(self, data):
        count = self._raw.write(data)
        self.end = max(self.end, self._raw.tell())
        return count
