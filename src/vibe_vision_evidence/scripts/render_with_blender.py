#!/usr/bin/env python3
"""Draws the rig with Blender's Cycles, a renderer that shares nothing with this package, as labelled sequences.

    render_with_blender.py --list
    render_with_blender.py --situation lambert --frames 60 --out lambert
    rosrun vibe_vision vibe_track --images 'lambert/*.png' --config lambert/config.yaml --csv lambert/result.csv
    score_frames.py lambert

The markers are textures made of the printed sheet: vibe_marker_sheet's PDF, drawn by pdftoppm. Paper, metal, lamps, a
lens with a round aperture and motion blur are Cycles'. What Cycles does not do follows in numpy: the optics' Gaussian
of 0.6 px, photon and read noise (12 dB gain of the design camera), the response curve, rounding.

Into the folder go frame_NNNNNN.png, frames.csv, truth.csv and config.yaml, in the formats of vibe_render. Needs the
Debian packages blender, poppler-utils and python3-pil; the first two are needed by nothing else of the workspace.
"""
import argparse
import ast
import math
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from blender_scene import (ANGLE, FINE, FINER, FOCAL, CENTRE, GAIN, HEIGHT, LENGTH, OPTICS, PAPER, RADIUS, RATE, READ, ROWS,
                           SCALE, SIDE, SITUATIONS, STANDARD, TEXELS, WHITE, WIDTH, motion, pixel, place)


def write_config(folder):
    origin = {name: pixel(place(name, 0.0)) for name in ROWS}
    direction = "[%.12f, %.12f]" % (math.cos(ANGLE), math.sin(ANGLE))
    with open(os.path.join(folder, "config.yaml"), "w", encoding="utf-8") as out:
        out.write("camera:\n  size: [%d, %d]\n  focal_length: [%g px, %g px]\n  centre: [%g px, %g px]\n" %
                  (WIDTH, HEIGHT, FOCAL, FOCAL, *CENTRE))
        out.write("instruments:\n")
        for name, marker in (("helix", "sleeve: {}"),
                             ("needle_driver", "ring: {outer_diameter: 4 mm, inner_diameter: 2 mm, side: 7 mm}")):
            out.write("  - name: %s\n    marker:\n      %s\n" % (name, marker))
            out.write("    axis: {origin: [%.6f px, %.6f px], direction: %s, scale: %g px/mm}\n" %
                      (*origin[name], direction, SCALE))
            out.write("    range: [-25 mm, 25 mm]\n    slide_joint: {name: %s}\n" % name)


def sheet_crops(folder):
    """Pictures of the sleeve's strip and of the ring's square, cut out of the printed sheet: files of PGM."""
    pdf = os.path.join(folder, "sheet.pdf")
    config = os.path.join(folder, "config.yaml")
    subprocess.run(["rosrun", "vibe_vision", "vibe_marker_sheet", "--config", config, "--pdf", pdf, "--copies", "1",
                    "--no-board", "--no-guide", "--thickness", "%g mm" % PAPER], check=True, stdout=subprocess.DEVNULL)
    turn = math.pi * (2 * RADIUS - PAPER)
    below = 47 + turn + 2.5 + 24  # the next row: overlap of the strip, gaps and label
    for name, y, width, height in (("helix", 47, LENGTH, turn), ("needle_driver", below, SIDE, SIDE)):
        box = [str(round(v * TEXELS * FINER)) for v in (35, y, width, height)]
        subprocess.run(["pdftoppm", "-r", str(25.4 * TEXELS * FINER), "-gray", "-singlefile", "-aaVector", "no", "-x",
                        box[0], "-y", box[1], "-W", box[2], "-H", box[3], pdf, os.path.join(folder, name)], check=True)


def start_blender(options):
    for program, package in (("blender", "blender"), ("pdftoppm", "poppler-utils"), ("rosrun", "this workspace")):
        if not shutil.which(program):
            sys.exit("%s is not installed; %s" % (program, "install the Debian package %s." % package
                                                  if program != "rosrun" else "source devel/setup.bash first."))
    os.makedirs(options.out, exist_ok=True)
    write_config(options.out)
    with tempfile.TemporaryDirectory() as work:
        shutil.copy(os.path.join(options.out, "config.yaml"), work)
        sheet_crops(work)
        result = subprocess.run(["blender", "-b", "--factory-startup", "-noaudio", "--python-exit-code", "1",
                                 "--python", os.path.abspath(__file__), "--", "--situation", options.situation,
                                 "--frames", str(options.frames), "--samples", str(options.samples), "--first",
                                 str(options.first), "--out", os.path.abspath(options.out), "--work", work,
                                 *("--set=%s=%s" % pair for pair in options.set)],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if result.returncode:
        sys.exit("Blender did not draw the situation; its last words: " + result.stdout[-2000:])


def around(name, slide, exposure):
    x, y = pixel(place(name, slide))
    half = (75 if name == "helix" else 50) + 260 * exposure * 10
    tall = 32 if name == "helix" else 48
    return tuple(int(v) for v in (max(0, x - half), max(0, y - tall), min(WIDTH, x + half), min(HEIGHT, y + tall)))


def blurred(radiance):
    """By the optics' Gaussian, then the mean over each pixel."""
    import numpy as np
    reach = 4 * FINE
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / (OPTICS * FINE))**2)
    kernel /= kernel.sum()
    padded = np.pad(radiance, reach, mode="edge")
    rows = sum(w * padded[:, k:k + radiance.shape[1]] for k, w in enumerate(kernel))
    fine = sum(w * rows[k:k + radiance.shape[0], :] for k, w in enumerate(kernel))
    return fine.reshape(fine.shape[0] // FINE, FINE, fine.shape[1] // FINE, FINE).mean(axis=(1, 3))


def through_jpeg(grey, quality):
    import io
    import numpy as np
    from PIL import Image
    file = io.BytesIO()
    Image.fromarray(grey).save(file, "JPEG", quality=quality)
    return np.asarray(Image.open(file))


def exposed(radiance, settings, seed):
    """Grey values: noise of the sensor, response, rounding."""
    import numpy as np
    random = np.random.default_rng(seed)
    linear = blurred(radiance) / WHITE * settings["white"]
    if settings["bayer"]:  # half of the pixels are of other colours: green from its neighbours there
        mosaic = linear + random.normal(size=linear.shape) * np.sqrt(GAIN * linear + READ**2)
        y, x = np.mgrid[0:linear.shape[0], 0:linear.shape[1]]
        padded = np.pad(mosaic, 1, mode="edge")
        mean = (padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]) / 4
        linear = np.where((x + y) % 2 == 0, mosaic, mean)
    else:
        linear = linear + random.normal(size=linear.shape) * np.sqrt(GAIN * linear + READ**2)
    return np.rint(255 * np.clip(linear / 255, 0, 1)**(1 / settings["gamma"])).astype(np.uint8)


