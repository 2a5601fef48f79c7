"""STL files: 3D Systems, StereoLithography Interface Specification, 1988."""

import struct

from shapes import Case, ball, number, placed


def _facet(corners, random):
    normal = random.choice(["0 0 0", "0 0 1", "nan nan nan", "-1.5e-01 0 9E-1"])
    rows = "".join("vertex " + " ".join(number(x, random) for x in v) + "\n" for v in corners)
    return f"facet normal {normal}\nouter loop\n{rows}endloop\nendfacet\n"


def _solid(facets, name):
    return f"solid {name}\n" + "".join(facets) + f"endsolid {name}\n"


def _text(shape, random):
    facets = [_facet([shape.vertices[v] for v in t], random) for t in shape.triangles()]
    names = ["", "organ", "my organ of 2024", "3D Slicer output. SPACE=LPS", "facet", "solid", "vertex 1"]
    cut = random.choice([0, len(facets) // 2])
    text = "".join(_solid(part, random.choice(names)) for part in (facets[:cut], facets[cut:]) if part)
    text = random.choice([str, str, str.upper])(text).replace("NAN", "nan")
    text = random.choice(["", "", "  ", "\n\n", "\t \n"]) + text
    indent = random.choice(["", "  ", "\t"])
    text = random.choice(["", "", "\ufeff"]) + "\n".join(indent + line for line in text.split("\n"))
    return text.replace("\n", random.choice(["\n", "\n", "\r\n", "\r"])).encode()


def _binary(shape, random, header=None):
    starts = [b"", b"solid organ", b"solid", b"binary", b"COLOR=\x01\x02\x03\xff", b"exported by x\0solid",
              b"solid " + b"a" * 74]
    triangles = shape.triangles()
    out = (random.choice(starts) if header is None else header).ljust(80, random.choice([b"\0", b" "]))
    out += struct.pack("<I", len(triangles))
    for t in triangles:
        corners = [x for v in t for x in shape.vertices[v]]
        out += struct.pack("<12fH", *random.choice([(0, 0, 0), (0, 0, 1), (float("nan"),) * 3]), *corners,
                           random.choice([0, 0x7fff, 0xffff]))
    return out


def _wrong_text(random, name):
    shape = placed(ball(random), random)
    text = _solid([_facet([shape.vertices[v] for v in t], random) for t in shape.triangles()], "organ")
    at = text.index("vertex")
    end = text.index("\n", at)
    changes = [
        (text[:at] + "vertex 1,5 2 3" + text[end:], "'1,5' is not a number of this format"),
        (text[:at] + "vertex 1 2" + text[end:], "'vertex' is not a number"),
        (text[:at] + text[at:end + 1] + text[at:], "'vertex' stands where 'endloop' belongs"),
        (text[:end + 1] + text[text.index("endloop"):], "'endloop' stands where 'vertex' belongs"),
        (text[:at] + "vertex nan 2 3" + text[end:], "not a finite number"),
        (text[:text.rindex("endsolid")], "the text ends where 'facet' or 'endsolid' belongs"),
        (text[:text.rindex("\n", 0, len(text) // 2)], "the text ends where "),
        (text[:text.index("facet")] + "color 1 0 0\n" + text[text.index("facet"):], "'color' stands where"),
        (text[:text.index("facet")] + text[text.index("endfacet") + 8:], "hole"),
        ("solid nothing\nendsolid nothing\n", "has no faces"),
    ]
    content, refused = random.choice(changes)
    return Case(name, content.encode(), refused=refused)


def _wrong_binary(random, name):
    shape = placed(ball(random), random)
    content = _binary(shape, random, random.choice([b"organ", b"solid organ\0"]))
    count = len(shape.triangles())
    changes = [
        (content[:80] + struct.pack("<I", count + 1) + content[84:], f"state {count + 1} triangles"),
        (content[:80] + struct.pack("<I", 0) + content[84:], "state 0 triangles"),
        (content[:80] + struct.pack("<I", 0xffffffff) + content[84:], "state 4294967295 triangles"),
        (content[:-7], f"state {count} triangles, which take {len(content)} bytes, but it has {len(content) - 7}"),
        (content + b"more", f"but it has {len(content) + 4}"),
        (content[:60], "has 60 bytes and is not text that begins with 'solid'"),
        (content[:80] + bytes(4), "has no faces"),
        (content[:80] + struct.pack("<I", count - 1) + content[84:-50], "hole"),
        (content[:96] + struct.pack("<f", float("inf")) + content[100:], "not a finite number"),
    ]
    changed, refused = random.choice(changes)
    return Case(name, changed, refused=refused)


def cases(random, count):
    """A third each: valid text, valid binary, wrong."""
    third = count // 3
    for k in range(count - third):
        shape = placed(ball(random), random)
        yield Case(f"valid_{k}.stl", random.choice([_text, _binary])(shape, random), shape)
    for k in range(third):
        yield random.choice([_wrong_text, _wrong_binary])(random, f"wrong_{k}.stl")
