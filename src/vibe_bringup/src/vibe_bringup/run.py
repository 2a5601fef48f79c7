"""A session: the simulator, somebody who drives it, a recorder and rviz. The command line; see session.py."""

import argparse
import os
import re
import subprocess
import sys

from . import cli, places

DRIVERS = ("trainee", "device", "emulator", "gamepad", "keyboard", "web")
GRABS = "package://vibe_core/trainees/demo/grabs.yaml"
OWNERS = {"script": "trainee", "hand": "emulator", "config": "emulator", "pad": "gamepad", "mapping": "gamepad",
          "replay_pad": "gamepad"}  # fmt: skip
PADS = "package://vibe_hardware/config/gamepads"
PAGE_OPTIONS = ("lan", "port", "behind")  # parameters of web_node
DESCRIPTION = """\
Runs a session: the simulator, somebody who drives it, robot_state_publisher, a recorder and, with a display, rviz,
around a ROS master of their own (or yours, see --master). Prints one line a second, then the summary."""
NO_PAGE = "install Node 18 or newer and npm, let npm reach its registry, and run scripts/build --part web"
EPILOG = """\
Ends with status 0 when the session went through or was interrupted, 1 when something failed, 2 on a wrong call."""


# --- types of values


def driver(text):
    if text not in DRIVERS:
        raise argparse.ArgumentTypeError("nobody is called '{}'; choose one of {}".format(text, " ".join(DRIVERS)))
    return text


def trainee(text):
    """The file of what a trainee does: a shipped one by its name, or any file."""
    if re.fullmatch(r"[a-z_]+", text):
        for folder in ("trainees", "trainees/demo"):
            path = places.find("package://vibe_core/{}/{}.yaml".format(folder, text))
            if os.path.isfile(path):
                return path
        if not os.path.exists(text):
            raise argparse.ArgumentTypeError(
                "there is no file '{}', and vibe_core has no trainee of that name; it has {}".format(text, known_trainees())
            )
    return cli.file(text)


def known_trainees():
    """The names of the shipped trainees."""
    names = []
    for folder in ("trainees", "trainees/demo"):
        path = places.find("package://vibe_core/" + folder)
        names += sorted(name[:-5] for name in os.listdir(path) if name.endswith(".yaml")) if os.path.isdir(path) else []
    return ", ".join(names) or "none"


def hand(text):
    kind, _, name = text.partition(":")
    if kind in ("script", "recorded"):
        return "{}:{}".format(kind, cli.file(name))
    if text != "random":
        raise argparse.ArgumentTypeError("'{}' is not known; write script:FILE, recorded:FILE or random".format(text))
    return text


def instruments(text):
    if text != "camera":
        raise argparse.ArgumentTypeError("'{}' is not known; write camera".format(text))
    return text


# as web_node reads it
page_address = cli.matching(r"(?i:https?)://[^/?#@\s]+?(:\d+)?(/[^?#\s]*)?", "an address such as https://lab.example/vibe/")
camera = cli.matching(r"fake|gige:.*|(v4l2|video|images):.+", "gige:, gige:ADDRESS, v4l2:DEVICE, video:FILE, images:PATTERN or fake")


def port(text):
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise argparse.ArgumentTypeError("needs a number from 1 to 65535, not '{}'".format(text))
    return int(text)


# --- options


