"""Newton, extended position based dynamics: springs along the sides, and hinges."""

import newton

from engines import newton_vbd
from engines.newton_cloth import Cloth, hinges, settings

NAME, PACKAGE, VERSION = "Newton XPBD", "newton", newton.__version__
SWEEP = settings((10, 10, 1, 0), (160, 1, 1, 0), (80, 1, 0, 0), (160, 1, 1, 0.001))


def cannot(scene):
    return {"membrane": "springs along sides: a Poisson's ratio of 1/3"} | newton_vbd.cannot(scene)


class Engine(Cloth):
    def fill(self, builder, common):
        builder.add_cloth_mesh(**common, tri_ke=0.0, tri_ka=0.0, tri_kd=0.0, edge_ke=1.0, edge_kd=0.0)
        found = hinges(self.scene)
        for (i, j), (side, areas) in found.items():
            # van Gelder: E t times the areas beside the side over its length squared
            stiffness = self.stretch * areas / side**2
            builder.add_spring(int(i), int(j), stiffness, self.damping * stiffness, 0.0)
        for e, nodes in enumerate(builder.edge_indices):
            side, areas = found[tuple(sorted(int(n) for n in nodes[2:]))]
            # the gradients of the hinge lack a division by twice the area of a triangle
            stiffness = self.settings["hinges"] * self.bend * side**2 / areas**2
            builder.edge_bending_properties[e] = (stiffness, self.damping * stiffness)

    def make_solver(self, model):
        return newton.solvers.SolverXPBD(model, iterations=self.settings["iterations"])
