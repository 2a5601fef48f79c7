"""The plan of a cohort: its sessions by name, the files they read, and the versions that perform them."""
import dataclasses
import glob
import hashlib
import itertools
import os
from xml.etree import ElementTree

import rospkg
import yaml

from vibe_sessions.headless import SessionError, find_program

FORMAT = 2  # of cohort.yaml
SCOPE = "package://vibe_description/urdf/scope.urdf"  # of scenes that name none
KEYS = {"versions", "script", "scenes", "meshes", "novice", "first_seed", "count", "duration", "digests"}


@dataclasses.dataclass(frozen=True)
class Session:
    """What one child process performs. Plain data: it travels to other machines."""

    key: str
    script: str
    scene: str
    mesh: str  # "": the organ of the scene
    novice: float
    seed: int
    duration: float  # 0: until the goals have ended
    digests: tuple  # of (address, SHA-256) of the files above
    versions: tuple  # of the simulator, as items of versions()


def resolve(address):
    """package://PACKAGE/path -> a path."""
    if not address.startswith("package://"):
        return address
    package, _, path = address[len("package://"):].partition("/")
    try:
        return os.path.join(rospkg.RosPack().get_path(package), path)
    except rospkg.ResourceNotFound:
        raise SessionError(f"There is no package '{package}' for '{address}'; source its workspace.") from None


def absolute(address):
    return address if address.startswith("package://") else os.path.abspath(address)


def files_of(path):
    """A file and, for a scene, its bases and its surface, as far as they can be read."""
    yield path
    if not path.endswith((".yaml", ".yml")):
        landmarks = path + ".landmarks.yaml"
        if os.path.exists(landmarks):
            yield landmarks
        return
    try:
        with open(path, encoding="utf-8") as stream:
            content = yaml.safe_load(stream)
        geometry = content.get("geometry") or {}
        scope = content.get("scope")
        urdf = scope.get("urdf", SCOPE) if isinstance(scope, dict) else None
        others = [content.get("base"), geometry.get("file"), urdf]
        for other in (resolve(other) for other in others if isinstance(other, str)):
            yield from files_of(os.path.join(os.path.dirname(path), other))
    except (OSError, ValueError, AttributeError, yaml.YAMLError, RecursionError, SessionError):
        return  # the session itself says what is wrong


def digest(address):
    """SHA-256 of a file and of those that it names; "unreadable" if it is."""
    total = hashlib.sha256()
    try:
        for path in files_of(resolve(address)):
            with open(path, "rb") as stream:
                total.update(stream.read())
    except (OSError, SessionError):
        return "unreadable"
    return total.hexdigest()


def versions():
    """Of the package, and of the library that computes the numbers."""
    program = find_program()
    folder = os.path.dirname(os.path.dirname(program))
    library, *_ = [path for place in ("", "*") for path in glob.glob(os.path.join(folder, place, "libvibe_core.so"))] + [program]
    try:  # not get_manifest(): it loads rosdep, which prints where nobody has initialised it
        description = os.path.join(rospkg.RosPack().get_path("vibe_core"), "package.xml")
        version = ElementTree.parse(description).findtext("version").strip()
    except rospkg.ResourceNotFound:
        version = "unknown"
    return {"vibe_core": version, "build": digest(library)[:16]}


def stem(address):
    return os.path.splitext(os.path.basename(address))[0]


class Plan:
    """Script, organs, skills and seeds; equal plans have equal sessions."""

    def __init__(self, content):
        self.content = content

    @classmethod
    def make(cls, options):
        """From the options of the command line."""
        addresses = [absolute(options.script)] + [absolute(f) for f in options.scene + options.mesh]
        return cls({
            "format": FORMAT,
            "versions": versions(),
            "script": addresses[0],
            "scenes": addresses[1:1 + len(options.scene)],
            "meshes": addresses[1 + len(options.scene):],
            "novice": sorted(set(options.novice)),
            "first_seed": options.first_seed,
            "count": options.count,
            "duration": options.duration,
            "digests": {address: digest(address) for address in addresses},
        })

    @classmethod
    def load(cls, file):
        try:
            with open(file, encoding="utf-8") as stream:
                content = yaml.safe_load(stream)
        except (OSError, ValueError, yaml.YAMLError):
            content = None
        if not isinstance(content, dict) or content.get("format") != FORMAT or not KEYS <= content.keys():
            raise SessionError(f"'{file}' is not the plan of a cohort of this version; name another folder.")
        return cls(content)

    def text(self):
        return ("# The plan of a cohort. `scripts/cohort --output` with this folder goes on where it ended.\n" +
                yaml.safe_dump(self.content, sort_keys=False))

    def difference(self, other):
        """The first thing that differs, as words; empty if the plans are equal."""
        for key, value in self.content.items():
            there = other.content.get(key)
            if key == "digests":
                changed = [address for address in value if value[address] != there.get(address)]
                if changed:
                    return f"'{changed[0]}' has changed"
            elif key == "versions" and value != there:
                return "vibe_core is another version or another build"
            elif value != there:
                return f"{key} was {there}, not {value}"
        return ""

    def organs(self):
        """(name, scene, mesh), with names that differ."""
        used = set()
        for scene, mesh in itertools.product(self.content["scenes"], self.content["meshes"] or [""]):
            base = stem(scene) + ("_" + stem(mesh) if mesh else "")
            numbered = (base if k == 1 else f"{base}_{k}" for k in itertools.count(1))
            name = next(name for name in numbered if name not in used)
            used.add(name)
            yield name, scene, mesh

    def sessions(self):
        """In the order of the table: by organ, skill and seed."""
        plan = self.content
        seeds = range(plan["first_seed"], plan["first_seed"] + plan["count"])
        for (name, scene, mesh), novice, seed in itertools.product(self.organs(), plan["novice"], seeds):
            used = [address for address in (plan["script"], scene, mesh) if address]
            yield Session(f"{name}_novice{novice:.12g}_seed{seed}", plan["script"], scene, mesh, novice, seed,
                          plan["duration"], tuple((address, plan["digests"][address]) for address in used),
                          tuple(sorted(plan["versions"].items())))

    def __len__(self):
        plan = self.content
        return len(plan["scenes"]) * max(1, len(plan["meshes"])) * len(plan["novice"]) * plan["count"]
