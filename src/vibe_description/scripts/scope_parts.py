"""Meshes of the gastroscope: shaft, bending section and distal end. Millimetres, in the frames of the URDF's links.

Sources as in make_scope_urdf.py: [O] Olympus GIF-2T160 (12.6 mm, channels of 2.8 and 3.7 mm), [D] design choice.
"""
from mesh_shapes import Mesh, arc, circle, loft, revolved, triangulated
from make_scope_urdf import SCOPE_RADIUS, SEGMENT_LENGTH, SHAFT_LENGTH, SHAFT_PIECE, SHAFT_PIECES, TIP_LENGTH

RADIUS = 1000 * SCOPE_RADIUS
SIDES = 40

# (y, z) on the distal face, seen along the view y is left and z up
LENS = (0.0, 2.5)                            # of scope_camera_optical
LENS_RADIUS = 1.4                            # [D]
LIGHT_GUIDES = ((3.55, 2.4), (-3.55, 2.4))   # [D] beside the lens
LIGHT_GUIDE_RADIUS = 0.95                    # [D]
NOZZLE = (1.7, 0.35)                         # [D] air and water onto the lens
HELIX_CHANNEL = (2.8, -2.2)                  # where the URDF has helix_advance
HELIX_CHANNEL_RADIUS = 1.4                   # [O] 2.8 mm
EXCHANGE_CHANNEL = (-2.7, -1.4)              # [D] the anchor exchange in it is where the needle's path ends
EXCHANGE_CHANNEL_RADIUS = 1.85               # [O] 3.7 mm
CHANNEL_DEPTH = 7.0                          # [D] as deep as one can look

RIBS = 4            # [D] of a segment, the vertebrae that show through the rubber
RIB_HEIGHT = 0.12   # [D]


def shaft(length, begin):
    """Insertion tube along x with a round front end, as the collision shape has."""
    mesh = Mesh()
    front = arc((begin + length, 0), RADIUS, 90, 0, 7)
    profile = [(begin, 0), (begin, RADIUS)] + front[:-1] + [(begin + length + RADIUS, 0)]
    mesh.add(revolved(profile, 32), "scope_black")
    return mesh


def segment(length):
    """A part of the bending section. Its round rear end fills the gap that a bend opens."""
    mesh = Mesh()
    ribs = round(RIBS * length / (1000 * SEGMENT_LENGTH))
    pitch = length / ribs
    profile = arc((0, 0), RADIUS, 180, 90, 7)
    profile = [(-RADIUS, 0)] + profile[1:]
    for k in range(ribs):
        profile += [((k + share) * pitch, RADIUS + RIB_HEIGHT * height)
                    for share, height in ((0.3, 0.5), (0.5, 1.0), (0.7, 0.5), (1.0, 0))]
    mesh.add(revolved(profile + [(length, 0)], 32), "scope_rubber")
    return mesh


def hole(centre, radius, x, sides=20):
    return circle(x, radius, sides, centre)


def body_of_tip():
    """The distal end with two channels, one closed surface of (triangle, material) pairs."""
    rear = -1000 * TIP_LENGTH
    rings = [circle(x, r, SIDES) for x, r in ((rear, 0), (rear, RADIUS), (-0.45, RADIUS), (-0.15, RADIUS - 0.12),
                                              (0, RADIUS - 0.45))]
    painted = [(t, "scope_black") for t in loft(rings + [[(0.0, 0.0, 0.0)]])[:-SIDES]]  # without its front
    channels = ((HELIX_CHANNEL, HELIX_CHANNEL_RADIUS), (EXCHANGE_CHANNEL, EXCHANGE_CHANNEL_RADIUS))
    mouths = [hole(centre, radius, 0) for centre, radius in channels]
    flat = triangulated([p[1:] for p in rings[-1]], [[p[1:] for p in reversed(mouth)] for mouth in mouths])
    painted += [(tuple((0, y, z) for y, z in triangle), "scope_black") for triangle in flat]
    for mouth, (centre, radius) in zip(mouths, channels):
        bottom = hole(centre, radius, -CHANNEL_DEPTH)
        # backwards along x, so that it is seen from inside
        tube = loft([[(0.0, *centre)], mouth, bottom, [(-CHANNEL_DEPTH, *centre)]])[len(mouth):]
        painted += [(triangle, "channel_dark") for triangle in tube]
    return painted


def collar(centre, inner, outer, front, sides=24):
    """Ring on the face, its edges chamfered."""
    chamfer = 0.3 * (outer - inner)
    profile = [(-0.2, inner), (-0.2, outer), (front - chamfer, outer), (front, outer - chamfer),
               (front, inner + chamfer), (front - chamfer, inner)]
    return revolved(profile, sides, centre, hollow=True)


def dome(centre, radius, height, sides=24):
    """Slightly convex window; height: of its middle above its rim."""
    rim = 0.02
    profile = [(-0.2, 0), (-0.2, radius), (rim, radius)]
    profile += [(rim + height * (1 - (k / 4) ** 2), radius * k / 4) for k in (3, 2, 1, 0)]
    return revolved(profile, sides, centre)


def nozzle():
    """A hood whose opening points at the lens."""
    towards = ((LENS[0] - NOZZLE[0]), (LENS[1] - NOZZLE[1]))
    length = (towards[0] ** 2 + towards[1] ** 2) ** 0.5
    ahead = (towards[0] / length, towards[1] / length)
    beside = (-ahead[1], ahead[0])

    def ring(x, half_width, rear, front):
        corners = ((front, -1), (front, 1), (0.4 * rear, 1), (rear, 0.5), (rear, -0.5), (0.4 * rear, -1))
        return [(x, NOZZLE[0] + a * ahead[0] + b * half_width * beside[0],
                 NOZZLE[1] + a * ahead[1] + b * half_width * beside[1]) for a, b in corners]
    return loft([ring(-0.2, 0.55, -0.55, 0.3), ring(0.35, 0.55, -0.55, 0.45), ring(0.55, 0.4, -0.35, 0.4)])


def tip():
    mesh = Mesh()
    mesh.add_painted(body_of_tip())
    mesh.add(collar(LENS, LENS_RADIUS, LENS_RADIUS + 0.4, 0.08), "steel")
    mesh.add(dome(LENS, LENS_RADIUS - 0.01, 0.14), "glass")
    for place in LIGHT_GUIDES:
        mesh.add(collar(place, LIGHT_GUIDE_RADIUS, LIGHT_GUIDE_RADIUS + 0.22, 0.05), "scope_black")
        mesh.add(dome(place, LIGHT_GUIDE_RADIUS - 0.01, 0.04), "light_guide")
    for place, radius in ((HELIX_CHANNEL, HELIX_CHANNEL_RADIUS), (EXCHANGE_CHANNEL, EXCHANGE_CHANNEL_RADIUS)):
        mesh.add(collar(place, radius + 0.002, radius + 0.22, 0.06), "steel")
    mesh.add(nozzle(), "steel")
    return mesh


def scope_meshes():
    """Name of the file and its mesh."""
    piece = 1000 * SHAFT_PIECE
    rear = 1000 * SHAFT_LENGTH - SHAFT_PIECES * piece
    length = 1000 * SEGMENT_LENGTH
    return {"shaft": shaft(rear, -rear), "shaft_piece": shaft(piece, 0), "segment": segment(length),
            "segment_end": segment(length / 2), "tip": tip()}
