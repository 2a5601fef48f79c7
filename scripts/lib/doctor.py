"""What scripts/doctor prints: facts of the machine, the workspace and the last session, then checks with remedies.

Standard library only, and never longer than some seconds: what does not answer is said to be so.
"""

import argparse
import contextlib
import glob
import grp
import os
import pwd
import re
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client

from doctor_files import look_at
from doctor_graph import simulators_of, unanswered

WORKSPACE = os.environ["VIBE_WORKSPACE"]
PATIENCE = 3.0  # for one command [s]
LOG_LINES = 12  # of the end of each log with a complaint
VARIABLES = re.compile(r"ROS_|VIBE_|DISPLAY$|WAYLAND_DISPLAY$|XDG_RUNTIME_DIR$|LD_PRELOAD$|TMPDIR$|LANG$|LC_ALL$")
COMPLAINT = re.compile(r"error|warn|died|cannot|failed|exception|refused", re.IGNORECASE)


class Report:
    """Facts in sections; checks, of which those with a remedy are troubles."""

    def __init__(self):
        self.troubles = []
        self.passed = 0

    def section(self, title):
        print("\n{}\n{}".format(title, "-" * len(title)))

    def fact(self, name, value):
        print("{:22} {}".format(name, value))

    def check(self, good, name, remedy):
        """`remedy` is a sentence about what was observed and what to do."""
        self.passed += bool(good)
        if not good:
            self.troubles.append(remedy)
        print("{:22} {}".format(name, "ok" if good else "TROUBLE: " + remedy))


