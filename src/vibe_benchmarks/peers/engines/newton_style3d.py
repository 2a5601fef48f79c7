"""Newton, Style3D: projective dynamics of cloth that is cut from flat panels."""

import newton
import numpy as np
import warp as wp
from newton.solvers import style3d

from engines import newton_vbd
from engines.newton_cloth import CM, Cloth, settings

NAME, PACKAGE, VERSION = "Newton Style3D", "newton", newton.__version__
SWEEP = settings((1, 10, 1, 0), (2, 10, 1, 0))


def cannot(scene):
    if scene.pressure:
        return {"scene": "a panel is flat: no closed surface"}
    out = newton_vbd.cannot(scene)
    if scene.poisson:
        out |= {"bending": "of the mean curvature alone", "membrane": "no Poisson's ratio"}
    return out


class Engine(Cloth):
    CAPTURES = False  # its linear solver makes calls of the host

    def fill(self, builder, common):
        newton.solvers.SolverStyle3D.register_custom_attributes(builder)
        s = self.scene
        corners = s.nodes[s.triangles] * CM  # every triangle is laid flat by itself
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        x = u / np.linalg.norm(u, axis=1, keepdims=True)
        height = np.linalg.norm(np.cross(x, v), axis=1)
        if (abs(s.nodes[:, 2]) < 1e-9).all():  # weft along x
            flat = corners[:, :, :2].reshape(-1, 2)
        else:
            zero = 0 * height
            flat = np.stack([zero, zero, (u * x).sum(1), zero, (v * x).sum(1), height], 1).reshape(-1, 2)
        style3d.add_cloth_mesh(
            builder, **common, panel_verts=[wp.vec2(*p) for p in flat], panel_indices=np.arange(len(flat)).tolist(),
            tri_aniso_ke=wp.vec3(self.stretch, self.stretch, self.stretch / 2 / (1 + s.poisson)),
            edge_aniso_ke=wp.vec3(self.bend, self.bend, self.bend), tri_ka=0.0, tri_kd=0.0, edge_kd=0.0)

    def make_solver(self, model):
        config = newton.solvers.SolverStyle3D.Config(iterations=self.settings["iterations"])
        solver = newton.solvers.SolverStyle3D(model, config=config)
        solver.collision = None
        return solver
