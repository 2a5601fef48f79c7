#!/usr/bin/python3 -SE
"""Stands in for vibe_headless: measures that follow from the options. What it is to suffer stands in the name of the
scene or in files of the folder VIBE_FAKE."""
import json
import os
import signal
import sys
import time

options = dict(zip(sys.argv[1::2], sys.argv[2::2]))
folder, seed, novice = os.environ["VIBE_FAKE"], options["--seed"], float(options["--novice"])


def once(name):
    """True the first time that it is asked."""
    try:
        os.close(os.open(os.path.join(folder, name), os.O_CREAT | os.O_EXCL))
        return True
    except FileExistsError:
        return False


once(f"began-{novice:g}-{seed}-{os.getpid()}")
if "bad" in options["--scene"]:
    sys.exit("vibe_headless: bad.yaml:3: unknown key 'colour'; remove it.")
if os.path.exists(os.path.join(folder, f"kill-{seed}")) and once(f"killed-{seed}-{novice:g}"):
    os.kill(os.getpid(), signal.SIGKILL)
if os.path.exists(os.path.join(folder, f"always-kill-{seed}")):
    os.kill(os.getpid(), signal.SIGKILL)
if os.path.exists(os.path.join(folder, "slow")):
    time.sleep(0.5)
if os.path.exists(os.path.join(folder, "hang")):
    time.sleep(600)
measures = {"time": {"value": 100 + 500 * novice + int(seed) / 7}, "share_above": {"value": None}}
with open(options["--measures"], "w", encoding="utf-8") as stream:
    json.dump({"measures": measures, "state_hash": f"{int(seed) * 2654435761 % 2**32:016x}"}, stream)
