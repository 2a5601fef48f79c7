"""Builds the module with plain CMake, together with the core and what its scenes name, into one folder that may be
moved. Needs the Debian packages that docs/python.md lists; neither ROS nor a network."""

import atexit
import os
import shutil
import subprocess
import sys
import tempfile

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.sdist import sdist
from wheel.bdist_wheel import bdist_wheel

HEADERS = os.environ.get("VIBE_PYTHON_HEADERS", "")  # of Pythons beside this one, folders that end in python3.N; see CMakeLists.txt
HERE = os.path.dirname(os.path.abspath(__file__))
PARTS = ("vibe_core", "vibe_cmake", "vibe_description")  # beside this folder; in a source distribution within it
BESIDE = HERE if os.path.isdir(os.path.join(HERE, PARTS[0])) else os.path.dirname(HERE)
SCRATCH = tempfile.mkdtemp(prefix="vibe_python_")  # nothing is left beside the sources
atexit.register(shutil.rmtree, SCRATCH, ignore_errors=True)


class BuildWithCMake(build_ext):
    """The whole of the package is made by `cmake --install`."""

    def run(self):
        if not os.path.isdir(os.path.join(BESIDE, PARTS[0])):
            raise SystemExit("There is no folder vibe_core beside vibe_python; install from the whole repository")
        core = os.environ.get("VIBE_CORE_PREFIX", "")  # an installed core, instead of building one
        build = os.path.abspath(os.path.join(self.build_temp, "cmake"))
        prefix = os.path.join(os.path.abspath(self.build_temp), "prefix")
        shutil.rmtree(prefix, ignore_errors=True)
        if core:
            shutil.copytree(core, prefix, symlinks=True)
        os.makedirs(build, exist_ok=True)
        self.cmake("-S", HERE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF",
                   "-DVIBE_CORE_PREFIX=" + core, "-DCMAKE_INSTALL_PREFIX=" + prefix, "-DCMAKE_INSTALL_LIBDIR=lib",
                   "-DVIBE_PYTHON_HEADERS=" + HEADERS, "-DPython_EXECUTABLE=" + sys.executable, "-DPYTHON_EXECUTABLE=" + sys.executable)
        self.cmake("--build", build, "-j", os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1)))
        self.cmake("--install", build)
        package = os.path.join(self.build_lib, "vibe") if not self.inplace else os.path.join(HERE, "python", "vibe")
        self.gather(prefix, package)

    @staticmethod
    def cmake(*words):
        subprocess.run(["cmake", *words], check=True)

    @staticmethod
    def gather(prefix, package):
        """Without what only programs in C++ need."""
        for unneeded in ("include", "lib/cmake", "bin/vibe_headless", "bin/vibe_technique"):
            path = os.path.join(prefix, unneeded)
            if os.path.isdir(path):
                shutil.rmtree(path)
            elif os.path.exists(path):
                os.remove(path)
        shutil.copytree(prefix, package, dirs_exist_ok=True)


class SourceDistribution(sdist):
    """All that is compiled and installed, without tests."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        unneeded = shutil.ignore_patterns("test", "fuzz", "__pycache__", "*.pyc")
        for folder in ("src", "python", "programs"):
            shutil.copytree(os.path.join(HERE, folder), os.path.join(base_dir, folder), ignore=unneeded, dirs_exist_ok=True)
        for file in ("CMakeLists.txt", "package.xml"):
            shutil.copy2(os.path.join(HERE, file), base_dir)
        licence = os.path.join(BESIDE, "..", "LICENSE")
        if os.path.exists(licence):
            shutil.copy2(licence, base_dir)
        for folder in PARTS:
            shutil.copytree(os.path.join(BESIDE, folder), os.path.join(base_dir, folder), ignore=unneeded)


class WheelOfSeveralPythons(bdist_wheel):
    """Its name says each Python that it has a module for."""

    def get_tag(self):
        python, abi, platform = super().get_tag()
        if not HEADERS:
            return python, abi, platform
        further = sorted(int(folder.rsplit(".", 1)[1]) for folder in HEADERS.split(";"))
        return ".".join([python, *(f"cp3{number}" for number in further)]), "none", platform


setup(
    name="vibe-esg",
    version="1.0.0",
    description="A simulator of endoscopic sleeve gastroplasty as a Python module",
    license="BSD-3-Clause",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["vibe", "vibe.data", "vibe.env", "vibe.patient"],
    package_dir={"": "python"},
    package_data={"vibe": ["py.typed"]},
    ext_modules=[Extension("vibe._core", sources=[])],
    options={"build": {"build_base": SCRATCH}, "egg_info": {"egg_base": SCRATCH}},
    cmdclass={"build_ext": BuildWithCMake, "bdist_wheel": WheelOfSeveralPythons, "sdist": SourceDistribution},
    zip_safe=False,
)
