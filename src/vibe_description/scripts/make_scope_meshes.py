#!/usr/bin/python3
"""Writes the meshes of the endoscope with its suturing device into a folder, one OBJ file for each link that is drawn.

The URDF shows them; its collision shapes stay primitives. Shapes and numbers are in scope_parts.py, device_parts.py and
needle_parts.py, the dimensions that joints and collision shapes share with them in make_scope_urdf.py. The same program
writes the same bytes. Usage: make_scope_meshes.py ../meshes
"""
import argparse
import os
import sys

from device_parts import device_meshes
from obj_file import obj_text
from scope_parts import scope_meshes

LIBRARY = "scope.mtl"
NOTE = "Written by scripts/make_scope_meshes.py: change that program, not this file. Metres."

# name: diffuse colour, specular colour, shininess; rviz lights them from the eye. Colours are design choices.
MATERIALS = {
    "scope_black": ((0.045, 0.045, 0.050), 0.30, 40),    # polymer, matt gloss
    "scope_rubber": ((0.060, 0.060, 0.066), 0.18, 16),   # cover of the bending section
    "channel_dark": ((0.012, 0.012, 0.014), 0.02, 5),    # inside of a channel
    "device_polymer": ((0.20, 0.21, 0.22), 0.30, 24),
    "device_blue": ((0.10, 0.19, 0.33), 0.78, 60),       # anodised
    "steel": ((0.60, 0.60, 0.61), 0.90, 70),
    "steel_dark": ((0.36, 0.36, 0.37), 0.80, 40),
    "needle_gold": ((0.66, 0.50, 0.20), 0.90, 80),
    "thread_blue": ((0.10, 0.17, 0.32), 0.35, 30),
    "glass": ((0.03, 0.05, 0.11), 1.00, 110),
    "light_guide": ((0.95, 0.93, 0.80), 0.60, 60),
    "probe_polymer": ((0.07, 0.19, 0.34), 0.35, 30),
    "ceramic": ((0.80, 0.78, 0.72), 0.45, 50),
}


def library_text():
    lines = [f"# {NOTE}"]
    for name, (diffuse, specular, shininess) in MATERIALS.items():
        colour = " ".join(f"{v:g}" for v in diffuse)
        lines += [f"newmtl {name}", f"Ka {colour}", f"Kd {colour}", f"Ks {specular:g} {specular:g} {specular:g}",
                  f"Ns {shininess}"]
    return "\n".join(lines) + "\n"


def files():
    """Name and text of every file."""
    texts = {name + ".obj": obj_text(mesh, LIBRARY, NOTE) for name, mesh in {**scope_meshes(), **device_meshes()}.items()}
    texts[LIBRARY] = library_text()
    return texts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where the files go; those of the same name are replaced")
    folder = parser.parse_args().folder
    if not os.path.isdir(folder):
        sys.exit(f"make_scope_meshes.py: there is no folder '{folder}'; make it first.")
    for name, text in files().items():
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(text)


if __name__ == "__main__":
    main()
