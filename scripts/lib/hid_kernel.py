"""Tests of the devices with a Linux kernel in QEMU; called by scripts/hid_kernel.

Makes an initial file system from the files of a Debian kernel package, starts the bridge (it plugs the devices in) and
QEMU, and turns what the test program in the guest prints into `ok` and `not ok` lines and `figure` lines.
"""
import argparse
import lzma
import os
import pathlib
import re
import selectors
import shlex
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import time

MODULES = ['hid-generic', 'evdev', 'joydev', 'uinput', 'xhci-pci', 'usbhid', 'virtio-pci', '9pnet-virtio', '9p', 'overlay']
DEVICES = ['haptic', 'input', 'spare-haptic', 'spare-input', 'image']  # of usb_bridge
PROGRAMS = ['hid_guest', 'hid_guest_replug']  # of the guest
APPLETS = ['sh', 'mount', 'insmod', 'cat', 'mkdir', 'cp', 'ifconfig', 'chroot', 'uname', 'poweroff']


def moduleName(path):
    return path.stem.replace('-', '_')


def modulesInOrder(kernel_root):
    """The files of MODULES and of what they depend on, dependencies first."""
    folder = next((kernel_root / 'lib/modules').iterdir())
    files = {moduleName(path): path for path in folder.rglob('*.ko')}
    builtin = {moduleName(pathlib.Path(line)) for line in (folder / 'modules.builtin').read_text().split()}
    ordered = {}

    def add(name):
        name = name.replace('-', '_')
        if name in builtin or name in ordered:
            return
        if name not in files:
            raise SystemExit(f'hid_kernel: the kernel {folder.name} has no module {name}')
        depends = re.search(rb'\0depends=([^\0]*)\0', files[name].read_bytes())
        for other in depends.group(1).decode().split(',') if depends else []:
            if other:
                add(other)
        ordered[name] = files[name]

    for name in MODULES:
        add(name)
    return list(ordered.values())


def uncompressedKernel(kernel_root):
    """The ELF file inside vmlinuz: QEMU starts it at once, while unpacking in the guest takes seconds."""
    image = next((kernel_root / 'boot').glob('vmlinuz-*'))
    data = image.read_bytes()
    offset, length = struct.unpack_from('<II', data, 0x248)  # Documentation/x86/boot.rst: payload_offset
    payload = data[(data[0x1F1] + 1) * 512 + offset:][:length]
    if not payload.startswith(b'\xfd7zXZ'):
        return image
    target = kernel_root / 'vmlinux'
    if not target.exists():
        part = kernel_root / 'vmlinux.part'
        part.write_bytes(lzma.LZMADecompressor().decompress(payload))
        part.rename(target)
    return target


class Archive:
    """A cpio archive in the format that the kernel unpacks (Documentation/driver-api/early-userspace)."""

    def __init__(self, path):
        self.file = open(path, 'wb')
        self.count = 0

    def add(self, name, mode, data=b''):
        self.count += 1
        name = name.encode() + b'\0'
        fields = [self.count, mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(name), 0]
        self._write(b'070701' + b''.join(b'%08X' % field for field in fields) + name)
        self._write(data)

    def _write(self, data):
        self.file.write(data + b'\0' * (-len(data) % 4))

    def folder(self, name):
        self.add(name, stat.S_IFDIR | 0o755)

    def program(self, name, path):
        self.add(name, stat.S_IFREG | 0o755, pathlib.Path(path).read_bytes())

    def link(self, name, target):
        self.add(name, stat.S_IFLNK | 0o777, target.encode())

    def text(self, name, text):
        self.add(name, stat.S_IFREG | 0o644, text.encode())

    def close(self):
        self.add('TRAILER!!!', 0)
        self.file.close()


