"""Reads the meshes of the description and measures them."""

import numpy


class ObjMesh:
    def __init__(self, path):
        self.points, self.normals, faces, normal_faces = [], [], [], []
        with open(path, encoding="ascii") as file:
            for line in file:
                kind, *words = line.split()
                if kind == "v":
                    self.points.append([float(word) for word in words])
                elif kind == "vn":
                    self.normals.append([float(word) for word in words])
                elif kind == "f":
                    pairs = [word.split("//") for word in words]
                    faces.append([int(pair[0]) - 1 for pair in pairs])
                    normal_faces.append([int(pair[1]) - 1 for pair in pairs])
        self.points, self.normals = numpy.array(self.points), numpy.array(self.normals)
        self.faces, self.normal_faces = numpy.array(faces), numpy.array(normal_faces)

    def corners(self):
        """Corners of the triangles: n x 3 x 3 [m]."""
        return self.points[self.faces]


def unmatched_edges(faces):
    """Edges without as many triangles on one side as on the other: none in closed surfaces that agree on outside."""
    balance = {}
    for a, b, c in faces.tolist():
        for start, end in ((a, b), (b, c), (c, a)):
            key, sign = ((start, end), 1) if start < end else ((end, start), -1)
            balance[key] = balance.get(key, 0) + sign
    return [edge for edge, sum_of_signs in balance.items() if sum_of_signs != 0]


def bodies(faces):
    """Lists of triangles that hang together by their corners."""
    leader = list(range(faces.max() + 1))

    def first(k):
        while leader[k] != k:
            leader[k] = leader[leader[k]]
            k = leader[k]
        return k

    for a, b, c in faces.tolist():
        leader[first(b)] = leader[first(a)]
        leader[first(c)] = leader[first(a)]
    groups = {}
    for k, face in enumerate(faces.tolist()):
        groups.setdefault(first(face[0]), []).append(k)
    return list(groups.values())


def volume_of(corners):
    """[m^3], negative if inside out."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return numpy.einsum("ij,ij->", a, numpy.cross(b, c)) / 6


def distances_to_segments(points, a, b):
    """Distance from every point to every segment a b: points x segments [m]."""
    along = b - a
    share = numpy.clip(((points[:, None] - a) * along).sum(axis=2) / (along**2).sum(axis=1), 0, 1)
    return numpy.linalg.norm(points[:, None] - a - share[:, :, None] * along, axis=2)


def distances_to_triangles(points, corners):
    """Distance from every point to every triangle: to its plane where the foot is inside, else to its edges [m]."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = numpy.cross(b - a, c - a)
    normal /= numpy.linalg.norm(normal, axis=1)[:, None]
    inside = numpy.ones((len(points), len(corners)), bool)
    for start, end in ((a, b), (b, c), (c, a)):
        inwards = numpy.cross(normal, end - start)
        inside &= points @ inwards.T >= (start * inwards).sum(axis=1)
    height = abs(points @ normal.T - (a * normal).sum(axis=1))
    edges = numpy.minimum(distances_to_segments(points, a, b), distances_to_segments(points, b, c))
    return numpy.where(inside, height, numpy.minimum(edges, distances_to_segments(points, c, a)))


def nearest(points, corners, chunk=16):
    """Distance from each point to the nearest triangle [m]."""
    parts = (points[k : k + chunk] for k in range(0, len(points), chunk))
    return numpy.concatenate([distances_to_triangles(part, corners).min(axis=1) for part in parts])


def first_hits(origin, directions, corners, chunk=64):
    """Distance along each ray to the first triangle it meets, infinite without one (Moeller and Trumbore 1997)."""
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    from_a = origin - a
    q = numpy.cross(from_a, ab)
    result = []
    for k in range(0, len(directions), chunk):
        rays = directions[k : k + chunk, None, :]
        p = numpy.cross(rays, ac[None])
        with numpy.errstate(divide="ignore", invalid="ignore"):
            scale = 1 / (p * ab).sum(axis=2)
            u = (p * from_a).sum(axis=2) * scale
            v = (rays * q).sum(axis=2) * scale
            t = (ac * q).sum(axis=1) * scale
            met = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
        result.append(numpy.where(met, t, numpy.inf).min(axis=1))
    return numpy.concatenate(result)
