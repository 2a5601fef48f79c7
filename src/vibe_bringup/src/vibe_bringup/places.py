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
    """Where a program writes by default: in the workspace if scripts/* started it, else in the present folder."""
    return os.path.join(os.environ.get("VIBE_WORKSPACE", ""), name)


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