def draw_frame(rig, background, settings, k, stamp):
    """Rows of a rolling shutter are exposed one after the other: bands of it are drawn for their own time."""
    radiance = background.copy()
    for name, slide in zip(ROWS, motion(settings, stamp)):
        left, top, right, bottom = around(name, slide, settings["exposure"])
        if settings["row_time"]:
            left, right = max(0, left - 30), min(WIDTH, right + 30)
        step = 4 if settings["row_time"] else bottom - top
        for row in range(top, bottom, step):
            rig.move(stamp + settings["row_time"] * (min(row + step, bottom) + row - 1) / 2)
            end = min(row + step, bottom)
            radiance[FINE * row:FINE * end, FINE * left:FINE * right] = rig.draw((left, row, right, end))
    return exposed(radiance, settings, 1000 + k)


def inside_blender(options):
    import numpy as np
    from PIL import Image
    from blender_rig import Rig
    settings = {**STANDARD, **SITUATIONS[options.situation], **dict(options.set)}
    rig = Rig(settings, options.samples, options.work)
    for thing in rig.markers.values():
        thing.hide_render = True
    rig.scene.cycles.samples = 1
    background = np.full((FINE * HEIGHT, FINE * WIDTH), 0.12)
    top, bottom = (round(pixel(place(name, 0))[1] + side * 60) for name, side in zip(ROWS, (-1, 1)))
    background[FINE * top:FINE * bottom] = rig.draw((0, top, WIDTH, bottom))
    rig.scene.cycles.samples = options.samples
    for thing in rig.markers.values():
        thing.hide_render = False
    with open(os.path.join(options.out, "frames.csv"), "w", encoding="utf-8") as frames, \
            open(os.path.join(options.out, "truth.csv"), "w", encoding="utf-8") as truth:
        frames.write("sequence,stamp,exposure\n")
        truth.write("sequence,stamp,instrument,slide,rotation,along,lateral,x,y,velocity,visible\n")
        for k in range(options.first, options.first + options.frames):
            stamp = k / RATE
            grey = draw_frame(rig, background, settings, k, stamp)
            if settings["jpeg"]:
                grey = through_jpeg(grey, settings["jpeg"])
            Image.fromarray(grey).save(os.path.join(options.out, "frame_%06d.png" % k))
            frames.write("%d,%.9f,%g\n" % (k, stamp, settings["exposure"]))
            helix, needle, turn = motion(settings, stamp)
            rig.move(stamp)
            for name, slide in (("helix", helix), ("needle_driver", needle)):
                x, y = pixel(place(name, slide))
                faces = math.atan2(*place(name, slide)[1:])  # the camera looks at the rod from this angle
                truth.write("%d,%.9f,%s,%.9g,%.9g,%.9g,0,%.9g,%.9g,0,%.3f\n" %
                            (k, stamp, name, slide * 1e-3, turn + faces if name == "helix" else float("nan"), slide * SCALE, x, y,
                             rig.visible(name, slide)))


def setting(text):
    key, _, value = text.partition("=")
    if key not in STANDARD:
        raise argparse.ArgumentTypeError("'%s' is none of %s" % (key, ", ".join(STANDARD)))
    return key, value if isinstance(STANDARD[key], str) else ast.literal_eval(value)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="name the situations")
    parser.add_argument("--situation", choices=SITUATIONS, help="what to draw")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", type=setting,
                        help="another value than the situation has, such as gamma=1.6")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--first", type=int, default=0, help="number of the first frame")
    parser.add_argument("--samples", type=int, default=12, help="per ninth of a pixel; noise of the picture itself")
    parser.add_argument("--out", help="folder")
    parser.add_argument("--work", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.list:
        print("\n".join(SITUATIONS))
    elif not options.situation or not options.out:
        parser.error("give --situation and --out")
    elif options.work:
        inside_blender(options)
    else:
        start_blender(options)


if __name__ == "__main__":
    main()
