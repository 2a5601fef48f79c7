"""The scene of one situation in Blender: lengths in cm, x right, y up, z towards the camera."""
import math
import os

from blender_scene import (ANGLE, BLACK, CENTRE, DISTANCE, EARLY, FINE, FINER, FOCAL, HEIGHT, LENGTH, OUTER, PAPER, RADIUS,
                           SIDE, WHITE, WIDTH, motion, pixel, place)

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
        from PIL import Image
        Image.MAX_IMAGE_PIXELS = None  # it is our own
        grey = np.asarray(Image.open(os.path.join(self.work, name + ".pgm"))) / 255.0
        height, width = grey.shape
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
