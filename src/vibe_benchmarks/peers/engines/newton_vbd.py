"""Newton, vertex block descent: neo-Hookean membrane and hinges."""

import newton

from engines.newton_cloth import Cloth, hinges, settings

NAME, PACKAGE, VERSION = "Newton VBD", "newton", newton.__version__
SWEEP = settings((1, 10, 1, 0), (1, 40, 1, 0), (10, 10, 1, 0), (4, 10, 0, 0), (10, 10, 1, 0.01))


def cannot(scene):
    out = {"bending": "hinges act as a Poisson's ratio of -1/3"} if scene.poisson else {}
    if scene.force and not scene.thread:
        out["force"] = "no force on held nodes"
    if scene.thread:
        out["thread"] = "no thread between spots: its tension is a controlled pair of forces"
    if scene.pressure:
        out["gas"] = "no gas: its forces come from the user"
    return out


class Engine(Cloth):
    def fill(self, builder, common):
        s = self.scene
        lame, shear = self.stretch * s.poisson / (1 - s.poisson**2), self.stretch / 2 / (1 + s.poisson)
        builder.add_cloth_mesh(**common, tri_ke=shear, tri_ka=lame, tri_kd=self.damping * shear, edge_ke=1.0, edge_kd=0.0)
        found = hinges(s)
        for e, nodes in enumerate(builder.edge_indices):
            side, areas = found[tuple(sorted(int(n) for n in nodes[2:]))]
            stiffness = self.settings["hinges"] * self.bend * side / areas
            builder.edge_bending_properties[e] = (stiffness, self.damping * stiffness)

    def finish(self, builder):
        builder.color(include_bending=True)
        return builder.finalize(device="cpu")

    def make_solver(self, model):
        return newton.solvers.SolverVBD(model, iterations=self.settings["iterations"])