def writeArchive(path, options, environment):
    archive = Archive(path)
    for folder in ['bin', 'dev', 'host', 'memory', 'modules', 'proc', 'root', 'sys']:
        archive.folder(folder)
    archive.program('bin/busybox', options.busybox)
    for applet in APPLETS:
        archive.link(f'bin/{applet}', 'busybox')
    modules = modulesInOrder(options.kernel)
    for module in modules:
        archive.program(f'modules/{module.name}', module)
    archive.text('modules/order', '\n'.join(module.name for module in modules) + '\n')
    guest = options.sources / 'guest'
    archive.program('init', guest / 'init')
    archive.program('session.sh', guest / 'session.sh')
    archive.text('session.env', ''.join(f'{key}={shlex.quote(value)}\n' for key, value in environment.items()))
    archive.close()


def qemuCommand(kernel, archive, sockets):
    command = ['qemu-system-x86_64', '-M', 'q35', '-accel', 'tcg', '-cpu', 'qemu64', '-smp', '2', '-m', '1024']
    command += ['-nodefaults', '-no-user-config', '-display', 'none', '-no-reboot', '-serial', 'stdio']
    command += ['-kernel', str(kernel), '-initrd', str(archive), '-append', 'console=ttyS0 quiet panic=-1']
    command += ['-virtfs', 'local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap']
    for device in DEVICES:
        # a controller for each: the kernel handles the ports of one controller one after the other
        command += ['-device', f'qemu-xhci,id=usb-{device}']
        command += ['-chardev', f'socket,id={device},path={sockets}/{device}']
        command += ['-device', f'usb-redir,chardev={device},bus=usb-{device}.0']
    command += ['-chardev', f'socket,id=commands,path={sockets}/commands', '-serial', 'chardev:commands']
    return command


def boardCommand(image, sockets):
    """The board with the firmware image. It starts when the bridge connects to its second serial port. An instruction
    takes 64 ns, so that the share of the processor that it gets does not depend on how busy the host is."""
    return ['qemu-system-arm', '-M', 'mps2-an500', '-display', 'none', '-monitor', 'none', '-icount', 'shift=6,align=on',
            '-semihosting-config', 'enable=on,target=native', '-serial', 'null',
            '-chardev', f'socket,id=usb,path={sockets}/board,server=on,wait=on', '-serial', 'chardev:usb',
            '-kernel', str(image)]


class Guest:
    """The bridge, QEMU and the tests in it."""

    def __init__(self, options, folder):
        self.options = options
        self.folder = folder
        self.started = time.monotonic()
        self.processes = []

    def start(self):
        programs = self.options.devel / 'lib/vibe_hardware'
        self.expected = [test for program in PROGRAMS for test in listTests(programs / program, self.options.filter)]
        if not self.expected:
            raise SystemExit(f"hid_kernel: no test matches '{self.options.filter}'")
        bridge = [str(programs / 'usb_bridge'), '--folder', str(self.folder)]
        if self.options.image:
            bridge += ['--image-socket', f'{self.folder}/board']
            # what it says of a guest that is late is no error
            self._run(boardCommand(self.options.image, self.folder), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                      stderr=subprocess.DEVNULL)
        self.bridge = self._run(bridge, stdout=subprocess.PIPE)
        if self.bridge.stdout.readline() != b'ready\n':
            raise SystemExit('hid_kernel: usb_bridge did not start; see its message above')
        kernel = uncompressedKernel(self.options.kernel)
        archive = self.folder / 'initramfs.cpio'
        writeArchive(archive, self.options, self._environment())
        self.started = time.monotonic()
        self.qemu = self._run(qemuCommand(kernel, archive, self.folder), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)

    def lines(self):
        """What the guest prints, until it ends or the time is over."""
        end = self.started + self.options.timeout
        selector = selectors.DefaultSelector()
        selector.register(self.qemu.stdout, selectors.EVENT_READ)
        rest = b''
        while selector.select(max(0, end - time.monotonic())):
            data = os.read(self.qemu.stdout.fileno(), 65536)
            if not data:
                return
            *lines, rest = (rest + data).split(b'\n')
            yield from (line.decode(errors='replace').rstrip('\r') for line in lines)
        print(f'hid_kernel: the guest has not ended after {self.options.timeout} s and is stopped', file=sys.stderr)

    def stop(self):
        for process in self.processes:
            process.kill()
            process.wait()

    def _run(self, command, **keywords):
        process = subprocess.Popen(command, **keywords)
        self.processes.append(process)
        return process

    def _environment(self):
        return {'VIBE_DEVEL': str(self.options.devel), 'VIBE_PACKAGES': str(self.options.sources.parents[1]),
                'VIBE_FILTER': self.options.filter,
                'VIBE_IMAGE': str(self.options.image or '')}


