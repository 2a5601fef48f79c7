"""Pages of the C++ interface: one for every folder of public headers, from the XML of Doxygen through Breathe."""

PACKAGES = ("vibe_core", "vibe_hardware", "vibe_vision", "vibe_firmware", "vibe_graphics", "vibe_rviz_plugins", "vibe_node")


def folders(root, package):
    """{folder: headers} of the public headers of a package."""
    include = root / "src" / package / "include"
    found = {}
    for header in sorted([*include.rglob("*.hpp"), *include.rglob("*.h")]):
        found.setdefault(header.parent.relative_to(include).as_posix(), []).append(header.relative_to(include).as_posix())
    return found


def page_of(folder, headers):
    lines = [folder, "=" * len(folder), ""]
    for header in headers:
        lines += [header, "-" * len(header), "", ".. doxygenfile:: " + header, "   :sections: briefdescription detaileddescription "
                  "innerclass enum typedef func var define user-defined public-type public-func public-attrib "
                  "public-static-func public-static-attrib protected-type protected-func protected-attrib", ""]
    return "\n".join(lines)


def pages(root, _xml):
    names = []
    for package in PACKAGES:
        for folder, headers in folders(root, package).items():
            name = folder.replace("/", "_")
            names.append(name)
            yield "reference/cpp/{}.rst".format(name), page_of(folder, headers)
    toctree = "\n".join("   cpp/" + name for name in names)
    yield "reference/cpp.rst", ("C++\n===\n\nThe public headers, one page for each folder. Headers of ``vibe_core`` need no "
                                "ROS.\n\n.. toctree::\n   :maxdepth: 1\n\n" + toctree + "\n")
