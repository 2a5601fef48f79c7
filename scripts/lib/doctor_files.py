"""What scripts/doctor finds in a file: what it is, whether it is one at all, and for recordings what they hold."""

import os
import re
import subprocess
import sys
import unicodedata

WORKSPACE = os.environ["VIBE_WORKSPACE"]
LARGEST = 400_000_000  # of a recording that is read: more would take longer than somebody waits [bytes]
NEEDED = ("applied_input", "scene", "session_info", "snapshot")
SURFACES = (".obj", ".stl", ".ply", ".gltf", ".glb")
PATIENCE = 8.0  # for the import of a surface [s]
LOOK_ALIKE = {"\u2013", "\u2014", "\u2212", "\u2018", "\u2019", "\u201c", "\u201d", "\uff1a"}


def look_at(path):
    """(facts as pairs, troubles as sentences)"""
    try:
        size = os.path.getsize(path)
        with open(path, "rb") as file:
            begin = file.read(4096)
    except OSError as error:
        return [], ["{} cannot be read ({}); check the path".format(path, error.strerror)]
    facts = [("size", "{} bytes".format(size))]
    if size == 0:
        return facts, ["{} is empty".format(path)]
    if begin.startswith(b"version https://git-lfs"):
        return facts, ["{} is a pointer of Git LFS and not the file; run `git lfs pull`".format(path)]
    if re.match(rb"\s*<(!doctype html|html)", begin, re.IGNORECASE):
        return facts, ["{} is an HTML page, such as a link gives in place of a file; download the file itself".format(path)]
    if begin.startswith(b"#ROSBAG"):
        return look_at_bag(path, size, facts)
    if path.endswith((".yaml", ".yml")):
        return facts, strange_characters(path)
    if path.lower().endswith(SURFACES):
        return look_at_surface(path, facts)
    if path.endswith(".evemu"):
        return facts, unmoved_axes(path)
    return facts, []


def strange_characters(path):
    """Blanks and letters that look like others, outside of comments."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = [line.split("#")[0] for line in file]
    found = []
    for number, line in enumerate(lines, 1):
        for character in line.rstrip("\n"):
            odd = character == "\t" or (ord(character) > 126 and (not character.isalpha() or is_foreign(character, line)))
            if odd or character in LOOK_ALIKE:
                name = unicodedata.name(character, "a tab" if character == "\t" else "unknown")
                found.append("{}:{} contains {}; if a plain character was meant, type it anew".format(path, number, name))
    return found[:5]


def is_foreign(character, line):
    """A letter of another script within a word of Latin letters."""
    word = next((word for word in line.split() if character in word), "")
    return not unicodedata.name(character, "").startswith("LATIN") and any("a" <= c.lower() <= "z" for c in word)


def look_at_surface(path, facts):
    """What the import says of it: why it is no organ, or its size and what is doubtful about the guess of it."""
    program = os.path.join(WORKSPACE, "devel/lib/vibe_core/vibe_headless")
    if not os.access(program, os.X_OK):
        return [*facts, ("import", "not tried: nothing is built")], []
    here = {**os.environ, "ROS_PACKAGE_PATH": os.path.join(WORKSPACE, "src")}
    try:
        done = subprocess.run([program, "--mesh", path, "--duration", "0.001"], stdin=subprocess.DEVNULL, env=here,
                              capture_output=True, text=True, errors="replace", timeout=PATIENCE, check=False)  # fmt: skip
    except subprocess.TimeoutExpired:
        return [*facts, ("import", "takes more than {:.0f} s".format(PATIENCE))], []
    said = [line for line in done.stderr.splitlines() if line]
    if done.returncode != 0:
        words = said[-1].partition(": ")[2] if said else "the import ends with status {}".format(done.returncode)
        return facts, [words.rstrip(".") if path in words else "{}: {}".format(path, words.rstrip("."))]
    for name in ("volume", "length"):
        size = re.search(r"^ +{} +([0-9.]+ \w+)".format(name), done.stdout, re.MULTILINE)
        facts.append((name, size.group(1) if size else "?"))
    facts += [("guess", line) for line in said if re.match("unit: |# confidence", line)]
    return facts, [line.rstrip(".") for line in said if "doubt" in line]


def unmoved_axes(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().splitlines()
    axes = {int(line.split()[1], 16) for line in lines if re.match(r"A: *[0-9a-f]+ ", line)}
    moved = {int(m.group(1), 16) for m in (re.match(r"E: *\S+ 0003 ([0-9a-f]{4})", line) for line in lines) if m}
    if axes <= moved:
        return []
    return ["{}: the axes {} have no event, so they count as at rest; record it with vibe_gamepad --record, which writes where "
            "they are".format(path, ", ".join("{:02x}".format(axis) for axis in sorted(axes - moved)))]  # fmt: skip


def look_at_bag(path, size, facts):
    sys.path[:0] = [os.path.join(WORKSPACE, "src/vibe_sessions/src"), os.path.join(WORKSPACE, "devel/lib/python3/dist-packages")]
    try:
        from vibe_sessions.report.bag_file import BagError, BagFile
        from vibe_sessions.report.sessions import list_sessions
    except ImportError as error:
        return facts, ["recordings cannot be read without '{}'; run scripts/setup".format(error.name)]
    troubles = []
    try:
        with BagFile(path) as bag:
            if bag.cut_reason:
                troubles.append("{}: {}; mend it with `rosbag reindex`".format(path, bag.cut_reason.rstrip(".")))
            topics = {connection.topic.rsplit("/", 1)[-1] for key, connection in bag.connections.items() if bag.count(key)}
            facts.append(("topics", str(len(topics))))
            lacking = [name for name in NEEDED if name not in topics]
            facts.append(("lacks", ", ".join(lacking) or "nothing"))
            if "applied_input" in lacking or {"scene", "session_info"} <= set(lacking):
                troubles.append("{} lacks {}: a replay needs applied_input and scene or session_info, and snapshot where it does "
                                "not begin with the session".format(path, ", ".join(lacking)))  # fmt: skip
            if size < LARGEST:
                for number, session in enumerate(list_sessions(bag), 1):
                    facts.append(("session {}".format(number), "{}, {} steps".format(session.name(), session.steps)))
    except BagError as error:
        troubles.append(str(error))
    return facts, troubles
