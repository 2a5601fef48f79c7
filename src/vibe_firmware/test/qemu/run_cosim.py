#!/usr/bin/env python3
"""Runs a firmware image in QEMU in lock-step with vibe_cosim, in virtual time.

Virtual time stands still while QEMU waits for the plant, so that the result does not depend on the load of the machine.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import instruction_counter

TIMEOUT = 300  # of the whole run [s]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("image", help="firmware_mps2_haptic_cosim.elf")
    parser.add_argument("--cosim", required=True, help="the program vibe_cosim")
    parser.add_argument("--plugin", help="count_instructions.so: also counts the instructions of each interrupt")
    parser.add_argument("--shift", default="6",
                        help="an instruction takes 2^SHIFT ns of virtual time (6); none: real time")
    parser.add_argument("options", nargs="+", help="of vibe_cosim: scenario, --ticks, --trace, --delay")
    arguments, rest = parser.parse_known_args()
    arguments.options += rest
    return arguments


def qemu_command(arguments, replies, requests):
    semihosting = ",".join(f"arg={part}" for part in ("image", replies, requests))
    command = ["qemu-system-arm", "-M", "mps2-an500", "-display", "none", "-monitor", "none", "-serial", "null",
               "-semihosting-config", f"enable=on,target=native,{semihosting}",
               "-kernel", arguments.image]
    if arguments.shift != "none":
        command += ["-icount", f"shift={arguments.shift},sleep=off"]
    return command + instruction_counter.options(arguments.plugin, arguments.image)


def run(arguments, folder):
    """@return status of vibe_cosim, or 2 if QEMU failed"""
    replies, requests = os.path.join(folder, "replies"), os.path.join(folder, "requests")
    os.mkfifo(replies)
    os.mkfifo(requests)
    qemu = subprocess.Popen(qemu_command(arguments, replies, requests), stdin=subprocess.DEVNULL)
    try:
        cosim = subprocess.run([arguments.cosim, *arguments.options, "--fifos", replies, requests], timeout=TIMEOUT)
        status = qemu.wait(30)
    except subprocess.TimeoutExpired as error:
        print(f"run_cosim.py: {error.cmd[0]} did not end within {error.timeout:.0f} s", file=sys.stderr)
        return 2
    finally:
        qemu.kill()
        qemu.wait()
    if status != 0:
        print(f"run_cosim.py: QEMU ended with status {status}", file=sys.stderr)
        return 2
    return cosim.returncode


def main():
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory() as folder:
        return run(arguments, folder)


if __name__ == "__main__":
    sys.exit(main())
