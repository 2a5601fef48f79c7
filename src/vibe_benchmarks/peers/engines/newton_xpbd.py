"""Newton, extended position based dynamics: springs along the sides, and hinges."""

import newton

from engines import newton_vbd
from engines.newton_cloth import Cloth, hinges
from scenes import FRAME

NAME, PACKAGE, VERSION = "Newton XPBD", "newton", newton.__version__
SWEEP = {f"{steps} sub-steps, {n} iterations{'' if hinges else ', no hinges'}":
         {"step": FRAME / steps, "iterations": n, "hinges": hinges}
         for steps, n, hinges in ((10, 10, 1), (160, 1, 1), (80, 1, 0))}  # fmt: skip


def cannot(scene):
    return {"membrane": "springs along sides: a Poisson's ratio of 1/3"} | newton_vbd.cannot(scene)


class Engine(Cloth):
    def fill(self, builder, common):
        builder.add_cloth_mesh(**common, tri_ke=0.0, tri_ka=0.0, tri_kd=0.0, edge_ke=1.0, edge_kd=0.0)
        found = hinges(self.scene)
        for (i, j), (side, areas) in found.items():
            # van Gelder: E t times the areas beside the side over its length squared
            builder.add_spring(int(i), int(j), self.stretch * areas / side**2, 0.0, 0.0)
        for e, nodes in enumerate(builder.edge_indices):
            side, areas = found[tuple(sorted(int(n) for n in nodes[2:]))]
            # the gradients of the hinge lack a division by twice the area of a triangle
            builder.edge_bending_properties[e] = (self.settings["hinges"] * self.bend * side**2 / areas**2, 0.0)

    def make_solver(self, model):
        return newton.solvers.SolverXPBD(model, iterations=self.settings["iterations"])
