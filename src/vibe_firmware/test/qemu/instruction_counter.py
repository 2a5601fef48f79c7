"""Options of QEMU that count the instructions of each control interrupt."""
import os
import re
import subprocess
import sys


def symbol(image, name):
    """Address of a symbol, in hexadecimal."""
    names = subprocess.run(["arm-none-eabi-nm", image], check=True, capture_output=True, text=True).stdout
    found = re.search(rf"^([0-9a-f]+) \w {re.escape(name)}$", names, re.MULTILINE)
    if not found:
        sys.exit(f"instruction_counter.py: {image} has no symbol {name}")
    return found.group(1)


def options(plugin, image):
    """@param plugin  path of count_instructions.so; None: do not count"""
    if not plugin:
        return []
    first, last = symbol(image, "tickHandler"), symbol(image, "tickReturn")
    return ["-plugin", f"{os.path.abspath(plugin)},first=0x{first},last=0x{last}"]
