#!/usr/bin/env python3
"""What the endoscope's lens sees: rays, colours by the stated formula, and the pictures of environments."""
import os
import tempfile
import threading
import unittest
import zlib

import numpy as np

import vibe
from vibe.env import Environment, VectorEnvironment

SMALL = {"particles": 300, "organs": [("sthenic", 1.0)]}
ANGLE = 1.7


def rays(size):
    """Through the middle of every pixel, in the camera, of depth 1: (size, size, 3)."""
    focal = size / (2 * np.tan(ANGLE / 2))
    row, column = np.mgrid[0:size, 0:size] + 0.5
    return np.stack([(column - size / 2) / focal, (row - size / 2) / focal, np.ones_like(row)], -1)


def albedo(simulation, size, power=2):
    """By triangle with at least ten pixels: distance [m], and albedo of red that follows from the picture if light falls
    with a power of the distance."""
    picture, pose = simulation.camera(size, size, ANGLE, colour=True), simulation.link_pose("scope_camera_optical")
    place = picture["depth"][..., None].astype(float) * rays(size) @ pose[:3, :3].T
    corner = simulation.model.triangles[picture["triangle"]]
    weight = np.linalg.solve((simulation.positions[corner] - pose[:3, 3]).swapaxes(2, 3), place[..., None])[..., 0]
    normal = np.einsum("ijk,ijkl->ijl", weight, simulation.normals[corner])
    distance = np.linalg.norm(place, axis=-1)
    cosine = np.abs(np.einsum("ijk,ijk->ij", normal, place)) / distance / np.linalg.norm(normal, axis=-1)
    share = (picture["colour"][..., 0] / 255.0) ** 2
    found = share / (1 - share) / cosine * (distance / 0.03) ** power
    seen, count = np.unique(picture["triangle"], return_counts=True)
    masks = {t: picture["triangle"] == t for t in seen[count >= 10]}
    return {t: (distance[mask].mean(), found[mask].mean()) for t, mask in masks.items()}


class CameraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        model = vibe.load(geometry={"particles": 300}, render_surface=False)
        cls.simulation = vibe.Simulation(model)
        cls.simulation.run(240, insertion=0.05, insufflate=True)

    def test_pictures_are_those_of_every_ray_against_every_triangle(self):
        simulation = self.simulation
        size = 24
        picture = simulation.camera(size, size, ANGLE, normals=True)
        pose = simulation.link_pose("scope_camera_optical")
        corner = (simulation.positions - pose[:3, 3]) @ pose[:3, :3]
        a, b, c = np.swapaxes(corner[simulation.model.triangles], 0, 1)
        for v, u in [(0, 0), (3, 17), (12, 12), (23, 5), (20, 20)]:
            ray = rays(size)[v, u]
            h = np.cross(ray, c - a)
            det = np.einsum("ij,ij->i", b - a, h)
            q = np.cross(-a, b - a)
            s, t = np.einsum("ij,ij->i", -a, h) / det, q @ ray / det
            depth = np.einsum("ij,ij->i", c - a, q) / det
            depth[(s < 0) | (t < 0) | (s + t > 1) | (depth <= 0)] = np.inf
            self.assertAlmostEqual(picture["depth"][v, u], depth.min(), delta=1e-7)
            self.assertEqual(picture["triangle"][v, u], depth.argmin())
            self.assertLess(picture["normal"][v, u] @ (ray * depth.min()), 0)
        self.assertTrue(set(np.unique(picture["label"])) <= set(range(6)))

    def test_light_falls_with_the_square_of_the_distance(self):
        """The lens comes nearer, and the albedo of every triangle stays; not so with another law."""
        near = vibe.Simulation(self.simulation.model)
        near.restore(self.simulation.snapshot())
        near.run(60, insertion=0.09)
        for power in (2, 1):
            before, after = albedo(self.simulation, 96, power), albedo(near, 96, power)
            common = [t for t in before if t in after and after[t][0] < 0.8 * before[t][0]]
            self.assertGreater(len(common), 20)
            change = np.array([after[t][1] / before[t][1] for t in common])
            if power == 2:
                self.assertLess(np.quantile(abs(change - 1), 0.9), 0.04)  # of some a part is hidden
                self.assertLess(np.median(abs(change - 1)), 0.01)
                self.assertTrue(all(0.4 < found < 1 for _, found in before.values()))
            else:
                self.assertGreater(np.median(change), 1.2)

    def test_a_wall_that_is_touched_is_red(self):
        simulation = vibe.Simulation(self.simulation.model)
        simulation.run(240, insertion=0.05, insufflate=True)
        redness = []
        for insertion in (0.16, 0.18):  # 2 mm before the wall, and pressed on it
            simulation.run(300, insertion=insertion)
            picture = simulation.camera(40, 40, 0.8, colour=True)
            redness.append(picture["colour"][..., 0].mean() / picture["colour"][..., 1].mean())
        self.assertLess(np.median(picture["depth"]), 0.001)  # else it says nothing
        self.assertGreater(redness[1], 1.3 * redness[0])  # a lamp alone makes what is near white

    def test_colours_are_the_same_on_any_thread_and_marks_are_pale(self):
        colour = self.simulation.camera(40, 30, colour=True)["colour"]
        self.assertEqual((colour.shape, colour.dtype), ((30, 40, 3), np.uint8))
        self.assertTrue(np.all(colour[..., 0] > colour[..., 2]))
        others, simulations = [], [vibe.Simulation(self.simulation.model, threads=2) for _ in range(3)]
        for simulation in simulations:
            simulation.restore(self.simulation.snapshot())
        workers = [threading.Thread(target=lambda s=s: others.append(s.camera(40, 30, colour=True)["colour"]))
                   for s in simulations]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        for other in others:
            np.testing.assert_array_equal(other, colour)
        self.assertEqual(len(others), 3)
        simulation = vibe.Simulation(self.simulation.model)  # not insufflated: a mark has all corners of a triangle
        simulation.follow(vibe.Trainee(simulation.model, "name: m\nskill: {like: expert}\ngoals:\n  - mark: {along: 0.45, around: 0 rad}\n"))
        picture, marked = simulation.camera(64, 64, colour=True), simulation.burn_grade > 0
        pale = marked[simulation.model.triangles].all(1)[picture["triangle"]]
        self.assertGreater(pale.sum(), 0)
        share = picture["colour"][..., 2] / picture["colour"][..., 0]
        self.assertGreater(share[pale].min(), share[~marked[simulation.model.triangles].any(1)[picture["triangle"]]].max())

    def test_the_device_hides_the_wall_and_nothing_else_changes(self):
        simulation = vibe.Simulation(self.simulation.model)
        simulation.run(240, insertion=0.05, helix_advance=0.02, insufflate=True)
        wall, seen = simulation.camera(96, 96, ANGLE, normals=True), simulation.camera(96, 96, ANGLE, normals=True, tool=True)
        hidden = seen["label"] == 6
        self.assertTrue(0.02 < hidden.mean() < 0.5)
        self.assertTrue(np.all(seen["depth"][hidden] < wall["depth"][hidden]))
        self.assertTrue(np.all(seen["triangle"][hidden] == -1))
        for name in wall:
            np.testing.assert_array_equal(seen[name][~hidden], wall[name][~hidden])
        tip = np.linalg.inv(simulation.link_pose("scope_camera_optical")) @ simulation.link_pose("helix")[:, 3]
        row, column = (96 / (2 * np.tan(ANGLE / 2)) * tip[[1, 0]] / tip[2] + 48).astype(int)
        around = np.s_[row - 3:row + 4, column - 3:column + 4]
        self.assertTrue(hidden[around].any())
        self.assertLess(abs(seen["depth"][around][hidden[around]].max() - tip[2]), 2e-3)  # the wire turns about the axis
        simulation.run(30, helix_advance=0.0)
        self.assertFalse((simulation.camera(96, 96, ANGLE, tool=True)["label"][around] == 6).any())  # control
        before = (simulation.camera(96, 96, ANGLE, tool=True)["label"] == 6).sum()
        simulation.run(1, apc_pedal=True)  # the probe comes out
        self.assertGreater((simulation.camera(96, 96, ANGLE, tool=True)["label"] == 6).sum(), before)

    def test_particles_that_are_seen_are_in_the_picture(self):
        simulation, size = self.simulation, 192
        picture, pose = simulation.camera(size, size, ANGLE, tool=True), simulation.link_pose("scope_camera_optical")
        place = (simulation.positions - pose[:3, 3]) @ pose[:3, :3]
        pixel = np.floor(size / (2 * np.tan(ANGLE / 2)) * place[:, 1::-1] / place[:, 2:] + size / 2).astype(int)
        within = (place[:, 2] > 0) & np.all((pixel >= 1) & (pixel < size - 1), axis=1)
        row, column = pixel[within].T
        shown = np.abs(picture["depth"][row, column] - place[within, 2]) < 4e-3
        seen = simulation.sees(distance=1, angle=np.pi / 2)[within]
        self.assertGreater(seen.sum(), 20)
        self.assertGreater((seen == shown).mean(), 0.95)
        self.assertLess((simulation.sees(distance=1, angle=np.pi / 2, field_of_view=0.8)[within] == shown).mean(), 0.9)  # control
        known = simulation.sees()
        self.assertFalse(simulation.sees(known).any())
        np.testing.assert_array_equal(simulation.sees(~known), known)
        np.testing.assert_array_equal(simulation.sees(distance=0.1), known)
        with self.assertRaisesRegex(vibe.Error, "'distance' is not above 0"):
            simulation.sees(distance=-1)
        with self.assertRaisesRegex(vibe.Error, "'leave_out' has the shape"):
            simulation.sees(known[:-1])

    def test_meshes_have_the_scale_of_the_urdf(self):
        here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../vibe_description/urdf/scope.urdf")
        with open(here, encoding="utf-8") as file, tempfile.NamedTemporaryFile("w", suffix=".urdf", encoding="utf-8") as wide:
            wide.write(file.read().replace('meshes/helix.obj"', 'meshes/helix.obj" scale="1 3 3"'))
            wide.flush()
            device = {}
            for urdf in (here, wide.name):
                simulation = vibe.Simulation(vibe.load(geometry={"particles": 300}, scope={"urdf": urdf}, render_surface=False))
                simulation.run(60, helix_advance=0.02)
                device[urdf] = (simulation.camera(96, 96, ANGLE, tool=True)["label"] == 6).sum()
        self.assertGreater(device[wide.name], 1.2 * device[here])

    def test_a_camera_elsewhere_sees_the_inside_of_the_far_wall(self):
        simulation = self.simulation
        lens = {"normals": True, "colour": True}
        seen, same = (simulation.camera(48, 48, ANGLE, **lens, **pose) for pose in ({}, {"pose": simulation.link_pose("scope_camera_optical")}))
        for name in seen:
            np.testing.assert_array_equal(seen[name], same[name])
        pose, middle = np.eye(4), simulation.positions.mean(0)
        pose[:3, :3], pose[:3, 3] = [[0, 0, -1], [1, 0, 0], [0, -1, 0]], middle + [0.6, 0, 0]
        wall, scope = (simulation.camera(96, 96, 0.6, colour=True, tool=tool, pose=pose, lamp=0.6) for tool in (False, True))
        a, b, c = np.swapaxes(simulation.positions[simulation.model.triangles], 0, 1)
        inside = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - pose[:3, 3]) > 0
        self.assertTrue(0.1 < (wall["triangle"] >= 0).mean() < 0.6)
        self.assertTrue(inside[np.unique(wall["triangle"])[1:]].all())
        self.assertFalse(inside.all())  # control
        hides = scope["label"] == 6
        self.assertGreater(hides[:10].sum(), 5)  # the shaft, which comes from above
        np.testing.assert_array_equal(scope["colour"][~hides], wall["colour"][~hides])

    def test_a_lamp_that_reaches_farther_is_brighter(self):
        share = [(self.simulation.camera(24, 24, colour=True, lamp=lamp)["colour"][..., 0] / 255.0) ** 2 for lamp in (0.03, 0.06)]
        self.assertAlmostEqual(np.median(share[1] / (1 - share[1]) / share[0] * (1 - share[0])), 4, delta=0.1)

    def test_pictures_for_people(self):
        simulation = self.simulation
        endoscope, outside, marked = (vibe.picture(simulation, view, 64, goal) for view, goal in (
            ("endoscope", None), ("outside", None), ("outside", simulation.positions.mean(0))))
        np.testing.assert_array_equal(endoscope, simulation.camera(64, 64, 1.7, colour=True, tool=True)["colour"])
        edge = np.concatenate([outside[0], outside[-1], outside[:, 0], outside[:, -1]])
        self.assertLess((edge > 0).any(-1).mean(), 0.1)  # the whole organ is in it; the shaft leaves it
        row, column = np.nonzero((marked != outside).any(-1))
        self.assertTrue(0 < len(row) < 9 and abs(row - 32).max() < 12 and abs(column - 32).max() < 12)
        file = simulation._repr_png_()
        rows = np.frombuffer(zlib.decompress(file[41:-16]), np.uint8).reshape(480, 1 + 3 * 480)[:, 1:]
        np.testing.assert_array_equal(rows.reshape(480, 480, 3), vibe.picture(simulation))

    def test_threads_are_where_the_bites_are(self):
        environment = Environment("Cinch", camera=(96, 96, 2.2), pictures=["label"], tool=True, **SMALL)
        label = environment.reset(seed=1)[0]["label"]
        simulation = environment.simulation
        bites = simulation.threads()[0]["bites"]
        middle = np.c_[(bites[1:] + bites[:-1]) / 2, np.ones(len(bites) - 1)] @ np.linalg.inv(simulation.link_pose("scope_camera_optical")).T
        pixel = (96 / (2 * np.tan(1.1)) * middle[:, [1, 0]] / middle[:, 2:3] + 48).astype(int)
        near = [label[max(v - 6, 0):v + 7, max(u - 6, 0):u + 7] for (v, u), z in zip(pixel, middle[:, 2]) if z > 0 and 0 <= v < 96 and 0 <= u < 96]
        self.assertGreater(sum((part == 7).any() for part in near), 0)
        self.assertFalse((Environment("Reach", camera=(96, 96, 2.2), tool=True, **SMALL).reset(seed=1)[0]["label"] == 7).any())  # control

    def test_environments_give_the_pictures_that_are_asked_for(self):
        pictures = ["colour", "normal", "label", "depth"]
        seen = {}
        for environment in (Environment("Reach", camera=(12, 8, ANGLE), pictures=pictures, **SMALL),
                            VectorEnvironment("Reach", 2, camera=(12, 8, ANGLE), pictures=pictures, **SMALL)):
            found, _ = environment.reset(seed=1)
            self.assertTrue(environment.observation_space.contains(found))
            seen[type(environment)] = found
        for name in pictures:
            np.testing.assert_array_equal(seen[Environment][name], seen[VectorEnvironment][name][0])
        self.assertEqual((seen[Environment]["colour"].shape, seen[Environment]["colour"].dtype), ((8, 12, 3), np.uint8))
        only = Environment("Reach", camera=(12, 8, ANGLE), pictures=["colour"], **SMALL)
        self.assertNotIn("depth", only.reset(seed=1)[0])
        with self.assertRaisesRegex(vibe.Error, "'pictures' is .'smell'.*depth, label, normal, colour"):
            Environment("Reach", camera=(12, 8, ANGLE), pictures=["smell"])
        with self.assertRaisesRegex(vibe.Error, "'tool' is True.*with True a camera"):
            Environment("Reach", tool=True)


if __name__ == "__main__":
    unittest.main()
