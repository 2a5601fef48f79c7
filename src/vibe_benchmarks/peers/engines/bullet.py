"""PyBullet: a deformable body of springs between the nodes, held by anchors."""

import importlib.metadata
import math
import os
import tempfile

import numpy as np
import pybullet

NAME, PACKAGE, VERSION = "PyBullet", "pybullet", importlib.metadata.version("pybullet")
SWEEP = {f"{rate} Hz, damping {damping:g}": {"step": 1 / rate, "damping": damping}  # of a spring [N s/m]
         for rate, damping in ((240, 0.1), (240, 0.01), (960, 0.001))}  # fmt: skip


def cannot(scene):
    if scene.pressure:
        return {"scene": "no gas, and no forces on nodes of a soft body"}
    if scene.thread:
        return {"scene": "no thread, and no forces on nodes of a soft body"}
    out = {"membrane": "equal springs along sides: a Poisson's ratio of 1/3",
           "bending": "no hinges, only bending springs, which hardly resist small angles"}  # fmt: skip
    return out | ({"force": "no force on anchors"} if scene.force else {})


class Engine:
    def __init__(self, scene, settings):
        self.scene, self.step_size = scene, settings["step"]
        p = self.client = pybullet
        if not p.isConnected():
            p.connect(p.DIRECT)
        p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
        p.setGravity(0, 0, -scene.gravity)
        p.setTimeStep(self.step_size)
        stiffness = math.sqrt(3) / 2 * scene.young * scene.thickness  # of springs in equilateral triangles [N/m]
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "wall.obj")
            with open(file, "w", encoding="utf-8") as stream:  # not whole: scratch
                stream.writelines("v {:.9g} {:.9g} {:.9g}\n".format(*n) for n in scene.nodes)
                stream.writelines("f {} {} {}\n".format(*t) for t in scene.triangles + 1)
            self.wall = p.loadSoftBody(
                file, mass=float(scene.masses().sum()), useNeoHookean=0, useMassSpring=1, useSelfCollision=0,
                useBendingSprings=1, springElasticStiffness=stiffness,
                springBendingStiffness=stiffness, springDampingStiffness=settings["damping"],
                springDampingAllDirections=1, collisionMargin=1e-4)
        rest = np.array(self.vertices())
        self.order = np.array([np.argmin(np.linalg.norm(rest - n, axis=1)) for n in scene.nodes])
        self.tools = [(h, self.anchor(h)) for h in scene.holds.values()]

    def vertices(self):
        return self.client.getMeshData(self.wall, -1, flags=self.client.MESH_DATA_SIMULATION_MESH)[1]

    def anchor(self, hold):
        tool = -1
        if hold.motions:
            tool = self.client.createMultiBody(baseMass=0)
        for n in hold.nodes:
            place = self.scene.nodes[n].tolist() if tool >= 0 else [0, 0, 0]
            self.client.createSoftBodyAnchor(self.wall, int(self.order[n]), tool, -1, place)
        return tool

    def place(self, time):
        for hold, tool in self.tools:
            if tool >= 0:
                at = hold.at(np.zeros((1, 3)), time)[0]
                turn = self.client.getQuaternionFromEuler([0, hold.turned(time), 0])
                self.client.resetBasePositionAndOrientation(tool, at.tolist(), turn)

    def step(self):
        self.client.stepSimulation()

    def positions(self):
        return np.array(self.vertices())[self.order]

    def force(self):
        return math.nan