def parser():
    made = cli.Parser("run", "[options]", DESCRIPTION, EPILOG)
    add = made.options.add_argument
    add("--drive", metavar="WHO", type=driver, default="trainee", help="who drives:\n"
        "trainee: a trainee that looks, or a script, in simulated time (default)\n"
        "device: the haptic device and the input device, through /dev/hidraw\n"
        "emulator: the same two devices without hardware, with an emulated hand\n"
        "gamepad: a gamepad or joystick\n"
        "keyboard: keys and mouse in the window of rviz\n"
        "web: a browser, on this machine or with --lan on others\n"
        "All but the trainee drive in wall time, until Ctrl-C or, without a page, until rviz is closed.")  # fmt: skip
    add("--scene", metavar="FILE", type=cli.file, default=places.SCENE, help="what is simulated (default: %(default)s)")
    add("--mesh", metavar="FILE", type=cli.file, help="a closed surface (obj, stl, ply, gltf) instead of the scene's "
        "stomach")  # fmt: skip
    add("--duration", metavar="S", type=cli.positive("a number of seconds above zero"), help="simulated seconds "
        "(default: until the trainee has done all of its goals; otherwise no end)")  # fmt: skip
    add("--headless", action="store_true", help="without rviz")
    add("--web", action="store_true", help="show the session in a browser, too, until Ctrl-C; --drive web includes it")
    add("--master", action="store_true", help="use the ROS master of ROS_MASTER_URI, which must be running and have no "
        "nodes of the session's names; parameters are put back at the end")  # fmt: skip
    add("--record-all", action="store_true", help="record every message of every topic (7 MB per second) instead of "
        "what a replay needs")  # fmt: skip
    add("--output", metavar="DIR", help="folder for the recording, the summary and the logs (default: "
        "sessions/<date-time>)")  # fmt: skip
    add("--person", metavar="NAME", help="who drives, for the report")
    add("--notes", metavar="TEXT", help="what else the report shall say; both stand in session.about.yaml beside the recording")
    add_options_of_drivers(made)
    return made


def add_options_of_drivers(made):
    add = made.add_argument_group("With --web or --drive web").add_argument
    add("--lan", action="store_true", default=None, help="for phones, tablets and other machines of the network: with "
        "TLS and a token, and with the address as a QR code")  # fmt: skip
    add("--port", metavar="N", type=port, help="of the page (default: 8890)")
    add("--behind", metavar="URL", type=page_address, help="where others open the page, served by a reverse proxy; docs/web.md")
    add = made.add_argument_group("With --drive trainee").add_argument
    add("--script", metavar="WHAT", type=trainee, help="what the trainee does: a protocol of goals or a script of "
        "motions, as a file or by name:\n"
        "first: one suture set, in two minutes (default)\n"
        "expert: a whole sleeve\n"
        "novice: a beginner's sleeve\n"
        "NAME: any other NAME.yaml in the folder trainees of vibe_core and its folder demo")  # fmt: skip
    add("--realtime", dest="fast", action="store_false", default=False, help="as fast as the wall clock (default)")
    add("--fast", action="store_true", help="as fast as the machine can")
    add = made.add_argument_group("With --drive device or emulator").add_argument
    add("--config", metavar="FILE", type=cli.file, help="calibration of the devices (default: devices.yaml in the "
        "folder config of vibe_hardware)")  # fmt: skip
    add("--instruments", metavar="camera", type=instruments, help="a camera tracks helix and needle driver; without "
        "it, buttons move them")  # fmt: skip
    add("--camera", metavar="CAMERA", type=camera, help="gige:, gige:ADDRESS, v4l2:DEVICE, video:FILE, images:PATTERN; or fake, a "
        "simulated GigE camera whose instruments move by themselves (default: gige:, the first one found)")  # fmt: skip
    add("--vision-config", metavar="FILE", type=cli.file, help="its calibration, of vibe_calibrate; not with --camera "
        "fake, which has its own")  # fmt: skip
    add = made.add_argument_group("With --drive emulator").add_argument
    add("--hand", metavar="HAND", type=hand, help="who moves the devices: script:FILE (a trainee script), "
        "recorded:FILE or random (default: script:{})".format(GRABS))  # fmt: skip
    add = made.add_argument_group("With --drive gamepad").add_argument
    add("--pad", metavar="PAD", help="its path, or a part of its name (default: the first one found)")
    add("--mapping", metavar="FILE", type=cli.file, help="what its axes and buttons do (default: "
        "{}/two_stick.yaml)".format(PADS))  # fmt: skip
    add("--replay-pad", metavar="FILE", type=cli.file, help="a recorded pad session instead of a pad; each session "
        "leaves one, pad.evemu, in its folder")  # fmt: skip


# --- checks of what must go with what


