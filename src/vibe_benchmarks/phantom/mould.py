"""Two halves of a mould, core and pins for the stomach of the twin, as fields that are negative inside; lengths in mm.

The frame of the mould: u up while it is filled, the way that both ends of the stomach lead, v across, w normal to the
parting plane, which contains the middles of both ends."""
import numpy as np
from scipy import ndimage

import shapes
import twin

GRID = 1.0  # of the surfaces that are written
COARSE = 2.0  # of the distance field, which is smooth where it is used, and of the search for the parting plane
MARGIN = 9.0  # of the mould around the silicone
COLLAR = 6.0  # silicone tube beyond each end, to be cut off
PLAY = 0.15  # between the core and its seats
PIN_RADIUS, PIN_DEPTH = 4.0, 8.0
BUMP = 1.0  # height of the knob that marks the place of the pad


class Organ:
    """Middle of the wall, its distance field, and its two ends."""

    def __init__(self, scale):
        model = twin.organ(scale)
        self.points, self.triangles = 1e3 * model.rest_positions, np.asarray(model.triangles)
        self.ends = [(self.points[held].mean(axis=0), way, 1e3 * radius, np.ptp(self.points[held] @ way) / 2)
                     for held, way, radius in twin.ends(model)]
        self.pad = self.points[twin.pad_particle(model)]
        self.area = 1e6 * model.area.sum()
        self.low = self.points.min(axis=0) - 40
        counts = np.ceil((self.points.max(axis=0) + 40 - self.low) / COARSE).astype(int)
        grid = np.stack(np.meshgrid(*[np.arange(n) * COARSE for n in counts], indexing="ij"), axis=-1) + self.low
        self.spline = ndimage.spline_filter(shapes.signed_distance(self.points, self.triangles, grid))

    def distance(self, places):
        index = (places - self.low) / COARSE
        return ndimage.map_coordinates(self.spline, np.moveaxis(index, -1, 0), prefilter=False, mode="nearest")


class Frame:
    """Axes u, v, w and origin of the mould whose parting plane is turned by an angle about the line of the two ends."""

    def __init__(self, organ, angle):
        (first, up, _, _), (second, other, _, _) = organ.ends
        line = (second - first) / np.linalg.norm(second - first)
        side = np.cross(line, up)
        side /= np.linalg.norm(side)
        w = np.cos(angle) * side + np.sin(angle) * np.cross(line, side)
        u = up + other - (up + other) @ w * w
        u /= np.linalg.norm(u)
        self.axes, self.origin = np.stack([u, np.cross(w, u), w]), first

    def into(self, places):
        return (places - self.origin) @ self.axes.T

    def grid(self, axes):
        """Places in world and in the frame, (..., 3), of a grid with these axes."""
        own = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        return own @ self.axes + self.origin, own


def undercut(organ, frame, wall):
    """How far [mm] each half of the mould reaches behind silicone when it is drawn off along w: the greatest distance,
    across w, from mould that has silicone farther out on its way to where the way is free."""
    own = frame.into(organ.points)
    axes = [np.arange(own[:, k].min() - 6, own[:, k].max() + 6, COARSE) for k in range(3)]
    filled = organ.distance(frame.grid(axes)[0]) < wall / 2
    worst = 0.0
    for half in (filled[:, :, axes[2] > 0], filled[:, :, axes[2] < 0][:, :, ::-1]):
        outside = np.logical_or.accumulate(half[:, :, ::-1], axis=2)[:, :, ::-1]
        for level in np.flatnonzero((outside & ~half).any(axis=(0, 1))):
            deep = ndimage.distance_transform_edt(outside[:, :, level])[outside[:, :, level] & ~half[:, :, level]]
            worst = max(worst, COARSE * deep.max())
    return worst


def best_frame(organ, wall):
    """Frame with the least undercut among planes through both ends, that undercut, and the greatest of all [mm]."""
    coarse = np.radians(np.arange(0, 180, 6))
    found = [undercut(organ, Frame(organ, angle), wall) for angle in coarse]
    fine = coarse[np.argmin(found)] + np.radians(np.arange(-5, 6))
    close = [undercut(organ, Frame(organ, angle), wall) for angle in fine]
    return Frame(organ, fine[np.argmin(close)]), min(close), max(found)


def cylinder(own, centre, way, radius, begin, end):
    along = (own - centre) @ way
    across = np.linalg.norm(own - centre - along[..., None] * way, axis=-1)
    return np.maximum(across - radius, np.maximum(begin - along, along - end))


