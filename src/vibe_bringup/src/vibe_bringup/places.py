"""Where things are: files of packages, and folders for what is made. Standard library and, where it is there, rospkg."""

import errno
import fcntl
import os

ROBOT = "package://vibe_description/urdf/scope.urdf"
RVIZ_CONFIG = "package://vibe_description/rviz/vibe.rviz"
SCENE = "package://vibe_core/scenes/stomach.yaml"
claims = []  # descriptors of the folders whose locks this process holds until it ends


def package_folder(package):
    """Of a package of the workspace that is sourced."""
    for place in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep):
        folder = os.path.join(place, package)
        if os.path.exists(os.path.join(folder, "package.xml")):
            return folder
    try:
        import rospkg
    except ImportError:  # ROS is not installed yet
        return ""
    try:
        return rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound:
        return ""


def find(address):
    """The path of package://PACKAGE/PATH; any other path as it is."""
    if not address.startswith("package://"):
        return address
    package, _, path = address[len("package://") :].partition("/")
    return os.path.join(package_folder(package), path)


def program(package, name):
    """The path of a program of a package. rosrun would look for it for half a second of processor time."""
    from vibe_sessions.headless import find_in_package  # here: scripts read their options without it

    path = find_in_package(package, name)
    if path is None:
        raise FileNotFoundError(errno.ENOENT, "no such program; install or build its package and source its workspace", package + "/" + name)
    return path


def output_folder(name):
    """Where a program writes by default: in the workspace if scripts/* started it and the user may write there, else in
    the present folder."""
    workspace = os.environ.get("VIBE_WORKSPACE", "")
    existing = os.path.join(workspace, os.path.dirname(name))
    while existing and not os.path.exists(existing):
        existing = os.path.dirname(existing)
    return os.path.join(workspace, name) if os.access(existing or ".", os.W_OK) else os.path.abspath(name)


def holds_session(folder):
    """Whether a session has been recorded there, or is being. One that failed before has left nothing but logs."""
    return any(os.path.lexists(os.path.join(folder, name)) for name in ("session.bag", "session.bag.active", "summary.txt"))


def claim_session(folder, free_name=False):
    """Makes the folder of a session with its folder for logs, which no other session gets while this process runs; with
    `free_name` the first free one of FOLDER, FOLDER-2 and so on. Returns its path. Raises FileExistsError."""
    name, number = folder, 1
    while True:
        os.makedirs(name, exist_ok=True)
        if claim_logs(os.path.join(name, "log")) and not holds_session(name):
            return name
        if not free_name:
            raise FileExistsError("'{}' already holds a session, or one runs there; give another folder".format(name))
        number += 1
        name = "{}-{}".format(folder, number)


def claim_logs(folder):
    """Whether this process got the folder, in which logs of a session that failed may be; logs are appended to."""
    try:
        os.mkdir(folder)
        is_new = True
    except FileExistsError:
        is_new = False
        if not os.path.isdir(folder) or not os.access(folder, os.W_OK):
            return False
    lock = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if isinstance(error, BlockingIOError) or not is_new:  # a file system without locks: the maker of the folder gets it
            os.close(lock)
            return False
    claims.append(lock)
    return True


def missing_folders(path):
    """The folders that must be made for this one to be there, the innermost first."""
    missing = []
    while not os.path.lexists(path):
        missing.append(path)
        path = os.path.dirname(path)
    return missing


def remove_empty(folders):
    """Takes these folders away as far as they are empty, the innermost first."""
    for folder in folders:
        if os.path.isdir(folder) and not os.listdir(folder):
            os.rmdir(folder)