def output_of(*command):
    """What a command prints; empty if it is not there, fails or takes too long."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=PATIENCE, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.decode("utf-8", "replace").strip() if done.returncode == 0 else ""


def read(path):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.read()
    except OSError:
        return ""


def owner_of(path):
    try:
        uid = os.stat(path).st_uid
        return pwd.getpwuid(uid).pw_name
    except (OSError, KeyError):
        return "nobody known"


def writable(folder):
    """Whether a folder, or the first one above it that is there, can be written to."""
    while folder and not os.path.exists(folder):
        folder = os.path.dirname(folder)
    return os.path.isdir(folder or ".") and os.access(folder or ".", os.W_OK)


# --- sections


def system(report):
    report.section("System")
    release = dict(re.findall(r'^(\w+)="?(.*?)"?$', read("/etc/os-release"), re.MULTILINE))
    report.fact("system", release.get("PRETTY_NAME", "unknown"))
    kernel = os.uname()
    report.fact("kernel", "{} {}".format(kernel.release, kernel.machine))
    processor = re.search(r"^model name\s*: (.*)$", read("/proc/cpuinfo"), re.MULTILINE)
    report.fact("processor", "{}, {} cores".format(processor.group(1) if processor else "?", len(os.sched_getaffinity(0))))
    memory = dict(re.findall(r"^(\w+): *(\d+) kB$", read("/proc/meminfo"), re.MULTILINE))
    report.fact("memory", "{:.1f} of {:.1f} GB free".format(*(int(memory.get(k, 0)) / 1e6 for k in ("MemAvailable", "MemTotal"))))
    report.fact("load", "{:.1f} {:.1f} {:.1f}".format(*os.getloadavg()))
    report.fact("user", "{} (uid {})".format(owner_of("/proc/self"), os.getuid()))
    report.fact("container", "yes" if os.path.exists("/.dockerenv") or "container" in os.environ else "not seen")
    for name, value in sorted(os.environ.items()):
        if VARIABLES.match(name) and name != "VIBE_WORKSPACE":
            report.fact(name, value)
    debian = release.get("ID") == "debian" and release.get("VERSION_CODENAME") in ("bookworm", "trixie")
    report.check(debian, "Debian 12 or 13", "this is {}; the packages are those of Debian 12 and 13".format(release.get("PRETTY_NAME")))
    disk = shutil.disk_usage(WORKSPACE).free
    report.check(disk > 2e9, "room on the disk", "{:.1f} GB are free at {}; a build needs 2".format(disk / 1e9, WORKSPACE))
    busy = os.getloadavg()[0] > len(os.sched_getaffinity(0)) + 0.5
    report.check(not busy, "free processors", "the load is {:.1f} on {} cores: programs wait for them, or for a disk; let them "
                 "end before a session in real time".format(os.getloadavg()[0], len(os.sched_getaffinity(0))))  # fmt: skip


def packages(report):
    report.section("Packages")
    for name in ("libroscpp-dev", "rviz", "librosbag-dev", "libassimp-dev", "libeigen3-dev", "g++"):
        report.fact(name, output_of("dpkg-query", "-W", "-f=${Version}", name) or "not installed")
    missing = output_of(os.path.join(WORKSPACE, "scripts/setup"), "--missing", "--part", "session", "--force").split()
    report.check(not missing, "packages of sessions", "{} are not installed; run scripts/setup".format(" ".join(missing)))
    others = [path for path in os.environ.get("PATH", "").split(":") if re.search(r"pyenv|conda|venv", path)]
    report.fact("other pythons in PATH", ", ".join(others) or "none")  # the scripts leave them out


def workspace(report):
    report.section("Workspace")
    owner = owner_of(os.path.join(WORKSPACE, "src"))
    build = os.path.join(WORKSPACE, "build")
    report.fact("place", "{} (owner {})".format(WORKSPACE, owner))
    version = re.search(r"<version>(.*?)</version>", read(os.path.join(WORKSPACE, "src/vibe_core/package.xml")))
    commit = output_of("git", "-c", "safe.directory=*", "-C", WORKSPACE, "describe", "--always", "--dirty")
    report.fact("version", "{} {}".format(version.group(1) if version else "?", commit))
    record = os.path.join(build, "vibe_built")
    built = read(record).strip()
    report.fact("built", "{}: {}".format(when(record), built) if built else "not, or not to the end")
    report.check(" " not in WORKSPACE, "path", "catkin cannot build in a path with a space; move the clone")
    mine = writable(build)
    if built and not mine:
        newer = output_of(
            "bash", "-c", 'vibe_root=$0; source "$0/scripts/lib/parts.sh"; newerSources "$1" OFF', WORKSPACE, record
        )
        report.check(not newer, "build of another user", "'{}' owns the workspace and {} is newer than what is built; let "
                     "'{}' run scripts/build, or work in a copy".format(owner, newer.split("\n")[0], owner))  # fmt: skip
    else:
        remedy = "run scripts/build" if mine else "'{}' owns the workspace; let '{}' run scripts/build, or work in a copy".format(owner, owner)
        report.check(built, "built", "there is no complete build; " + remedy)
    log = read(os.path.join(build, "build.log")).splitlines()
    for line in [line for line in log if re.search(r"(fatal )?error[: ]", line)][:5]:
        report.fact("build.log", line[:200])


def permissions(report):
    report.section("Folders and permissions")
    if not ("ROS_LOG_DIR" in os.environ or "ROS_HOME" in os.environ):
        home = os.environ.get("HOME", "")
        report.check(writable(os.path.join(home, ".ros/log")), "folder of logs", "{}/.ros/log cannot be written to; set "
                     "ROS_HOME to a folder that can".format(home))  # fmt: skip
    for name in ("ROS_HOME", "ROS_LOG_DIR", "TMPDIR", "XDG_RUNTIME_DIR"):
        if os.environ.get(name):
            report.check(writable(os.environ[name]), name, "{} is {}, which cannot be written to; set another "
                         "folder".format(name, os.environ[name]))  # fmt: skip
    report.check(writable(os.environ.get("TMPDIR", "/tmp")), "temporary files", "{} cannot be written to; set "
                 "TMPDIR".format(os.environ.get("TMPDIR", "/tmp")))  # fmt: skip
    sessions = os.path.join(WORKSPACE, "sessions")
    report.fact("sessions go to", sessions if writable(sessions) else "the present folder: {} is not yours".format(sessions))
    report.check(writable(sessions) or writable(os.getcwd()), "folder of sessions", "neither {} nor the present folder can "
                 "be written to; give --output DIR".format(sessions))  # fmt: skip


def network(report):
    report.section("ROS graph")
    for name in ("localhost", socket.gethostname()):
        try:
            report.fact(name, socket.gethostbyname(name))
            found = True
        except OSError:
            found = False
        report.check(found, "name " + name, "the name {} has no address; add it to /etc/hosts".format(name))
    uri = os.environ.get("ROS_MASTER_URI", "http://localhost:11311")
    socket.setdefaulttimeout(1.0)
    nodes = None
    with contextlib.suppress(OSError, xmlrpc.client.Error, ValueError):
        published, subscribed, _ = map(dict, xmlrpc.client.ServerProxy(uri).getSystemState("/vibe_doctor")[2])
        nodes = {node for names in published.values() for node in names}
        report.fact("simulators", ", ".join(sorted(simulators_of(published))) or "none")
        for sentence in unanswered(published, subscribed):
            report.check(False, "topic", sentence)
    report.fact("master", "{}: {}".format(uri, "does not answer" if nodes is None else " ".join(sorted(nodes))))


def devices(report):
    report.section("Devices")
    report.fact("groups", " ".join(sorted(name_of_group(g) for g in os.getgroups())))
    for pattern, what in (("/dev/hidraw*", "haptic and input device"), ("/dev/input/event*", "gamepad"), ("/dev/video*", "camera")):
        found = sorted(glob.glob(pattern))
        report.fact(pattern, "{} found".format(len(found)))
        closed = [path for path in found if not os.access(path, os.R_OK)]
        if found:
            report.check(len(closed) < len(found), what, "no {} can be read by you ({} belongs to the group {}); join that group or "
                         "install the udev rules of docs/hardware.md".format(pattern, closed[0] if closed else "", group_of(closed)))  # fmt: skip
    report.fact("real-time priority", "up to {}".format(resource.getrlimit(resource.RLIMIT_RTPRIO)[0]))


def name_of_group(number):
    try:
        return grp.getgrgid(number).gr_name
    except KeyError:
        return str(number)


def group_of(paths):
    return name_of_group(os.stat(paths[0]).st_gid) if paths else ""


def display(report):
    report.section("Display")
    name = os.environ.get("DISPLAY", "")
    report.check(not os.environ.get("QT_QPA_PLATFORM", "").startswith("wayland"), "windows of Qt", "QT_QPA_PLATFORM makes rviz a "
                 "Wayland client, and it aborts; scripts/run sets xcb itself, for other rviz: export QT_QPA_PLATFORM=xcb")  # fmt: skip
    report.check(name or not os.environ.get("WAYLAND_DISPLAY"), "Xwayland", "this Wayland desktop has no X display, which rviz "
                 "needs; install xwayland and log in again")  # fmt: skip
    if not name:
        report.fact("display", "none: sessions run without rviz, as with --headless; --drive keyboard and replay --view need one")
        return
    local = re.fullmatch(r"(?:unix)?:(\d+)(?:\.\d+)?", name)
    answers = True
    if local:
        with contextlib.closing(socket.socket(socket.AF_UNIX)) as probe:
            probe.settimeout(1.0)
            answers = probe.connect_ex("/tmp/.X11-unix/X" + local.group(1)) == 0
            answers = answers or probe.connect_ex("\0/tmp/.X11-unix/X" + local.group(1)) == 0
    report.check(answers, "display " + name, "no X server answers at DISPLAY={}; unset DISPLAY to run without rviz, or set "
                 "that of a desktop".format(name))  # fmt: skip
    renderer = re.search(r"OpenGL renderer string: (.*)", output_of("glxinfo", "-B"))
    report.fact("renderer", renderer.group(1) if renderer else "unknown (glxinfo of mesa-utils tells)")


def when(path):
    try:
        return time.strftime("%Y-%m-%d %H:%M", time.localtime(os.path.getmtime(path)))
    except OSError:
        return "-"


def last_session(report):
    folders = [f for root in (os.path.join(WORKSPACE, "sessions"), "sessions") for f in glob.glob(os.path.join(root, "*/log"))]
    report.section("Last session")
    if not folders:
        report.fact("folder", "none")
        return None
    folder = os.path.dirname(max(folders, key=os.path.getmtime))
    report.fact("folder", "{} ({})".format(folder, when(folder)))
    for path in sorted(glob.glob(os.path.join(folder, "*"))):
        if os.path.isfile(path):
            report.fact(os.path.basename(path), "{:.2f} MB".format(os.path.getsize(path) / 1e6))
    bag = os.path.join(folder, "session.bag")
    running = time.time() - max((os.path.getmtime(path) for path in glob.glob(bag + "*")), default=0) < 10
    if os.path.exists(bag + ".active"):
        report.check(running, "recording", "{} is not complete; the recorder may have been killed, or the disk full: `rosbag "
                     "reindex` mends what is there".format(bag))  # fmt: skip
    else:
        report.check(os.path.exists(bag), "recording", "the session in {} has recorded nothing; see what its logs "
                     "say".format(folder))  # fmt: skip
    for log in sorted(glob.glob(os.path.join(folder, "log/*.log"))):
        lines = [line for line in read(log).splitlines() if COMPLAINT.search(line)]
        for line in lines[-LOG_LINES:]:
            report.fact(os.path.basename(log), line[:200])
    death = re.search("^rviz died .*", read(os.path.join(folder, "log/rviz.log")), re.MULTILINE)
    report.check(not death, "rviz", "{} in the session in {}; the end of its log/rviz.log says why: where it is the graphics "
                 "driver, try LIBGL_ALWAYS_SOFTWARE=1".format(death and death.group(), folder))  # fmt: skip
    return bag if os.path.exists(bag) else None


def files(report, paths):
    for path in paths:
        report.section("File " + path)
        facts, troubles = look_at(path)
        for name, value in facts:
            report.fact(name, value)
        for trouble in troubles:
            report.check(False, "file", trouble)
        if not troubles:
            report.check(True, "file", "")


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/doctor", usage=argparse.SUPPRESS, add_help=False, allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Usage: scripts/doctor [FILE...]\n"
        "Prints one text about this machine, the workspace and the last session, with checks and remedies, to paste into\n"
        "a report of trouble. Read it before you do: it contains paths and your user name. FILEs are looked at, too:\n"
        "recordings, scenes, surfaces, recorded gamepads. Ends with status 0 if no trouble was found, else 1.",
    )  # fmt: skip
    parser.add_argument("files", nargs="*", metavar="FILE")
    parser.add_argument("--help", action="help", help="print this text and end")
    words, unknown = parser.parse_known_args()
    if unknown:
        print("doctor: unknown option '{}' (scripts/doctor --help lists what there is)".format(unknown[0]), file=sys.stderr)
        return 2
    report = Report()
    print("scripts/doctor, {}".format(time.strftime("%Y-%m-%d %H:%M:%S")))
    for section in (system, packages, workspace, permissions, network, devices, display):
        section(report)
    bag = last_session(report)
    files(report, words.files or ([bag] if bag else []))
    report.section("Found")
    print("{} checks passed, {} troubles".format(report.passed, len(report.troubles)))
    for number, trouble in enumerate(report.troubles, 1):
        print("{}. {}".format(number, trouble))
    return 1 if report.troubles else 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # of `scripts/doctor | head`
    sys.exit(main())
