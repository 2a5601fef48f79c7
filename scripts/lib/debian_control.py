#!/usr/bin/env python3
"""Writes the folder debian/ of the workspace: one Debian package per ROS package (vibe-core is vibe_core) with what is
needed at run time, and vibe-dev with what compilers read of all of them.

Dependencies are those of the package.xml files, translated by scripts/apt_packages.txt. Debian packages whose name ends in
-dev are dependencies of vibe-dev alone: the libraries in them are found by dpkg-shlibdeps. So are those of COMPILERS_ONLY.

Usage: debian_control.py WORKSPACE SYSTEM VERSION DATE MAINTAINER FOLDER BUILD_DEPENDENCY...
  SYSTEM is the code name of the Debian, DATE in seconds since 1970, FOLDER the debian/ to be made.
"""

import email.utils
import pathlib
import shutil
import sys
import textwrap

from catkin_pkg.package import parse_package

DEVELOPMENT = "vibe-dev"
DEVELOPMENT_ONLY = {"vibe_cmake", "vibe_testing"}
UNPACKAGED = {"vibe_system_tests", "vibe_vision_evidence"}  # they test and measure the workspace
# Python modules beside a library that is used in C++, and macros of CMake: they bring headers of all of ROS and Boost
COMPILERS_ONLY = {"python3-cv-bridge", "python3-tf2-ros", "ros-message-runtime"}
SHOWN_BY = {"vibe_description"}  # what shows it is recommended: the simulator without ROS reads it, too
EXPORTED = ("build_export_depends", "buildtool_export_depends", "exec_depends")  # <depend> is all three


def read_table(path, system):
    """{key: [Debian package, ...]}; a line KEY/SYSTEM replaces that of KEY."""
    general, special = {}, {}
    for line in path.read_text(encoding="utf-8").splitlines():
        key, *packages = line.split() or ["#"]
        name, _, of_system = key.partition("/")
        if not key.startswith("#") and of_system in ("", system):
            (special if of_system else general)[name] = packages
    return {**general, **special}


def debian_name(package):
    return DEVELOPMENT if package in DEVELOPMENT_ONLY else package.replace("_", "-")


class Dependencies:
    """Debian packages that stand for the dependencies of a ROS package."""

    def __init__(self, table, own):
        self.table = table
        self.own = own

    def of(self, package, kinds):
        keys = {dependency.name for kind in kinds for dependency in getattr(package, kind)}
        own = {"{} (= ${{binary:Version}})".format(debian_name(key)) for key in keys & self.own}
        return own | {name for key in keys - self.own for name in self.table[key]}


def paragraph(name, depends, title, text, recommends=()):
    fields = "".join("{}: {}\n".format(field, ",\n ".join(sorted(names)))
                     for field, names in (("Depends", depends), ("Recommends", recommends)) if names)
    return "Package: {}\nArchitecture: any\n{}Description: {}\n{}\n".format(
        name, fields, title, textwrap.fill(text, 78, initial_indent=" ", subsequent_indent=" "))


def is_for_compilers(name):
    return name.endswith("-dev") or name in COMPILERS_ONLY


def runtime_paragraph(package, dependencies):
    needed = {name for name in dependencies.of(package, ["exec_depends"]) if not is_for_compilers(name)}
    generated = {"${{{}:Depends}}".format(kind) for kind in ("misc", "python3", "scripts", "shlibs")}
    depends, recommends = (generated, needed) if package.name in SHOWN_BY else (generated | needed, ())
    return paragraph(debian_name(package.name), depends, "endoscopic suturing simulated: " + package.name,
                     package.description, recommends)


def development_paragraph(packages, dependencies):
    needed = set()
    for package in packages:
        alone = package.name in DEVELOPMENT_ONLY
        needed |= {name for name in dependencies.of(package, EXPORTED) if alone or is_for_compilers(name)}
        if not alone:
            needed.add("{} (= ${{binary:Version}})".format(debian_name(package.name)))
    needed = {name for name in needed if not name.startswith(DEVELOPMENT)}
    return paragraph(DEVELOPMENT, {"${misc:Depends}", "${python3:Depends}", "catkin", "g++", "make", *needed},
                     "endoscopic suturing simulated: headers",
                     "What packages need that build on those of ViBE for ROS: headers, static libraries, CMake files, and "
                     "what tests share.")


def copyright_text(license_text):
    lines = license_text.strip().splitlines()
    owner = next(line for line in lines if line.startswith("Copyright")).partition(") ")[2]
    body = "\n".join(" " + (line or ".") for line in lines)
    return ("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\n"
            "Files: *\nCopyright: {}\nLicense: BSD-3-clause\n{}\n".format(owner, body))


def control_text(packages, table, maintainer, build_dependencies):
    dependencies = Dependencies(table, {package.name for package in packages})
    source = ("Source: vibe\nSection: science\nPriority: optional\nMaintainer: {}\nBuild-Depends: {}\n"
              "Standards-Version: 4.6.2\n").format(maintainer, ",\n ".join(["debhelper-compat (= 13)", *build_dependencies]))
    runtime = [runtime_paragraph(package, dependencies) for package in packages if package.name not in DEVELOPMENT_ONLY]
    return "\n".join([source, *runtime, development_paragraph(packages, dependencies)])


def main():
    root, system, version, date, maintainer, folder = sys.argv[1:7]
    root, folder = pathlib.Path(root), pathlib.Path(folder)
    packages = [parse_package(path) for path in sorted(root.glob("src/*/package.xml"))]
    packages = [package for package in packages if package.name not in UNPACKAGED]
    table = read_table(root / "scripts/apt_packages.txt", system)
    shutil.copytree(root / "scripts/debian", folder)
    for rules in root.glob("src/*/udev/*.rules"):
        shutil.copy(rules, folder / (debian_name(rules.parts[-3]) + ".udev"))
    (folder / "control").write_text(control_text(packages, table, maintainer, sys.argv[7:]), encoding="utf-8")
    (folder / "ros_packages").write_text(
        "".join("{} {}\n".format(package.name, debian_name(package.name)) for package in packages), encoding="utf-8")
    (folder / "changelog").write_text("vibe ({}) {}; urgency=medium\n\n  * Built by scripts/package.\n\n -- {}  {}\n".format(
        version, system, maintainer, email.utils.formatdate(int(date))), encoding="utf-8")
    (folder / "copyright").write_text(copyright_text((root / "LICENSE").read_text(encoding="utf-8")), encoding="utf-8")


main()
