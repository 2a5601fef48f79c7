#!/usr/bin/env python3
"""A silicone stomach and its twin: mould, scene, sheet of readings, comparison, and a simulated laboratory."""
import argparse
import pathlib
import sys

import numpy as np

import lab
import sheet
from protocol import MODULUS, QUANTITIES, SCALE, WALL, modulus
from vibe_sessions.whole_file import open_whole

REMEDIES = {"vtk": "install python3-vtk9", "scipy": "install python3-scipy", "matplotlib": "install python3-matplotlib",
            "vibe": "run scripts/build --part python"}


def make_mould(arguments):
    import mould  # needs VTK
    arguments.out.mkdir(parents=True, exist_ok=True)
    good = mould.write(arguments.out, arguments.scale, 1e3 * arguments.wall, arguments.bed)
    if arguments.picture:
        import pictures
        pictures.draw_mould(arguments.out, arguments.picture)
    return 0 if good else 1


def make_scene(arguments):
    import twin
    with open_whole(arguments.out) as stream:
        stream.write(twin.scene(arguments.modulus, arguments.wall, arguments.scale))
    return 0


def make_sheet(arguments):
    sheet.write(arguments.out)
    return 0


def predictions(file, text):
    import twin
    folder = file.resolve().parent / "twin"
    folder.mkdir(exist_ok=True)
    return twin.predict(text, folder)


def make_readings(arguments):
    import twin
    true = MODULUS * (lab.STIFFER if arguments.fault == "stiff" else 1)
    predicted = predictions(arguments.sheet, twin.scene(true, WALL, arguments.scale))
    readings = lab.readings(predicted, MODULUS, 1e3 * WALL, arguments.fault, arguments.seed)
    lab.write(arguments.sheet, readings, arguments.fault)
    print(f"Readings of the twin with scatter and {lab.FAULTS.get(arguments.fault, 'no fault')}: {arguments.sheet}")
    return 0


def compare_sheet(arguments):
    import compare
    import pictures
    import twin
    readings = sheet.read(arguments.sheet)
    young = modulus(np.mean(readings["coupon"][QUANTITIES["coupon"].at[0]]))
    wall = 1e-3 * np.mean([value for values in readings["wall"].values() for value in values])
    text = arguments.scene.read_text() if arguments.scene else twin.scene(young, wall, arguments.scale)
    predicted = predictions(arguments.sheet, text)
    rows = compare.table(readings, predicted)
    print(f"modulus of the cylinder {young / 1e3:.1f} kPa, wall {1e3 * wall:.2f} mm\n")
    print(compare.as_text(rows))
    beyond = [f"{name} at {at:g}" for name in predicted for at, value in zip(QUANTITIES[name].at, predicted[name])
              if np.isnan(value)]
    print(f"not compared, because the twin pulls with at most 5 N: {', '.join(beyond)}\n" if beyond else "")
    fall = compare.fall(readings)
    print("" if fall is None else f"tightness: the pressure falls by {fall:.2f} mmHg in a minute")
    pictures.draw_comparison(rows, arguments.sheet.with_suffix(".png"))
    said = compare.causes(readings, rows)
    print("\n".join(said) if said else "No leak, unit, offset or other stiffness shows.")
    return 1 if said else 0


def thickness(text):
    if not 1e-3 <= float(text) <= 1e-2:
        raise argparse.ArgumentTypeError(f"a wall of {text} m cannot be cast so; give 0.001 to 0.01")
    return float(text)


def parse():
    parser = argparse.ArgumentParser(prog="scripts/phantom", description=__doc__ + " The protocol: docs/phantom.md.")
    parts = parser.add_subparsers(required=True, metavar="WHAT")

    def part(name, act, said, target):
        added = parts.add_parser(name, help=said, description=said)
        added.add_argument(target, type=pathlib.Path, metavar=target.upper())
        added.set_defaults(act=act)
        if name != "sheet":
            added.add_argument("--scale", type=float, default=SCALE, help="of the default stomach (%(default)s)")
        return added

    mould = part("mould", make_mould, "writes the mould as STL [mm] into a folder", "out")
    mould.add_argument("--bed", type=float, default=200, help="side of the printer's bed [mm] (%(default)s)")
    mould.add_argument("--picture", type=pathlib.Path, help="draw the parts into this PNG, too")
    scene = part("scene", make_scene, "writes the scene file of the twin", "out")
    scene.add_argument("--modulus", type=float, default=round(MODULUS), help="Young's modulus [Pa] (%(default)s)")
    for made in (mould, scene):
        made.add_argument("--wall", type=thickness, default=WALL, help="thickness of the wall [m] (%(default)s)")
    part("sheet", make_sheet, "writes an empty sheet of readings (CSV)", "out")
    simulated = part("lab", make_readings, "fills a sheet from the twin, with scatter", "sheet")
    faults = "; ".join(f"{name}: {said}" for name, said in lab.FAULTS.items()).replace("%", "%%")
    simulated.add_argument("--fault", choices=list(lab.FAULTS), help=faults)
    simulated.add_argument("--seed", type=int, default=1, help="of the scatter (%(default)s)")
    compared = part("compare", compare_sheet, "compares a sheet with the twin; status 1: a cause is named", "sheet")
    compared.add_argument("--scene", type=pathlib.Path, help="scene instead of the one made of cylinder and wall")
    return parser.parse_args()


def main():
    arguments = parse()
    try:
        return arguments.act(arguments)
    except ModuleNotFoundError as error:
        print(f"phantom: the module {error.name} is missing; {REMEDIES.get(error.name, 'install it')}.", file=sys.stderr)
        return 2
    except FileNotFoundError as error:
        print(f"phantom: there is no file {error.filename}; scripts/phantom sheet and scene write them.", file=sys.stderr)
        return 2
    except (sheet.SheetError, OSError, RuntimeError, ValueError) as error:  # vibe.Error is a RuntimeError
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
