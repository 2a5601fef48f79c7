#!/usr/bin/env python3
"""Draws the rig with Blender's Cycles, a renderer that shares nothing with this package, as labelled sequences.

    render_with_blender.py --list
    render_with_blender.py --situation lambert --frames 60 --out lambert
    rosrun vibe_vision vibe_track --images 'lambert/*.png' --config lambert/config.yaml --csv lambert/result.csv
    render_with_blender.py --score lambert

The markers are textures made of the printed sheet: vibe_marker_sheet's PDF, drawn by pdftoppm. Paper, metal, lamps, a
lens with a round aperture and motion blur are Cycles'. What Cycles does not do follows in numpy: the optics' Gaussian
of 0.6 px, photon and read noise (12 dB gain of the design camera), the response curve, rounding.

Into the folder go frame_NNNNNN.png, frames.csv, truth.csv and config.yaml, in the formats of vibe_render. Needs the
Debian packages blender and poppler-utils; nothing else of the workspace does.
"""
import argparse
import ast
import csv
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

RATE = 147.0  # frames per second
WIDTH, HEIGHT, FOCAL = 728, 544, 4600.0  # [px]
CENTRE = (361.4, 274.2)  # principal point [px]
SCALE = 10.0  # [px/mm]
DISTANCE = FOCAL / SCALE  # of the camera from both axes [mm]
ANGLE = math.radians(0.5)  # of both axes in the image
ROWS = {"helix": 180.3, "needle_driver": 300.6}  # where the axes pass the middle of the image [px]
RADIUS, LENGTH, PAPER = 1.5, 10.0, 0.1  # of the sleeve, thickness of the paper [mm]
SIDE, OUTER = 7.0, 4.0  # of the ring's square, diameter of the ring [mm]
TEXELS, FINER = 100, 8  # of a marker's texture per mm; pdftoppm moves edges to whole pixels, so it draws finer ones
BLACK, WHITE = 0.05, 0.85  # reflectance of ink and paper
GAIN, READ, OPTICS = 0.096, 0.6, 0.6  # [DN], [DN], [px]
# Cycles' table of the shutter has 256 entries, and its pictures show the motion one entry early: 0.37 % of the exposure,
# measured with the ring in two situations.
EARLY = 1 / 256
FINE = 3  # parts of a pixel's side that are drawn one by one, so that the optics' blur comes before the pixels

# Keys: speed [m/s] at the middle of the motion, turn [rad/s], exposure [s]; lambert: share of the light that comes from
# the lamp and shades as matt paper does, the rest is even; light: angle of the lamp from the camera [deg], and around;
# defocus: radius of the disc [px]; gamma of the response; white: of the brightest paper [DN]; step: from one frame, at
# rest, to the next [mm].
STANDARD = dict(speed=0.5, turn=30.0, exposure=1e-3, lambert=0.0, light=(0, 0), defocus=0.0, gamma=1.0, white=200.0,
                gloss=0.0, lamps=1, extra="", jpeg=0, bayer=False, row_time=0.0, step=0.0)
SITUATIONS = {
    "rest": dict(speed=0.0, turn=0.0),
    "stops": dict(speed=0.0, turn=0.0, lambert=1.0, step=3.0),
    "moving": {},
    "lambert35": dict(lambert=0.35),
    "lambert": dict(lambert=1.0),
    "lambert_side": dict(lambert=1.0, light=(40, 90)),
    "lambert_along": dict(lambert=1.0, light=(40, 0)),
    "two_lamps": dict(lambert=1.0, light=(35, 90), lamps=2),
    "window": dict(lambert=0.7, light=(60, 60)),
    "defocus2": dict(defocus=2.0),
    "defocus3": dict(defocus=3.0),
    "gamma22": dict(gamma=2.2),
    "gamma24": dict(gamma=2.4),
    "long_exposure": dict(exposure=4e-3),
    "grey": dict(white=80.0),
    "jpeg": dict(jpeg=75),
    "bayer": dict(bayer=True),
    "wet": dict(lambert=1.0, light=(25, 90), gloss=0.6),
    "fingers": dict(extra="fingers"),
    "dirt": dict(extra="dirt"),
    "curled": dict(extra="curled"),
    "bent": dict(extra="bent"),
    "askew": dict(extra="askew"),
    "rolling": dict(row_time=10e-6),
    "everything": dict(lambert=0.7, light=(30, 90), defocus=1.5, gamma=1.6, extra="fingers", gloss=0.3, white=150.0),
}


