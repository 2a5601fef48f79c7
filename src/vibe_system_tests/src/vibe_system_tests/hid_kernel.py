"""Tests of the devices with a Linux kernel in QEMU; called by scripts/hid_kernel.

Makes an initial file system from the files of a Debian kernel package, starts the bridge (it plugs the devices in) and
QEMU, and turns what the test program in the guest prints into `ok` and `not ok` lines and `figure` lines.
"""
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
import tarfile
import tempfile
import time

from vibe_bringup import cli, places

DESCRIPTION = """\
Plugs both devices, with their firmware, into a virtual machine (QEMU, usbredir) that runs Debian's kernel, and tests
there what the kernel, the driver and the gamepad library make of them. Prints a line for each test and the measured
figures. The kernel package is fetched from the Debian archive into build/hid_kernel/ and is not installed. Needs no
root. The guest sees the files of this machine, read-only."""
EPILOG = "Exit status: 0 all tests passed, 1 some did not, 77 the virtual machine cannot be started here."

MODULES = ['hid-generic', 'evdev', 'joydev', 'uinput', 'xhci-pci', 'usbhid', 'virtio-pci', '9pnet-virtio', '9p', 'overlay']
WANTED = re.compile(  # of a kernel package
    r'\./(usr/)?(?P<path>boot/vmlinuz-[^/]*|lib/modules/[^/]*/(modules\.builtin|kernel/'
    r'(drivers/(hid|input|usb|virtio)|net/9p|fs/(9p|netfs|fscache|overlayfs))/.*\.ko))(?P<packed>\.xz)?')
DEVICES = ['haptic', 'input', 'spare-haptic', 'spare-input', 'image']  # of usb_bridge
PROGRAMS = ['hid_guest', 'hid_guest_replug']  # of the guest
APPLETS = ['sh', 'mount', 'insmod', 'cat', 'mkdir', 'cp', 'ifconfig', 'chroot', 'uname', 'poweroff']


def module_name(path):
    return path.stem.replace('-', '_')


def modules_in_order(kernel_root):
    """The files of MODULES and of what they depend on, dependencies first."""
    folder = next((kernel_root / 'lib/modules').iterdir())
    files = {module_name(path): path for path in folder.rglob('*.ko')}
    builtin = {module_name(pathlib.Path(line)) for line in (folder / 'modules.builtin').read_text().split()}
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


def uncompressed_kernel(kernel_root):
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


def write_archive(path, options, environment):
    archive = Archive(path)
    for folder in ['bin', 'dev', 'host', 'memory', 'modules', 'proc', 'root', 'sys']:
        archive.folder(folder)
    archive.program('bin/busybox', options.busybox)
    for applet in APPLETS:
        archive.link(f'bin/{applet}', 'busybox')
    modules = modules_in_order(options.kernel)
    for module in modules:
        archive.program(f'modules/{module.name}', module)
    archive.text('modules/order', '\n'.join(module.name for module in modules) + '\n')
    guest = options.sources / 'guest'
    archive.program('init', guest / 'init')
    archive.program('session.sh', guest / 'session.sh')
    archive.text('session.env', ''.join(f'{key}={shlex.quote(value)}\n' for key, value in environment.items()))
    archive.close()


def qemu_command(kernel, archive, sockets):
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


def board_command(image, sockets):
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
        programs = self.options.devel / 'lib/vibe_system_tests'
        self.expected = [test for program in PROGRAMS for test in list_tests(programs / program, self.options.filter)]
        if not self.expected:
            raise SystemExit(f"hid_kernel: no test matches '{self.options.filter}'")
        bridge = [str(programs / 'usb_bridge'), '--folder', str(self.folder)]
        if self.options.image:
            bridge += ['--image-socket', f'{self.folder}/board']
            # what it says of a guest that is late is no error
            self._run(board_command(self.options.image, self.folder), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                      stderr=subprocess.DEVNULL)
        self.bridge = self._run(bridge, stdout=subprocess.PIPE)
        if self.bridge.stdout.readline() != b'ready\n':
            raise SystemExit('hid_kernel: usb_bridge did not start; see its message above')
        kernel = uncompressed_kernel(self.options.kernel)
        archive = self.folder / 'initramfs.cpio'
        write_archive(archive, self.options, self._environment())
        self.started = time.monotonic()
        self.qemu = self._run(qemu_command(kernel, archive, self.folder), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)

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


def list_tests(program, pattern):
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


class Missing(Exception):
    """One sentence: why the virtual machine cannot be started on this machine."""


def run(command, **keywords):
    return subprocess.run(command, text=True, capture_output=True, check=False, **keywords)