def listTests(program, pattern):
    """Names of the tests of a gtest program, as it prints them when it runs them."""
    said = subprocess.run([program, '--gtest_list_tests', f'--gtest_filter={pattern}'], check=True, text=True,
                          stdout=subprocess.PIPE).stdout
    suite, tests = '', []
    for line in said.splitlines():
        name = line.split('#')[0].rstrip()
        if not line.startswith(' '):
            suite = name
        elif name:
            tests.append(suite + name.strip())
    return tests


class Report:
    """Turns the guest's output into one line for each test."""

    RESULT = re.compile(r'\[ +(OK|FAILED|SKIPPED) +\] ([^ ,]+)')

    def __init__(self, expected):
        self.missing = list(expected)
        self.said = []
        self.failed = 0

    def read(self, line):
        if line.startswith('figure '):
            print(line, flush=True)
        elif line.startswith('[ RUN '):
            self.said = []
        else:
            found = self.RESULT.match(line)
            if found and found.group(2) in self.missing:
                self._result(found.group(1), found.group(2))
            else:
                self.said.append(line)

    def _result(self, verdict, name):
        self.missing.remove(name)
        if verdict == 'FAILED':
            self.failed += 1
        word = {'OK': 'ok', 'FAILED': 'not ok', 'SKIPPED': 'skipped'}[verdict]
        print(f'{word} {name}', flush=True)
        if verdict != 'OK':
            print(''.join(f'    {line}\n' for line in self.said), end='', flush=True)

    def end(self):
        """Tests of which nothing was heard have failed."""
        for name in self.missing:
            print(f'not ok {name}')
        if self.missing:
            print('    the guest ended before this test; it said last:')
            print(''.join(f'    {line}\n' for line in self.said[-20:]), end='')
        return self.failed == 0 and not self.missing


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--kernel', type=pathlib.Path, required=True, help='where the kernel package is unpacked')
    parser.add_argument('--devel', type=pathlib.Path, required=True, help='devel folder of the workspace')
    parser.add_argument('--sources', type=pathlib.Path, required=True, help='the folder kernel_test')
    parser.add_argument('--image', type=pathlib.Path, help='firmware image of the haptic device')
    parser.add_argument('--busybox', default='/bin/busybox')
    parser.add_argument('--filter', default='*', help='of gtest')
    parser.add_argument('--timeout', type=float, default=300, help='[s]')
    parser.add_argument('--log', type=pathlib.Path, help='file for everything that the guest prints')
    return parser.parse_args()


def main():
    options = parse()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    folder = pathlib.Path(tempfile.mkdtemp(prefix='hid_kernel.'))  # short: the path of a socket has 107 characters
    guest = Guest(options, folder)
    try:
        guest.start()
        report = Report(guest.expected)
        with open(options.log or os.devnull, 'w') as log:
            for line in guest.lines():
                print(line, file=log, flush=True)
                if line.startswith('guest: kernel'):
                    print(f'figure from the start of QEMU to the first process: {time.monotonic() - guest.started:.1f} s')
                report.read(line)
        passed = report.end()
        print(f'figure whole run: {time.monotonic() - guest.started:.1f} s')
    finally:
        guest.stop()
        shutil.rmtree(folder, ignore_errors=True)
    return 0 if passed else 1


if __name__ == '__main__':
    sys.exit(main())
