"""Inputs of steps as a session: a bag of commands, and the recording of the simulator that obeys them."""
import hashlib
import os

from vibe_sessions import headless
from vibe_sessions.cohort_plan import digest, resolve
from vibe_sessions.whole_file import open_whole, whole

EPOCH = 1_000_000_000  # stamp of the first step of simulated time [ns]
VERSION = 2  # of vibe_msgs/StepInput


def write_commands(file, scene, period, joints, buttons, seed=None):
    """A bag with the topics `scene` and `applied_input`: all that a replay takes. Its identity is a hash of what they say."""
    import rosbag
    from genpy import Time
    from std_msgs.msg import String
    from vibe_msgs.msg import StepInput

    text = f"base: {os.path.abspath(resolve(scene))}\n" + ("" if seed is None else f"seed: {seed}\n")
    content = hashlib.sha256(f"{digest(scene)} {seed}".encode() + joints.tobytes() + buttons.tobytes())
    session = int.from_bytes(content.digest()[:7], "little") | 1
    with whole(file) as part, rosbag.Bag(part, "w") as bag:
        bag.write("/scene", String(text), Time(1))
        for step, (positions, pressed) in enumerate(zip(joints.tolist(), buttons.tolist())):
            stamp = EPOCH + round(step * period * 1e9)
            message = StepInput(step=step, version=VERSION, joints=positions, buttons=bytes(pressed), pull_particle=-1,
                                run=1, session=session)
            message.header.stamp = Time(stamp // 10**9, stamp % 10**9)
            bag.write("/applied_input", message, message.header.stamp)


def record(folder, stopped=lambda: False):
    """Performs FOLDER/commands.bag without a ROS master. FOLDER gets session.bag and summary.txt. Returns the hash of the
    last state."""
    program = headless.find_program("vibe_sim", "vibe_replay")
    said = headless.call(["--record", os.path.join(folder, "session.bag"), os.path.join(folder, "commands.bag")], stopped, program)
    lines = said.splitlines()
    end = next(k for k, line in enumerate(lines) if line.startswith("state hash: "))
    with open_whole(os.path.join(folder, "summary.txt")) as file:
        file.write("\n".join(lines[1:end + 1]) + "\n")
    return lines[end].removeprefix("state hash: ")