def tops(frame, organ):
    """Places of the wall, in the frame, above which air would be caught: higher than all others within 15 mm."""
    own = frame.into(organ.points)
    free = np.min([np.linalg.norm(organ.points - end[0], axis=1) for end in organ.ends], axis=0) > 25
    return [p for p in own[free] if p[0] >= own[np.linalg.norm(own - p, axis=1) < 15][:, 0].max()]


class Mould:
    """Fields of the parts on a grid in the frame, and the axes of the grid."""

    def __init__(self, organ, frame, wall):
        own = frame.into(organ.points)
        self.wall = wall
        self.necks = [self._neck(frame, end) for end in organ.ends]
        low = own.min(axis=0) - wall / 2 - MARGIN
        high = own.max(axis=0) + wall / 2 + MARGIN
        high[0] = max(high[0], *(c[0] + collar * way[0] + MARGIN for c, way, _, collar in self.necks))
        for c, way, r, _ in self.necks:
            exit_at = c[1] + (high[0] - c[0]) / way[0] * way[1]
            low[1], high[1] = min(low[1], exit_at - r - MARGIN), max(high[1], exit_at + r + MARGIN)
        low[2], high[2] = GRID * np.floor(low[2] / GRID), GRID * np.ceil(high[2] / GRID)
        self.axes = [np.arange(low[k], high[k] + GRID, GRID) for k in range(3)]
        self.low, self.high = low, np.array([axis[-1] for axis in self.axes])
        places, self.own = frame.grid(self.axes)
        self.middle = organ.distance(places)
        self.tops = tops(frame, organ)
        bump = frame.into(organ.pad[None])[0]
        self.mark = np.linalg.norm(self.own - bump, axis=-1) - wall / 2 - BUMP

    def _neck(self, frame, end):
        """Middle, way out within the parting plane, inner radius of the tube, and where the silicone ends along it."""
        centre, way, radius, half = end
        way = frame.axes @ way
        way[2] = 0
        return frame.into(centre[None])[0], way / np.linalg.norm(way), radius - self.wall / 2, half + COLLAR

    def _lugs(self, neck, play):
        """Two lugs on the neck of the core, one into each half, which keep the core from floating up."""
        c, way, r, collar = neck
        aside = np.cross([0.0, 0.0, 1.0], way)
        return np.maximum(cylinder(self.own, c, way, r + 3 + play, collar + 3 - play, collar + 7 + play),
                          np.abs((self.own - c) @ aside) - 3 - play)

    def core(self):
        necks = [cylinder(self.own, c, way, r, -5, 1e3) for c, way, r, _ in self.necks]
        necks += [self._lugs(neck, 0) for neck in self.necks]
        return np.min([self.middle + self.wall / 2] + necks, axis=0)

    def silicone(self):
        """Outside of it, core included."""
        collars = [cylinder(self.own, c, way, r + self.wall, -5, collar) for c, way, r, collar in self.necks]
        return np.min([self.middle - self.wall / 2, self.mark] + collars, axis=0)

    def hollow(self):
        """What the halves leave free: silicone, seats of the core, sprue at the pylorus, vents."""
        parts = [self.silicone()] + [self._lugs(neck, PLAY) for neck in self.necks]
        for number, (c, way, r, collar) in enumerate(self.necks):
            aside = np.cross([0.0, 0.0, 1.0], way) * np.sign(self.low[1] + self.high[1] - 2 * c[1])  # to the middle
            parts.append(cylinder(self.own, c, way, r + PLAY, 0, 1e3))
            for sign, radius in ((1, 4.0 if number else 1.5), (-1, 1.5)):  # the second end is the pylorus
                parts.append(cylinder(self.own, c + sign * (r + radius - 0.8) * aside, way, radius, collar - 2, 1e3))
        up = np.array([1.0, 0.0, 0.0])
        return np.min(parts + [cylinder(self.own, top, up, 1.5, 0, 1e3) for top in self.tops], axis=0)

    def pins(self, hollow):
        """Four holes across the parting plane, as near to the corners as what is hollow leaves room."""
        deep = np.abs(self.axes[2]) <= PIN_DEPTH
        free = hollow[:, :, deep].min(axis=2) > PIN_RADIUS + 3
        inset = int(MARGIN / GRID)
        free[:inset], free[-inset:], free[:, :inset], free[:, -inset:] = False, False, False, False
        places = np.argwhere(free)
        corners = [(x, y) for x in (0, free.shape[0]) for y in (0, free.shape[1])]
        nearest = [places[np.linalg.norm(places - corner, axis=1).argmin()] for corner in corners]
        middles, way = [np.array([self.axes[0][i], self.axes[1][j], 0.0]) for i, j in nearest], np.array([0.0, 0.0, 1.0])
        return [cylinder(self.own, middle, way, PIN_RADIUS, -PIN_DEPTH, PIN_DEPTH) for middle in middles]

    def parts(self):
        """Name to points and triangles, as they lie on the printer's bed: halves with the parting plane up."""
        hollow, core = self.hollow(), self.core()
        block = -np.min([hollow] + self.pins(hollow), axis=0)
        upper, lower = self.axes[2] >= -GRID / 4, self.axes[2] <= GRID / 4
        turned, height = np.array([1.0, -1.0, -1.0]), PIN_DEPTH - 0.5
        pin = [np.arange(-6.0, 6.1, 0.5), np.arange(-6.0, 6.1, 0.5), np.arange(-height, height + 0.1, 0.5)]
        own = np.stack(np.meshgrid(*pin, indexing="ij"), axis=-1)
        found = {"half_a": shapes.surface(block[:, :, upper], [*self.axes[:2], self.axes[2][upper]]),
                 "half_b": shapes.surface(block[:, :, lower], [*self.axes[:2], self.axes[2][lower]]),
                 "core": shapes.surface(core, self.axes),
                 "pin": shapes.surface(np.hypot(own[..., 0], own[..., 1]) - PIN_RADIUS + PLAY, pin)}
        found["half_a"] = (found["half_a"][0] * turned, found["half_a"][1])
        return {name: (points - points.min(axis=0), triangles) for name, (points, triangles) in found.items()}

    def wall_volume(self):
        """[mm^3], without collars and knob."""
        return shapes.volume(*shapes.surface(np.abs(self.middle) - self.wall / 2, self.axes))