def motion(settings, t):
    """Slides of helix and needle driver [mm], and rotation of the helix [rad], at a time [s]."""
    w = 2 * math.pi * 5.3
    speed, turn = settings["speed"] * 1e3 / w, settings["turn"] / w
    if settings["speed"] == 0:
        k = round(t * RATE)
        way = settings["step"] * (k - 6)
        return 3.137 + way, -5.413 + way, 0.4 + (0.7 * k if settings["step"] else 0)
    return (speed * math.sin(w * t) + 0.31, speed * math.sin(w * t + 1.1) + 0.2, turn * math.sin(w * t + 0.6) + 0.4)


def place(name, slide):
    """Of a marker's centre, relative to the camera: x right, y down, z away [mm]."""
    x = ((WIDTH - 1) / 2 - CENTRE[0]) / SCALE + slide * math.cos(ANGLE)
    return x, (ROWS[name] - CENTRE[1]) / SCALE + slide * math.sin(ANGLE), DISTANCE


def pixel(point):
    return tuple(FOCAL * point[k] / point[2] + CENTRE[k] for k in range(2))


# --- without Blender


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


def write_png(file, grey):
    rows = b"".join(b"\0" + row.tobytes() for row in grey)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(file, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", *grey.shape[::-1], 8, 0, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


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


def score(folder):
    """One line per instrument: frames found, error along the axis, wrong ones, mean squared normalised error."""
    def rows(name):
        with open(os.path.join(folder, name), encoding="utf-8", newline="") as file:
            return {(r["sequence"], r["instrument"]): r for r in csv.DictReader(file)}

    truth, seen = rows("truth.csv"), rows("result.csv")
    for name in ROWS:
        keys = [k for k in truth if k[1] == name and float(truth[k]["visible"]) >= 0.5]
        found = [k for k in keys if k in seen and seen[k]["tracked"] == "1"]
        slides = [(float(seen[k]["slide"]) - float(truth[k]["slide"]), float(seen[k]["slide_deviation"])) for k in found]
        right = [(e, d) for e, d in slides if abs(e) < 5e-4]
        silent = sum(1 for k, (e, _) in zip(found, slides) if abs(e) >= 5e-4 and not seen[k]["doubt"])
        line = "%-14s found %d/%d wrong %d, without doubt %d" % (name, len(right), len(keys), len(slides) - len(right), silent)
        if right:
            mean = sum(e for e, _ in right) / len(right)
            rms = math.sqrt(sum(e * e for e, _ in right) / len(right))
            spread = math.sqrt(max(0.0, rms * rms - mean * mean))
            line += "  rms %.4f px (mean %+.4f, spread %.4f)  nees %.2f" % (
                rms * SCALE * 1e3, mean * SCALE * 1e3, spread * SCALE * 1e3, sum((e / d)**2 for e, d in right) / len(right))
        if right and name == "helix":
            turns = [float(seen[k]["rotation"]) - float(truth[k]["rotation"]) for k in found]
            turns = [math.degrees(math.remainder(t, 2 * math.pi)) for t in turns]
            line += "  rotation %.2f deg (mean %+.2f)" % (math.sqrt(sum(t * t for t in turns) / len(turns)),
                                                         sum(turns) / len(turns))
        print(line)


# --- inside of Blender: lengths in cm, x right, y up, z towards the camera

CM = 0.1  # per mm


class Rig:
    """The scene of one situation."""

    def __init__(self, settings, samples, work):
        import bpy
        self.bpy, self.settings = bpy, settings
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = bpy.context.scene
        self.work = work
        self.set_renderer(samples)
        self.add_camera()
        self.add_lamps()
        self.markers = {"helix": self.add_sleeve(), "needle_driver": self.add_ring()}
        self.add_rods()
        if settings["extra"] == "fingers":
            self.add_finger()

    def set_renderer(self, samples):
        scene, settings = self.scene, self.settings
        scene.render.engine = "CYCLES"
        scene.cycles.samples = samples
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.use_denoising = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.filter_width = 1.0
        scene.cycles.max_bounces = 2 if settings["gloss"] else 0
        scene.render.threads_mode, scene.render.threads = "FIXED", 2
        scene.render.use_persistent_data = True
        scene.render.resolution_x, scene.render.resolution_y = WIDTH * FINE, HEIGHT * FINE
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.use_motion_blur = settings["speed"] > 0
        scene.render.motion_blur_shutter = 1.0  # a frame of the scene is an exposure
        world = self.bpy.data.worlds.new("w")
        world.color = (0, 0, 0)
        scene.world = world

    def add_camera(self):
        data = self.bpy.data.cameras.new("camera")
        camera = self.bpy.data.objects.new("camera", data)
        self.scene.collection.objects.link(camera)
        camera.location = (0, 0, DISTANCE * CM)
        data.sensor_fit, data.sensor_width, data.lens = "HORIZONTAL", 36.0, 36.0 * FOCAL / WIDTH
        data.clip_end = 1000
        data.shift_x = ((WIDTH - 1) / 2 - CENTRE[0]) / WIDTH
        data.shift_y = -((HEIGHT - 1) / 2 - CENTRE[1]) / WIDTH
        self.scene.camera = camera
        if self.settings["defocus"] > 0:
            # radius of the disc = aperture radius * focal length [px] * |1 / distance - 1 / focus|
            focus = DISTANCE * 1.08
            radius = self.settings["defocus"] / (FOCAL * abs(1 / DISTANCE - 1 / focus))  # [mm]
            data.dof.use_dof, data.dof.focus_distance = True, focus * CM
            data.dof.aperture_blades = 0
            # Cycles: radius = lens [m] / (2 fstop), in units of the scene
            data.dof.aperture_fstop = data.lens * 1e-3 / (2 * radius * CM)

    def add_lamps(self):
        tilt, around = (math.radians(a) for a in self.settings["light"])
        for k in range(self.settings["lamps"]):
            data = self.bpy.data.lights.new("lamp", "SUN")
            data.energy = math.pi / self.settings["lamps"]  # a white plane that faces it has radiance 1
            data.angle = math.radians(2)
            lamp = self.bpy.data.objects.new("lamp", data)
            side = around + k * math.pi
            from mathutils import Matrix
            lamp.matrix_world = Matrix.Rotation(side, 4, "Z") @ Matrix.Rotation(tilt, 4, "Y")
            self.scene.collection.objects.link(lamp)

    def image(self, name):
        import numpy as np
        with open(os.path.join(self.work, name + ".pgm"), "rb") as file:
            words, data = [], file.read()
        at = 0
        while len(words) < 4:
            end = at
            while data[end:end + 1] not in (b" ", b"\n"):
                end += 1
            words.append(data[at:end])
            at = end + 1
        width, height = int(words[1]), int(words[2])
        grey = np.frombuffer(data[at:], np.uint8).reshape(height, width) / 255.0
        width, height = width // FINER, height // FINER
        grey = grey[:height * FINER, :width * FINER].reshape(height, FINER, width, FINER).mean(axis=(1, 3))
        grey = BLACK + (WHITE - BLACK) * grey
        if self.settings["extra"] == "dirt":
            random = np.random.default_rng(5)
            y, x = np.mgrid[0:height, 0:width]
            for _ in range(40):
                cx, cy, r = random.uniform(0, width), random.uniform(0, height), random.uniform(5, 25)
                grey = np.where((x - cx)**2 + (y - cy)**2 < r * r, 0.3 * grey + 0.05, grey)
        image = self.bpy.data.images.new(name, width, height, alpha=False, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = grey[::-1, :, None]  # Blender's rows go up
        image.pixels.foreach_set(pixels.ravel())
        image.update()
        return image

    def material(self, image=None, grey=0.3, gloss=None):
        """Even light as emission, the lamp's as Lambert shading, and a glossy coat."""
        material = self.bpy.data.materials.new("m")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        def node(kind):
            return tree.nodes.new(kind)

        share = self.settings["lambert"]
        diffuse, even, mix, out = (node(k) for k in ("ShaderNodeBsdfDiffuse", "ShaderNodeEmission",
                                                     "ShaderNodeMixShader", "ShaderNodeOutputMaterial"))
        if image:
            texture = node("ShaderNodeTexImage")
            texture.image, texture.extension = image, "EXTEND"
            tree.links.new(texture.outputs["Color"], diffuse.inputs["Color"])
            tree.links.new(texture.outputs["Color"], even.inputs["Color"])
        else:
            diffuse.inputs["Color"].default_value = even.inputs["Color"].default_value = (grey, grey, grey, 1)
        mix.inputs[0].default_value = 1 - share
        tree.links.new(diffuse.outputs[0], mix.inputs[1])
        tree.links.new(even.outputs[0], mix.inputs[2])
        last = mix.outputs[0]
        gloss = self.settings["gloss"] if gloss is None else gloss
        if gloss:
            coat, over = node("ShaderNodeBsdfGlossy"), node("ShaderNodeAddShader")
            coat.inputs["Roughness"].default_value = 0.25
            coat.inputs["Color"].default_value = (0.04 * gloss,) * 3 + (1,)
            tree.links.new(last, over.inputs[0])
            tree.links.new(coat.outputs[0], over.inputs[1])
            last = over.outputs[0]
        tree.links.new(last, out.inputs[0])
        return material

    def add_mesh(self, name, points, faces, texture, material):
        mesh = self.bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], faces)
        if texture:
            layer = mesh.uv_layers.new()
            for loop in mesh.loops:
                layer.data[loop.index].uv = texture[loop.vertex_index]
        for face in mesh.polygons:
            face.use_smooth = True
        mesh.materials.append(material)
        thing = self.bpy.data.objects.new(name, mesh)
        thing.rotation_mode = "XYZ"
        self.scene.collection.objects.link(thing)
        return thing

    def tube(self, name, radius, begin, end, material, steps=512, askew=0.0):
        """Around x. The print's angle phi grows from the side of the camera to y down; its picture goes down with it.
        A sleeve that was glued askew [rad] has its ends further along on one side of the rod than on the other."""
        points, faces, texture = [], [], []
        for i in range(steps + 1):
            phi = math.pi * (2 * i / steps - 1)
            for k, x in enumerate((begin, end)):
                points.append(((x + radius * math.tan(askew) * math.sin(phi)) * CM, -radius * CM * math.sin(phi),
                               radius * CM * math.cos(phi)))
                texture.append((k, 1 - i / steps))
        for i in range(steps):
            faces.append((2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1))
        return self.add_mesh(name, points, faces, texture, material)

    def add_sleeve(self):
        askew = math.radians(2) if self.settings["extra"] == "askew" else 0
        return self.tube("helix", RADIUS, -LENGTH / 2, LENGTH / 2, self.material(self.image("helix")), askew=askew)

    def add_rods(self):
        metal = self.material(grey=0.25, gloss=0.8)
        rod = self.tube("rod", RADIUS - PAPER, -80, 80, metal)
        self.put(rod, place("helix", 0.0), 0)
        plate = self.add_mesh("plate", [(x * CM, y * CM, 0) for x, y in ((-80, -3), (80, -3), (80, 3), (-80, 3))],
                              [(0, 1, 2, 3)], None, self.material(grey=0.25, gloss=0))
        x, y, z = place("needle_driver", 0.0)
        self.put(plate, (x, y, z + 0.5), 0)
        far = self.add_mesh("far", [(x * CM, y * CM, 0) for x, y in ((-90, -90), (90, -90), (90, 90), (-90, 90))],
                            [(0, 1, 2, 3)], None, self.material(grey=0.12, gloss=0))
        self.put(far, (0, 0, DISTANCE + 25), 0)

    def add_ring(self):
        steps, points, faces, texture = 48, [], [], []
        bend = {"bent": 1 / 10.0, "curled": 1 / 150.0}.get(self.settings["extra"], 1e-9)  # curvature [1/mm]
        for j in range(steps + 1):
            for i in range(steps + 1):
                a, b = (i / steps - 0.5) * SIDE, (0.5 - j / steps) * SIDE
                lift = (math.cos(bend * a) - 1) / bend  # glued on something round
                if self.settings["extra"] == "curled":
                    corner = max(0.0, (a + b) / SIDE - 0.2)
                    lift += 1.5 * corner * corner
                points.append((math.sin(bend * a) / bend * CM, b * CM, lift * CM))
                texture.append((i / steps, 1 - j / steps))
        for j in range(steps):
            for i in range(steps):
                k = j * (steps + 1) + i
                faces.append((k, k + steps + 1, k + steps + 2, k + 1))
        return self.add_mesh("needle_driver", points, faces, texture, self.material(self.image("needle_driver")))

    def add_finger(self):
        """A round tip that covers both axes from about slide 0 to 17 mm."""
        skin = self.material(grey=0.45, gloss=0.1)
        finger = self.tube("finger", 8, -60, 60, skin, 96)
        x, y, z = place("helix", 9.5)
        finger.location = (x * CM, -y * CM, (DISTANCE - z + 12) * CM)
        finger.rotation_euler = (0, 0, math.radians(80))

    def put(self, thing, point, turn):
        x, y, z = point
        thing.location = (x * CM, -y * CM, (DISTANCE - z) * CM)
        thing.rotation_euler = (turn, 0, -ANGLE)

    def visible(self, name, slide):
        """Share of the marker's picture, of the ring that of its outer disc, that nothing covers where it is now."""
        from mathutils import Vector
        graph, camera = self.bpy.context.evaluated_depsgraph_get(), self.scene.camera.location
        x, y, z = place(name, slide)
        half, height = (LENGTH / 2, RADIUS) if name == "helix" else (OUTER / 2, OUTER / 2)
        seen = points = 0
        for i in range(40):
            for j in range(40):
                a, b = (2 * i + 1) / 40 - 1, (2 * j + 1) / 40 - 1
                if name != "helix" and a * a + b * b > 1:
                    continue
                u, v, lift = a * half, b * height, RADIUS * math.sqrt(1 - b * b) if name == "helix" else 0
                point = (x + u * math.cos(ANGLE) - v * math.sin(ANGLE), y + u * math.sin(ANGLE) + v * math.cos(ANGLE), z - lift)
                column, row = pixel(point)
                ray = Vector((point[0] * CM, -point[1] * CM, (DISTANCE - point[2]) * CM)) - camera
                hit, _, _, _, thing, _ = self.scene.ray_cast(graph, camera, ray.normalized())
                points += 1
                seen += hit and thing.name == name and -0.5 < column < WIDTH - 0.5 and -0.5 < row < HEIGHT - 0.5
        return seen / points

    def move(self, stamp):
        """Keys of the motion during the exposure; frame 1 of the scene is its middle."""
        stamp += EARLY * self.settings["exposure"]
        for name, thing in self.markers.items():
            thing.animation_data_clear()
            steps = 8 if self.settings["speed"] > 0 else 0
            thing.cycles.use_motion_blur, thing.cycles.motion_steps = True, 3
            for k in range(-steps, steps + 1):
                t = stamp + self.settings["exposure"] * k / max(1, 2 * steps)
                helix, needle, turn = motion(self.settings, t)
                self.put(thing, place(name, helix if name == "helix" else needle), turn if name == "helix" else 0)
                for path in ("location", "rotation_euler"):
                    thing.keyframe_insert(path, frame=1 + k / max(1, 2 * steps))
            for curve in thing.animation_data.action.fcurves:
                for key in curve.keyframe_points:
                    key.interpolation = "LINEAR"
        self.scene.frame_set(1)

    def draw(self, box):
        """Radiance of the parts of the pixels of [left, right) x [top, bottom)."""
        import numpy as np
        left, top, right, bottom = box
        render = self.scene.render
        render.use_border, render.use_crop_to_border = True, True
        safe = 0.25 / FINE  # Blender rounds down
        render.border_min_x, render.border_max_x = (left + safe) / WIDTH, (right + safe) / WIDTH
        render.border_min_y, render.border_max_y = 1 - (bottom - safe) / HEIGHT, 1 - (top - safe) / HEIGHT
        render.filepath = os.path.join(self.work, "part.exr")
        self.scene.cycles.seed += 1
        self.bpy.ops.render.render(write_still=True)
        image = self.bpy.data.images.load(render.filepath)
        width, height = image.size
        assert (width, height) == (FINE * (right - left), FINE * (bottom - top)), (image.size[:], box)
        pixels = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        self.bpy.data.images.remove(image)
        return pixels.reshape(height, width, 4)[::-1, :, 0].astype(float)


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


