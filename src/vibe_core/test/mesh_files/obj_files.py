"""OBJ files: Wavefront, Advanced Visualizer manual, appendix B1."""

from shapes import Case, ball, concave, number, placed


def _corner(style, v, count):
    index = v - count if style["negative"] else v + 1
    return {"v": "{0}", "vt": "{0}/{1}", "vn": "{0}//{1}", "vtn": "{0}/{1}/{1}"}[style["corner"]].format(index, 1)


def _vertex(style, v, random):
    text = "v " + " ".join(number(x, random) for x in v)
    return text + {"": "", "w": " 1.0", "w2": " 2.5", "rgb": " 0.2 0.4 0.9"}[style["vertex"]]


EXTRAS = ["vt 0.5 0.5 0", "vn 0 0 1", "# a comment with f 1 2 3", "", "g part one two", "o organ", "s off", "s 1",
          "usemtl skin#1", "mtllib none.mtl", "p 1", "l 1 2", "vp 0.1 0.2", "cstype bezier", "deg 3", "curv 0 1 1 2 3 4",
          "parm u 0 1", "end", "lod 3", "bevel on", "c_interp off", "mg 1 0.5", "shadow_obj none"]


def _valid(random, name):
    shape = placed(random.choice([ball, concave])(random), random)
    style = {"corner": random.choice(["v", "vt", "vn", "vtn"]), "negative": random.random() < 0.3,
             "vertex": random.choice(["", "", "w", "w2", "rgb"])}
    count = len(shape.vertices)
    vertices = [_vertex(style, v, random) for v in shape.vertices]
    words = [[random.choice(["f", "f", "f", "fo"])] + [_corner(style, v, count) for v in p] for p in shape.polygons]
    join = random.choice([" ", " ", "  ", "\t", " \\\n "])
    faces = [join.join(w) for w in words]
    lines = vertices + faces
    if random.random() < 0.2 and not style["negative"]:
        lines = faces + vertices
    for extra in random.sample(EXTRAS, random.randint(0, 6)):
        lines.insert(random.randint(0, len(lines)), extra)
    if random.random() < 0.2:
        lines.append("v nan nan nan # of no face")
    end = random.choice(["\n", "\n", "\r\n", "\r"])
    text = random.choice(["", "", "\ufeff"]) + "\n".join(lines) + random.choice(["", "\n", " \n\n"])
    return Case(name, text.replace("\n", end).encode(), shape)


def _wrong(random, name):
    shape = placed(ball(random), random)
    lines = ["v " + " ".join(f"{x:.9g}" for x in v) for v in shape.vertices]
    count = len(lines)
    lines += ["f " + " ".join(str(v + 1) for v in p) for p in shape.polygons]
    first, last = count, len(lines) - 1  # lines of faces
    at = random.randint(first, last)
    changes = [
        (at, "f 0 1 2", f"line {at + 1}: the face names vertex 0"),
        (at, f"f 1 2 {count + 1}", f"line {at + 1}: the face names vertex {count + 1}, but the file has 1 to {count}"),
        (at, f"f 1 2 -{count + 1}", f"line {at + 1}: the face names vertex -{count + 1}"),
        (at, "f 1 2", f"line {at + 1}: the face has fewer than three corners"),
        (at, "f 1 2 three", "the corner 'three' of the face"),
        (at, "surf 0 1 0 1 1 2 3 4", "free-form surfaces ('surf') are not supported"),
        (at, "bzp 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16", "free-form surfaces ('bzp') are not supported"),
        (at, "call other.obj", "'call', which runs what is in another file, is not supported"),
        (at, "faces 1 2 3", "'faces' is not a statement of an OBJ file"),
        (at, "", "hole"),
        (0, "v 1 2", "line 1: the vertex has fewer than three coordinates"),
        (0, "v 1,5 2,5 3", "line 1: '1,5' is not a number of this format, which has a decimal point"),
        (0, "v 1.0 2.0 x", "line 1: 'x' is not a number"),
        (0, "v nan 0 0", "not a finite number"),
        (0, "v 1e999 0 0", "not a finite number"),
    ]
    place, text, refused = random.choice(changes)
    lines[place] = text
    return Case(name, "\n".join(lines).encode(), refused=refused)


def cases(random, count):
    """The last third is wrong."""
    wrong = count // 3
    for k in range(count - wrong):
        yield _valid(random, f"valid_{k}.obj")
    for k in range(wrong):
        yield _wrong(random, f"wrong_{k}.obj")