def check_drive(arguments, fail):
    """Checks the options that depend on who drives, and fills in their defaults."""
    drive = arguments.drive
    if arguments.fast and drive != "trainee":
        fail("--fast goes with --drive trainee only: '{}' drives in wall time; remove one of them".format(drive))
    for option, owner in OWNERS.items():
        if getattr(arguments, option) is not None and drive != owner and (option, drive) != ("config", "device"):
            words = "--{} goes with --drive {}, not with --drive {}; remove one of them"
            fail(words.format(option.replace("_", "-"), owner, drive))
    check_instruments(arguments, fail)
    if arguments.pad and arguments.replay_pad:
        fail("--pad and --replay-pad exclude each other; remove one of them")
    if drive == "keyboard":
        check_display(arguments, fail)
    check_page(arguments, fail)
    fill_in(arguments)


def check_instruments(arguments, fail):
    """Checks the options of the camera that watches the instruments."""
    if not arguments.instruments:
        if arguments.camera or arguments.vision_config:
            fail("--camera and --vision-config go with --instruments camera; add it")
        return
    if arguments.drive not in ("device", "emulator"):
        words = "--instruments camera goes with --drive device or emulator: '{}' moves the instruments itself"
        fail(words.format(arguments.drive))
    arguments.camera = arguments.camera or "gige:"
    if arguments.camera == "fake":
        if arguments.vision_config:
            fail("--vision-config: --camera fake has its own calibration; remove one of them")
    elif not arguments.vision_config:
        fail("--instruments camera needs the calibration of the camera; add --vision-config FILE")


def check_display(arguments, fail):
    """Keys are pressed in the window of rviz."""
    if arguments.headless:
        fail("--drive keyboard needs the window of rviz; remove --headless")
    if not os.environ.get("DISPLAY"):
        fail("--drive keyboard needs the window of rviz, but DISPLAY is not set; run it on a desktop or use "
             "--drive gamepad")  # fmt: skip


def check_page(arguments, fail):
    """What is about the page needs one."""
    arguments.web = arguments.web or arguments.drive == "web"
    for name in PAGE_OPTIONS:
        if getattr(arguments, name) is not None and not arguments.web:
            fail("--{} goes with --web or --drive web; add one of them".format(name))


def fill_in(arguments):
    """Defaults that only who drives needs."""
    if arguments.drive == "trainee":
        arguments.script = arguments.script or trainee("first")
    if arguments.drive == "emulator":
        arguments.hand = arguments.hand or hand("script:" + GRABS)
    if arguments.drive == "gamepad":
        arguments.mapping = arguments.mapping or cli.file(PADS + "/two_stick.yaml")


def defaults(**values):
    """The arguments of a session that other programs begin."""
    arguments = parser().parse_args([])
    arguments.duration = 0.0
    return argparse.Namespace(**{**vars(arguments), "free_name": False, **values})


def parse(words):
    made = parser()
    arguments = made.parse(words)
    check_drive(arguments, made.error)
    arguments.free_name = not arguments.output  # another session may begin in the same second
    output = arguments.output or places.output_folder("sessions/" + cli.time_stamp())
    if not arguments.free_name and places.holds_session(output):
        made.error("--output: '{}' already holds a session".format(output))
    arguments.output = made.check_output(output)
    return arguments


def parts(arguments):
    wanted = ["session"]
    if arguments.drive in ("device", "emulator", "gamepad"):
        wanted.append("devices")
    if arguments.instruments:
        wanted.append("vision")
    if arguments.web:
        wanted.append("web")
    return wanted


def page_is_built():
    from vibe_sessions.headless import find_in_package

    return find_in_package("vibe_web", "page/index.html", "share") is not None


def run(arguments):
    from .session import perform

    arguments.headless = arguments.headless or not os.environ.get("DISPLAY")
    if arguments.web and not page_is_built():
        print("run: there is no page to show, because the build left it out; {}".format(NO_PAGE), file=sys.stderr)
        return 1
    if arguments.duration is None:
        arguments.duration = 0.0
        if arguments.drive == "trainee":  # a script has a length; goals take as long as they take
            command = [places.program("vibe_core", "vibe_headless"), "--script", arguments.script, "--script-length"]
            asked = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
            if asked.returncode != 0:
                return asked.returncode
            arguments.duration = float(asked.stdout)
    return perform(arguments)
