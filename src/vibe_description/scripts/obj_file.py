"""Writes a mesh as Wavefront OBJ in metres, with normals that are smooth except at creases. Standard library only."""
import math

from mesh_shapes import cross, dot, subtract

CREASE = math.cos(math.radians(40))  # faces that meet at a larger angle have an edge between them; design choice


def text_of(value, digits):
    """Shortest text; never -0, so that the file does not depend on the sign of a zero."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def rounded(point):
    """[mm] to the micrometre, to which the file is written."""
    return tuple(round(v, 3) + 0.0 for v in point)


def corners_of(mesh):
    """Triangles of rounded points without those that rounding has flattened."""
    found = []
    for a, b, c, material in mesh.triangles:
        a, b, c = rounded(a), rounded(b), rounded(c)
        if len({a, b, c}) == 3:
            found.append((a, b, c, material))
    return found


def face_normal(a, b, c):
    """Its length is twice the area."""
    return cross(subtract(b, a), subtract(c, a))


def smooth_normals(triangles):
    """Normals of the three corners of each triangle: mean of the faces about the corner that are on its side of a
    crease, weighted by area."""
    faces = [face_normal(a, b, c) for a, b, c, _ in triangles]
    lengths = [math.sqrt(dot(n, n)) or 1e-12 for n in faces]
    about = {}
    for k, (a, b, c, _) in enumerate(triangles):
        for corner in (a, b, c):
            about.setdefault(corner, []).append(k)

    def normal_at(corner, k):
        near = [n for n in about[corner] if dot(faces[n], faces[k]) >= CREASE * lengths[n] * lengths[k]] or [k]
        total = tuple(sum(faces[n][i] for n in near) for i in range(3))
        length = math.sqrt(dot(total, total)) or 1e-12
        return tuple(round(v / length, 3) + 0.0 for v in total)

    return [[normal_at(corner, k) for corner in triangle[:3]] for k, triangle in enumerate(triangles)]


def obj_text(mesh, library, note):
    """The file's text. Faces are grouped by material."""
    triangles = corners_of(mesh)
    normals = smooth_normals(triangles)
    places, directions = {}, {}
    lines = []
    for material in sorted({triangle[3] for triangle in triangles}):
        lines.append(f"usemtl {material}")
        for triangle, normal in zip(triangles, normals):
            if triangle[3] != material:
                continue
            pairs = [(places.setdefault(p, len(places) + 1), directions.setdefault(n, len(directions) + 1))
                     for p, n in zip(triangle[:3], normal)]
            lines.append("f " + " ".join(f"{p}//{n}" for p, n in pairs))
    head = [f"# {note}", f"mtllib {library}"]
    head += ["v " + " ".join(text_of(v / 1000, 6) for v in place) for place in places]
    head += ["vn " + " ".join(text_of(v, 3) for v in normal) for normal in directions]
    return "\n".join(head + lines) + "\n"
