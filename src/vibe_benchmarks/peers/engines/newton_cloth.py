"""Newton on the CPU: what the cloths of its solvers VBD, XPBD and Style3D share. Lengths are in centimetres, because
Newton passes over hinges beside triangles whose double area is below 1e-6."""

import math

import newton
import numpy as np
import warp as wp

from scenes import FRAME

wp.config.quiet = True
CM = 100.0
THREAD_GAIN = 15.0  # [N/m]


def settings(*sweep):
    """Settings by name: (sub-steps, iterations, whether hinges act, damping over stiffness [s]) each."""
    return {f"{steps} sub-step{'s'[:steps > 1]}, {n} iteration{'s'[:n > 1]}{'' if hinges else ', no hinges'}"
            f"{', damped' if damping else ''}":
            {"step": FRAME / steps, "iterations": n, "hinges": hinges, "damping": damping}
            for steps, n, hinges, damping in sweep}  # fmt: skip


def hinges(scene):
    """Per side of triangles, by its sorted nodes: its length [cm], and the sum of the areas beside it [cm^2]."""
    area = scene.areas()[0] * CM**2
    found = {}
    for t, nodes in enumerate(scene.triangles):
        for k in range(3):
            found.setdefault(tuple(sorted((nodes[k], nodes[k - 1]))), []).append(t)
    return {side: (np.linalg.norm(np.subtract(*scene.nodes[list(side)])) * CM, sum(area[t] for t in ts))
            for side, ts in found.items()}  # fmt: skip


class Cloth:
    """What the three solvers share. A subclass makes builder and solver."""

    CAPTURES = True

    def __init__(self, scene, settings):
        self.scene, self.settings = scene, settings
        self.step_size, self.frame, self.tension = settings["step"], -1, 0.0
        self.stretch = scene.young * scene.thickness  # [N/m]
        self.bend = scene.bending * CM**2  # [N cm^2/m = kg cm^2/s^2]
        self.damping = 0.0 if scene.gravity else settings["damping"]  # what falls freely is not damped
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, -scene.gravity * CM))
        common = {"pos": wp.vec3(0.0), "rot": wp.quat_identity(), "vel": wp.vec3(0.0), "scale": 1.0,
                  "vertices": [wp.vec3(*p) for p in scene.nodes * CM], "indices": scene.triangles.ravel().tolist(),
                  "density": scene.density * scene.thickness / CM**2, "particle_radius": 0.01}  # fmt: skip
        self.fill(builder, common)
        self.still = np.concatenate([h.nodes for h in scene.holds.values()])
        for n, mass in enumerate(scene.masses()):
            builder.particle_mass[n] = mass
        for n in self.still:
            builder.particle_mass[n] = 0.0
            builder.particle_flags[n] = int(builder.particle_flags[n]) & ~int(newton.ParticleFlags.ACTIVE)
        self.model = self.finish(builder)
        self.solver = self.make_solver(self.model)
        self.now, self.next, self.control = self.model.state(), self.model.state(), self.model.control()
        self.forces = np.zeros((len(scene.nodes), 3))
        self.launch()  # compiles
        self.graph = None
        if self.CAPTURES:  # one call from Python per step
            with wp.ScopedCapture(device="cpu") as capture:
                self.launch()
            self.graph = capture.graph
        self.reset()

    def finish(self, builder):
        return builder.finalize(device="cpu")

    def reset(self):
        self.now.particle_q.numpy()[:] = self.scene.nodes * CM
        self.now.particle_qd.numpy()[:] = 0

    def place(self, time):
        q = self.now.particle_q.numpy()
        for hold in self.scene.holds.values():
            if hold.motions:
                q[hold.nodes] = hold.at(self.scene.nodes[hold.nodes], time) * CM
        self.forces[:] = 0
        if self.scene.thread:
            self.pull(time)

    def pull(self, time):
        """The thread as a pair of forces; its tension is corrected once per frame."""
        thread = self.scene.thread
        if int(time / FRAME) > self.frame:
            self.frame = int(time / FRAME)
            rest = thread.length(self.scene.nodes)
            missing = thread.length(self.positions()) - rest - min(time, 1) * (thread.distance - rest)
            self.tension = max(0.0, self.tension + THREAD_GAIN * missing)
        for sign, (nodes, weights) in ((-1, thread.plus), (1, thread.minus)):
            self.forces[nodes, 0] += sign * self.tension * weights

    def apply(self, forces):
        self.forces += forces

    def launch(self):
        self.solver.step(self.now, self.next, self.control, None, self.step_size)
        wp.copy(self.now.particle_q, self.next.particle_q)
        wp.copy(self.now.particle_qd, self.next.particle_qd)

    def step(self):
        self.now.particle_f.numpy()[:] = self.forces * CM
        if self.graph:
            wp.capture_launch(self.graph)
        else:
            self.launch()

    def positions(self):
        return self.now.particle_q.numpy().astype(float) / CM

    def force(self):
        return self.tension if self.scene.thread else math.nan
