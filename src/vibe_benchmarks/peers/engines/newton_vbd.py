"""Newton, vertex block descent: neo-Hookean membrane and hinges."""

import newton

from engines.newton_cloth import Cloth, hinges
from scenes import FRAME

NAME, PACKAGE, VERSION = "Newton VBD", "newton", newton.__version__
SWEEP = {f"{steps} sub-steps, {n} iterations{'' if hinges else ', no hinges'}":
         {"step": FRAME / steps, "iterations": n, "hinges": hinges}
         for steps, n, hinges in ((1, 10, 1), (1, 40, 1), (10, 10, 1), (4, 10, 0))}  # fmt: skip


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
        lame = self.stretch * s.poisson / (1 - s.poisson**2)
        builder.add_cloth_mesh(**common, tri_ke=self.stretch / 2 / (1 + s.poisson), tri_ka=lame, tri_kd=0.0,
                               edge_ke=1.0, edge_kd=0.0)  # fmt: skip
        found = hinges(s)
        for e, nodes in enumerate(builder.edge_indices):
            side, areas = found[tuple(sorted(int(n) for n in nodes[2:]))]
            builder.edge_bending_properties[e] = (self.settings["hinges"] * self.bend * side / areas, 0.0)

    def finish(self, builder):
        builder.color(include_bending=True)
        return builder.finalize(device="cpu")

    def make_solver(self, model):
        return newton.solvers.SolverVBD(model, iterations=self.settings["iterations"])