def check_programs():
    if run(['dpkg', '--print-architecture']).stdout.strip() != 'amd64':
        raise Missing('the virtual machine is for amd64 only')
    for program in ('qemu-system-x86_64', 'busybox'):
        if shutil.which(program) is None:
            raise Missing(f'there is no {program}; scripts/setup installs it')


def kernel_package(cache):
    """Its name: what the package lists have, else what was unpacked before."""
    said = run(['apt-cache', 'depends', 'linux-image-amd64']).stdout
    found = re.search(r'^ *Depends: (linux-image-.*)$', said, re.MULTILINE)
    if found:
        return found.group(1)
    kept = sorted(path.name for path in cache.glob('linux-image-*-amd64'))
    if not kept:
        raise Missing("the package lists name no kernel; run 'apt-get update' once")
    return kept[-1]


def find_kernel(cache):
    """The folder of an unpacked kernel package; fetches it if it is not there."""
    package = kernel_package(cache)
    kernel = cache / package
    if not kernel.is_dir():
        cache.mkdir(parents=True, exist_ok=True)
        for old in cache.glob('*.deb'):
            old.unlink()
        print(f'Fetching {package}...', flush=True)
        user = ['-o', 'APT::Sandbox::User=root'] if os.getuid() == 0 else []
        fetched = run(['apt-get', *user, '-qq', 'download', package], cwd=cache)
        if fetched.returncode != 0:
            reason = (fetched.stdout + fetched.stderr).strip().splitlines()[-1:]
            raise Missing(f'{package} cannot be fetched from the Debian archive: {"".join(reason)}')
        file = next(cache.glob(f'{package}_*.deb'))
        unpack_kernel(file, kernel)
        file.unlink()
    return kernel


def unpack_kernel(file, kernel):
    """What the guest needs of a kernel package. Debian 13 has the modules below /usr, and compressed."""
    part = kernel.with_name(kernel.name + '.part')
    shutil.rmtree(part, ignore_errors=True)
    with subprocess.Popen(['dpkg', '--fsys-tarfile', file], stdout=subprocess.PIPE) as archive:
        with tarfile.open(fileobj=archive.stdout, mode='r|') as members:
            for member in members:
                wanted = WANTED.fullmatch(member.name)
                if wanted and member.isfile():
                    target = part / wanted.group('path')
                    target.parent.mkdir(parents=True, exist_ok=True)
                    data = members.extractfile(member).read()
                    target.write_bytes(lzma.decompress(data) if wanted.group('packed') else data)
    part.rename(kernel)


def parse(words):
    made = cli.Parser('hid_kernel', '[options]', DESCRIPTION, EPILOG, package='vibe_system_tests')
    add = made.options.add_argument
    add('--filter', metavar='PATTERN', default='*', help="only the tests of this pattern of GoogleTest, such as 'Replug.*' "
        "or '-Replug.*'")  # fmt: skip
    add('--log', metavar='FILE', default=os.devnull, help='write everything that the guest prints to FILE')
    add('--timeout', metavar='S', type=cli.whole('a number of seconds'), default=300, help='stop the guest after S seconds '
        '(default: %(default)s)')  # fmt: skip
    add('--devel', metavar='DIR', type=pathlib.Path, help='use the programs in DIR instead of building the workspace')
    return made.parse(words)


def complete(options):
    """Adds to the options what is found on this machine."""
    build = pathlib.Path(places.output_folder('build')).absolute()
    image = build.with_name('build-firmware') / 'arm/firmware_mps2_haptic_usb.elf'
    options.image = image if image.is_file() and shutil.which('qemu-system-arm') else None
    options.devel = (options.devel or build.with_name('devel')).resolve()
    options.sources = pathlib.Path(places.package_folder('vibe_system_tests')).resolve() / 'kernel_test'
    options.busybox = shutil.which('busybox')
    check_programs()
    options.kernel = find_kernel(build / 'hid_kernel')
    for program in ['usb_bridge', *PROGRAMS]:
        if not os.access(options.devel / 'lib/vibe_system_tests' / program, os.X_OK):
            raise SystemExit(f'hid_kernel: there is no program {program} in {options.devel}; run scripts/build --tests')


def test(options):
    """Runs the guest; returns whether all tests passed."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix='hid_kernel.'))  # short: the path of a socket has 107 characters
    guest = Guest(options, folder)
    try:
        guest.start()
        report = Report(guest.expected)
        with open(options.log, 'w') as log:
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
    return passed


def main():
    only_check = sys.argv[1:2] == ['--check']
    options = parse(sys.argv[1 + only_check:])
    if only_check:
        print('right')
        return 0
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        complete(options)
    except Missing as reason:
        print(f'hid_kernel: {reason}', file=sys.stderr)
        return 77
    return 0 if test(options) else 1


if __name__ == '__main__':
    sys.exit(main())
