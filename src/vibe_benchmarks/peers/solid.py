"""Neo-Hookean solids in equilibrium, by quadratic finite elements of scikit-fem: truths for the scenes."""

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTetP2, ElementTriP2, MeshTet, MeshTri


class Solid:
    """W = mu/2 (I - 3 - 2 ln J) + lambda/2 (ln J)^2. A triangle mesh is a half-section (radius, height) of a body of
    revolution, or else a body in plane strain per width; a mesh of tetrahedra is the body."""

    def __init__(self, nodes, elements, young, poisson, revolved=True):
        self.mu, self.lam = young / 2 / (1 + poisson), young * poisson / (1 + poisson) / (1 - 2 * poisson)
        solid = len(elements[0]) == 4
        mesh = (MeshTet if solid else MeshTri)(np.array(nodes).T.copy(), np.array(elements).T.copy())
        self.basis = Basis(mesh, ElementTetP2() if solid else ElementTriP2(), intorder=3 if solid else 4)
        self.places, self.dim = self.basis.doflocs.T, 3 if solid else 2
        shapes = self.basis.basis
        count, dim = len(shapes), self.dim
        grads = np.stack([s[0].grad for s in shapes])  # shape, direction, element, point
        self.strain = np.zeros(self.basis.dx.shape + (count, dim, 3, 3))  # change of F by each freedom
        for c in range(dim):
            self.strain[..., c, c, :dim] = grads.transpose(2, 3, 0, 1)
        self.weight = self.basis.dx.copy()
        if revolved and not solid:
            radius = self.basis.global_coordinates().value[0]
            values = np.stack([np.broadcast_to(s[0].value, radius.shape) for s in shapes]).transpose(1, 2, 0)
            self.strain[..., 0, 2, 2] = values / radius[..., None]
            self.weight *= 2 * np.pi * radius
        self.strain = self.strain.reshape(self.basis.dx.shape + (count * dim, 9))
        nodes_of = self.basis.element_dofs.T
        self.freedoms = (dim * nodes_of[:, :, None] + np.arange(dim)).reshape(len(nodes_of), -1)

    def gradient(self, u):
        change = np.einsum("eqai,ea->eqi", self.strain, u[self.freedoms])
        return (np.eye(3).ravel() + change).reshape(self.weight.shape + (3, 3))

    def forces(self, u, stiffness=True):
        """Internal forces at displacements u, and their derivative."""
        f = self.gradient(u)
        inverse = np.linalg.inv(f).swapaxes(-1, -2)
        log = np.log(np.linalg.det(f))[..., None, None]
        stress = self.mu * (f - inverse) + self.lam * log * inverse
        weighted = self.strain * self.weight[..., None, None]
        force = np.bincount(self.freedoms.ravel(), np.einsum("eqai,eqi->ea", weighted, stress.reshape(
            self.weight.shape + (9,))).ravel(), u.size)  # fmt: skip
        if not stiffness:
            return force, None
        turned = np.einsum("eqil,eqkj->eqijkl", inverse, inverse) * (self.mu - self.lam * log)[..., None, None]
        moduli = self.lam * np.einsum("eqij,eqkl->eqijkl", inverse, inverse) + turned
        moduli = moduli.reshape(self.weight.shape + (9, 9)) + self.mu * np.eye(9)
        local = np.einsum("eqaj,eqbj->eab", weighted @ moduli, self.strain, optimize=True)
        rows = np.broadcast_to(self.freedoms[:, :, None], local.shape)
        matrix = sparse.coo_matrix((local.ravel(), (rows.ravel(), rows.swapaxes(1, 2).ravel())), (u.size, u.size))
        return force, matrix.tocsc()

    def settle(self, held, load=None, steps=4, tolerance=1e-9, start=None):
        """Equilibrium in which freedoms have the values of `held` (freedom: displacement), reached from the
        displacements `start` or from rest; load(u, level) gives force and derivative. @returns displacements per node, and the internal forces: what acts on the body per node."""
        u = np.zeros(self.places.size) if start is None else start.ravel()
        at = np.array(sorted(held))
        wanted = np.array([held[i] for i in at])
        first = u[at]
        free = np.setdiff1d(np.arange(u.size), at)
        for level in np.arange(1, steps + 1) / steps:
            for _ in range(40):
                step = np.zeros_like(u)
                step[at] = first + level * (wanted - first) - u[at]
                force, matrix = self.forces(u)
                if load is not None:
                    outer, slope = load(u, level)
                    force, matrix = force - outer, matrix - slope
                right = -(force + matrix @ step)[free]
                step[free] = splu(matrix[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A").solve(right)
                size = abs(step).max()
                while np.linalg.det(self.gradient(u + step)).min() < 0.1:  # shorter than what turns the material over
                    step /= 2
                u = u + step
                if size < tolerance:
                    break
            else:
                raise RuntimeError(f"the solid does not settle at level {level:.2f}; raise the number of steps")
        return u.reshape(-1, self.dim), self.forces(u, False)[0].reshape(-1, self.dim)