def through_jpeg(rig, grey, quality):
    import numpy as np
    bpy = rig.bpy
    height, width = grey.shape
    image = bpy.data.images.new("jpeg", width, height)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = grey[::-1, :, None] / 255.0
    image.pixels.foreach_set(pixels.ravel())
    image.file_format, image.filepath_raw = "JPEG", os.path.join(rig.work, "jpeg.jpg")
    image.save(quality=quality) if "quality" in image.bl_rna.functions["save"].parameters else image.save()
    bpy.data.images.remove(image)
    image = bpy.data.images.load(os.path.join(rig.work, "jpeg.jpg"))
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_get(pixels.reshape(-1))
    bpy.data.images.remove(image)
    return np.rint(pixels[::-1, :, 0] * 255)


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
    return np.clip(np.rint(255 * np.clip(linear / 255, 0, 1)**(1 / settings["gamma"])), 0, 255)


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
    settings = {**STANDARD, **SITUATIONS[options.situation], **dict(options.set)}
    rig = Rig(settings, options.samples, options.work)
    for thing in rig.markers.values():
        thing.hide_render = True
    rig.scene.cycles.samples = 1
    import numpy as np
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
                grey = through_jpeg(rig, grey, settings["jpeg"])
            write_png(os.path.join(options.out, "frame_%06d.png" % k), grey.astype(np.uint8))
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
    parser.add_argument("--score", metavar="FOLDER", help="compare FOLDER/result.csv with FOLDER/truth.csv")
    parser.add_argument("--work", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.list:
        print("\n".join(SITUATIONS))
    elif options.score:
        score(options.score)
    elif not options.situation or not options.out:
        parser.error("give --situation and --out")
    elif options.work:
        inside_blender(options)
    else:
        start_blender(options)


if __name__ == "__main__":
    main()
