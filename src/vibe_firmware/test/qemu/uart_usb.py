#!/usr/bin/env python3
"""Talks to a USB image in QEMU through its UART, as a USB host would, and checks what it answers.

The frames are described in ports/mps2_an500/uart_link.hpp. QEMU runs at most in real time here, so no rate is checked.
"""
import argparse
import os
import socket
import struct
import subprocess
import sys
import tempfile

import instruction_counter

GET_DESCRIPTOR, SET_CONFIGURATION = (0x80, 6), (0x00, 9)
GET_REPORT, SET_REPORT = (0xA1, 1), (0x21, 9)
FEATURE = 0x0300
PARAMETERS, STATUS, AXIS = 2, 3, 4  # report ids
STALL = -1
REPORTS = 300


class Device:
    """The firmware behind a UART."""

    def __init__(self, connection):
        self.connection = connection
        self.reports = []

    def read(self, size):
        data = b""
        while len(data) < size:
            part = self.connection.recv(size - len(data))
            if not part:
                raise EOFError("the firmware has closed its UART")
            data += part
        return data

    def read_frame(self):
        """Keeps an input report and returns None, or returns (result, data) of a control request."""
        kind = self.read(1)
        if kind == b"I":
            self.reports.append(self.read(self.read(1)[0]))
            return None
        if kind != b"C":
            raise ValueError(f"a frame begins with {kind!r}")
        (result,) = struct.unpack("<h", self.read(2))
        return result, self.read(max(result, 0))

    def control(self, request, value, length, data=b"", index=0):
        kind, number = request
        self.connection.sendall(b"S" + struct.pack("<BBHHH", kind, number, value, index, length) + data)
        answer = None
        while answer is None:
            answer = self.read_frame()
        return answer

    def wait_for_reports(self, count):
        del self.reports[:]
        while len(self.reports) < count:
            self.read_frame()


class Checks:
    """Counts what failed."""

    def __init__(self):
        self.failed = 0

    def __call__(self, good, what):
        if not good:
            self.failed += 1
            print(f"wrong: {what}")


def check_descriptors(device, product, check):
    _, descriptor = device.control(GET_DESCRIPTOR, 0x0100, 64)
    check(len(descriptor) == 18 and descriptor[0] == 18, f"device descriptor {descriptor.hex()}")
    check(struct.unpack("<HH", descriptor[8:12]) == (0x1209, product), f"ids in {descriptor.hex()}")
    _, configuration = device.control(GET_DESCRIPTOR, 0x0200, 255)
    check(struct.unpack("<H", configuration[2:4])[0] == len(configuration), "length of the configuration descriptor")
    size = struct.unpack("<H", configuration[25:27])[0]
    _, report = device.control((0x81, 6), 0x2200, 255)
    check(len(report) == size, f"{len(report)} bytes of report descriptor, {size} announced")
    check(device.control(GET_DESCRIPTOR, 0x0200, 9)[1] == configuration[:9], "a short read of the configuration")
    check(device.control((0x81, 6), 0x2500, 255)[0] == STALL, "a descriptor that does not exist is not stalled")


def parameters(number, stiffness):
    axis = (stiffness, 1e-3, 0.1, 0.0, 0.02)
    return struct.pack("<BH10f", PARAMETERS, number, *axis, *axis)


def check_parameters(device, check):
    good = 0
    for number in range(1, 101):
        sent = parameters(number, 0.001 * number)
        result, _ = device.control(SET_REPORT, FEATURE | PARAMETERS, len(sent), sent)
        _, got = device.control(GET_REPORT, FEATURE | PARAMETERS, 64)
        good += result == 0 and got == sent
    check(good == 100, f"{good} of 100 parameter sets read back")
    sent = parameters(200, 50.0)
    device.control(SET_REPORT, FEATURE | PARAMETERS, len(sent), sent)
    _, status = device.control(GET_REPORT, FEATURE | STATUS, 64)
    refused, reason = struct.unpack("<HB", status[8:11])
    check((refused, reason) == (200, 4), f"a spring that is too stiff: set {refused}, reason {reason}")
    check(device.control(SET_REPORT, FEATURE | PARAMETERS, 20, sent[:20])[0] == STALL, "a short report is not stalled")
    check(device.control(SET_REPORT, FEATURE | PARAMETERS, 600, bytes(600))[0] == STALL, "a long one is not stalled")
    _, kept = device.control(GET_REPORT, FEATURE | PARAMETERS, 64)
    check(kept == parameters(100, 0.1), "refused parameters in force")