def cup():
    """The mould of the cylinder of 50 x 30 mm, with a floor and a wall of 3 mm."""
    axes = [np.arange(-30.0, 30.1, 0.5), np.arange(-30.0, 30.1, 0.5), np.arange(-3.0, 30.1, 0.5)]
    own = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    radius = np.hypot(own[..., 0], own[..., 1])
    points, triangles = shapes.surface(np.maximum(radius - 28, -np.maximum(radius - 25, -own[..., 2])), axes)
    return points - points.min(axis=0), triangles


def write(out, scale, wall, bed):
    """Writes the parts into a folder and prints what was checked. Returns whether all is as it should be."""
    organ = Organ(scale)
    frame, least, greatest = best_frame(organ, wall)
    mould = Mould(organ, frame, wall)
    size = mould.high - mould.low
    if size[:2].max() > bed:
        fitting = np.floor(20 * scale * (bed - 25) / (size[:2].max() - 25)) / 20  # 25 mm do not scale
        raise ValueError(f"phantom mould: at --scale {scale:g} a half is {size[0]:.0f} x {size[1]:.0f} mm, more than the "
                         f"bed of {bed:g} mm; take --scale {fitting:g}, here and for the scene.")
    good, poured = True, size.prod() - 8 * np.pi * PIN_RADIUS ** 2 * PIN_DEPTH
    for name, (points, triangles) in {**mould.parts(), "cup": cup()}.items():
        said = shapes.faults(points, triangles)
        good = good and not said
        shapes.write_stl(out / f"{name}.stl", points, triangles)
        poured -= shapes.volume(points, triangles) if name in ("half_a", "half_b", "core") else 0
        print(f"{name}.stl: {' x '.join(f'{x:.0f}' for x in np.ptp(points, axis=0))} mm, {len(triangles)} triangles, "
              f"{shapes.volume(points, triangles) / 1e3:.0f} cm^3, {'; '.join(said) or 'closed'}")
    found = mould.wall_volume()
    share = found / (organ.area * wall) - 1
    print(f"parting plane: undercut {least:.1f} mm, {greatest:.0f} mm in the worst plane; silicone gives way to a few")
    print(f"wall: {found / 1e3:.1f} cm^3, {100 * share:+.2f} % of area x thickness ({organ.area * wall / 1e3:.1f} cm^3)")
    print(f"free between halves and core, with collars and channels (vents over tops: {len(mould.tops)}): "
          f"{poured / 1e3:.0f} cm^3, {1.07 * poured / 1e3:.0f} g of silicone; mix a fifth more, and 63 g for the cylinder")
    return good and abs(share) < 0.02
