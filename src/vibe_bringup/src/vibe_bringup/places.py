"""Where things are: files of packages, and folders for what is made. Standard library and, where it is there, rospkg."""

import os

ROBOT = "package://vibe_description/urdf/scope.urdf"
RVIZ_CONFIG = "package://vibe_description/rviz/vibe.rviz"
SCENE = "package://vibe_core/scenes/stomach.yaml"


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


def output_folder(name):
    """Where a program writes by default: in the workspace if scripts/* started it and the user may write there, else in
    the present folder."""
    workspace = os.environ.get("VIBE_WORKSPACE", "")
    existing = os.path.join(workspace, os.path.dirname(name))
    while existing and not os.path.exists(existing):
        existing = os.path.dirname(existing)
    return os.path.join(workspace, name) if os.access(existing or ".", os.W_OK) else os.path.abspath(name)


def holds_session(folder):
    """Whether a session has been there, or runs there now."""
    return any(os.path.lexists(os.path.join(folder, name)) for name in ("session.bag", "session.bag.active", "log"))


def claim_session(folder, free_name=False):
    """Makes the folder of a session with its folder for logs, which no other session gets; with `free_name` the first
    free one of FOLDER, FOLDER-2 and so on. Returns its path. Raises FileExistsError."""
    name, number = folder, 1
    while True:
        os.makedirs(name, exist_ok=True)
        try:
            if os.path.lexists(os.path.join(name, "session.bag")):
                raise FileExistsError("'{}' already holds a session".format(name))
            os.mkdir(os.path.join(name, "log"))  # only one succeeds
            return name
        except FileExistsError:
            if not free_name:
                raise FileExistsError("'{}' already holds a session; give another folder".format(name)) from None
        number += 1
        name = "{}-{}".format(folder, number)


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