def check_reports(device, check):
    check(not device.reports, "reports before SET_CONFIGURATION")
    device.control(SET_CONFIGURATION, 1, 0)
    device.wait_for_reports(REPORTS)
    numbers = [struct.unpack("<H", report[7:9])[0] for report in device.reports]
    check(all(len(report) == 28 and report[0] == 1 for report in device.reports), "size or id of a report")
    lost = sum((b - a - 1) % 65536 for a, b in zip(numbers, numbers[1:]))
    check(lost == 0, f"{lost} of {REPORTS} reports lost")
    positions = {struct.unpack("<ii", report[13:21]) for report in device.reports}
    check(len(positions) > REPORTS // 2, "the simulated encoders do not move")


def check_encoders(device, check):
    device.connection.sendall(b"E" + struct.pack("<iiH", 1234, -4321, 0b101))
    device.wait_for_reports(200)
    last = device.reports[-1]
    check(struct.unpack("<ii", last[13:21]) == (1234, -4321), f"counts in {last.hex()}")
    check(struct.unpack("<H", last[5:7]) == (0b101,), f"buttons in {last.hex()}")
    device.connection.sendall(b"R")
    device.connection.settimeout(0.3)
    try:
        while device.read_frame() is None:
            pass
        check(False, "an answer to nothing")
    except socket.timeout:
        device.connection.settimeout(20)
    check(device.control(GET_REPORT, FEATURE | STATUS, 64)[0] == 32, "no answer after a bus reset")


def check_device(device, image, check):
    haptic = "haptic" in os.path.basename(image)
    check_descriptors(device, 1 if haptic else 2, check)
    check_reports(device, check)
    if haptic:
        check_parameters(device, check)
    else:
        check(device.control(SET_REPORT, FEATURE | PARAMETERS, 43, parameters(1, 0.1))[0] == STALL, "parameters taken")
    _, axis = device.control(GET_REPORT, FEATURE | AXIS, 64)
    check(len(axis) == 53 and abs(struct.unpack("<f", axis[1:5])[0] - 1e-3) < 1e-9, f"axis configuration {axis.hex()}")
    check_encoders(device, check)
    device.connection.sendall(b"x" + b"Q")  # a byte that begins no frame


def qemu_command(image, plugin, path):
    # -icount: virtual time follows the instructions, so that a busy host slows the firmware down instead of letting
    # ticks pile up before the main loop runs; align: and it is not faster than real time
    return ["qemu-system-arm", "-M", "mps2-an500", "-icount", "shift=6,align=on", "-display", "none", "-monitor", "none",
            "-semihosting-config", "enable=on,target=native", "-serial", "null",
            "-chardev", f"socket,id=usb,path={path}", "-serial", "chardev:usb", "-kernel", image,
            *instruction_counter.options(plugin, image)]


def run(image, plugin, folder):
    path = os.path.join(folder, "uart")
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(path)
        server.listen(1)
        server.settimeout(20)
        qemu = subprocess.Popen(qemu_command(image, plugin, path), stdin=subprocess.DEVNULL)
        try:
            connection, _ = server.accept()
            with connection:
                connection.settimeout(20)
                check = Checks()
                check_device(Device(connection), image, check)
                check(qemu.wait(20) == 0, f"QEMU ended with status {qemu.returncode}")
                return 1 if check.failed else 0
        finally:
            qemu.kill()
            qemu.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("image", help="firmware_mps2_haptic_usb.elf or firmware_mps2_input_usb.elf")
    parser.add_argument("--plugin", help="count_instructions.so: also counts the instructions of each interrupt")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        return run(arguments.image, arguments.plugin, folder)


if __name__ == "__main__":
    sys.exit(main())
