"""A picture of the organ at the end of a session, with marks, bites and threads, drawn by the painter's algorithm."""

import numpy
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from .drawing import INK, SET_COLOURS, SOFT, WIDTH, figure, jpeg, styled
from .point_cloud import particles_of

# direction to the camera: azimuth from the patient's front to the left, elevation [deg]
VIEWS = (("From the front", 15, 8), ("From the left and behind", 125, 8))
OUTSIDE, INSIDE = "#f6d9d1", "#b4574d"
GRADE_COLOURS = ("#fbf3dc", "#7a4a24", "#1b1513")  # mark, burn, muscularis at risk
LIGHT = numpy.array([-0.35, 0.45, 0.82])
FULL, PARTIAL = "#1a8f4c", "#f08c00"
OVERSAMPLING = 2
DPI = 150


class Organ:
    """Vertices [mm], triangles and grades of the surface to draw."""

    def __init__(self, topology, cloud):
        points, grades, self.is_rest = particles_of(topology, cloud)
        if len(topology.render_triangles) > 0:
            self.triangles = numpy.array(topology.render_triangles).reshape(-1, 3)
            points, grades = self._render_vertices(topology, points, grades)
        else:
            self.triangles = numpy.array(topology.triangles).reshape(-1, 3)
        self.points, self.grades = 1e3 * points, grades

    @staticmethod
    def _render_vertices(topology, points, grades):
        starts = numpy.array(topology.render_offsets[:-1])
        particles, weights = numpy.array(topology.render_particles), numpy.array(topology.render_weights)
        fine = numpy.add.reduceat(points[particles] * weights[:, None], starts, axis=0)
        return fine, numpy.maximum.reduceat(grades[particles] * (weights > 0.3), starts)


def camera(azimuth, elevation):
    """Rows: right, up, towards the camera."""
    a, e = numpy.radians([azimuth, elevation])
    towards = numpy.array([numpy.cos(a) * numpy.cos(e), numpy.sin(a) * numpy.cos(e), numpy.sin(e)])
    right = numpy.cross([0, 0, 1], towards)
    right /= numpy.linalg.norm(right)
    return numpy.stack([right, numpy.cross(towards, right), towards])


@styled
def organ_picture(recording):
    """(address of the picture, whether it shows the rest shape), or None without a surface."""
    if recording.topology is None or len(recording.topology.triangles) == 0:
        return None
    organ = Organ(recording.topology, recording.particles)
    sutures = recording.sutures.sutures if recording.sutures is not None else []
    frames = [camera(azimuth, elevation) for _, azimuth, elevation in VIEWS]
    extent = [numpy.ptp(organ.points @ frame.T, axis=0) for frame in frames]
    total = 1.08 * sum(each[0] for each in extent)
    height = min(5.2, WIDTH / total * 1.1 * max(each[1] for each in extent) + 0.3)
    drawn = figure(WIDTH, height)
    drawn.set_dpi(DPI * OVERSAMPLING)
    canvas = FigureCanvasAgg(drawn)
    views, left = [], 0.0
    for (name, _, _), frame, size in zip(VIEWS, frames, extent):
        width = 1.08 * size[0] / total
        axes = drawn.add_axes([left, 0, width, 1 - 0.28 / height])
        axes.patch.set_alpha(0)
        views.append(View(name, axes, organ, frame))
        left += width
    far, near, share = (layer(canvas, views, k) for k in range(3))
    walls = (far * (1 - share / 255) + near).astype(numpy.uint8)
    return jpeg(with_sutures(canvas, views, sutures, walls)), organ.is_rest


def layer(canvas, views, number):
    """Pixels of one layer of the walls: the far side, the near side by its density, and this density."""
    for view in views:
        view.show(number)
    return halved(drawn_pixels(canvas))


def with_sutures(canvas, views, sutures, walls):
    """Threads and bites in front of everything, so that none is hidden."""
    drawn = canvas.figure
    drawn.set_dpi(DPI)
    for view in views:
        view.show(None)
        view.axes.set_title(view.name, fontsize=9.5, color=INK, fontweight="bold", pad=4)
        draw_scale(view.axes)
        for k, suture in enumerate(sutures):
            draw_suture(view.axes, suture, k, view.frame)
    drawn.figimage(walls, 0, 0, zorder=-10)
    return drawn_pixels(canvas)


def drawn_pixels(canvas):
    canvas.draw()
    return numpy.asarray(canvas.buffer_rgba())[:, :, :3]


def halved(pixels):
    """Means of squares of pixels: polygons are drawn without antialiasing, which would show their edges."""
    k = OVERSAMPLING
    rows, columns = pixels.shape[0] // k, pixels.shape[1] // k
    parts = pixels[: rows * k, : columns * k].reshape(rows, k, columns, k, 3)
    return parts.mean(axis=(1, 3), dtype=numpy.float32)


class View:
    """The walls as one camera sees them, in layers."""

    def __init__(self, name, axes, organ, frame):
        self.name, self.axes, self.frame = name, axes, frame
        seen = organ.points @ frame.T
        corners = seen[organ.triangles]
        normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        order = numpy.argsort(corners[:, :, 2].mean(axis=1))
        far, near = order[normals[order, 2] <= 0], order[normals[order, 2] > 0]
        colours = colours_of(organ, normals)
        graded = organ.grades[organ.triangles].max(axis=1) >= 0.5
        # like glass: denser where it is seen at a grazing angle
        density = numpy.where(graded, 0.85, 0.2 + 0.65 * (1 - normals[:, 2]) ** 1.6)
        shares = numpy.repeat(numpy.clip(density, 0, 1)[:, None], 3, axis=1)
        self._layers = [
            self._add(corners[far], colours[far]),
            self._add(corners[near], colours[near] * shares[near], "black"),
            self._add(corners[near], shares[near], "black"),
        ]
        self._frame_picture(seen)

    def show(self, number):
        for k, each in enumerate(self._layers):
            for part in each:
                part.set_visible(k == number)

    def _add(self, corners, colours, ground=None):
        walls = PolyCollection(corners[:, :, :2], facecolors=colours, lw=0, antialiased=False)
        self.axes.add_collection(walls)
        if ground is None:
            return [walls]
        box = Rectangle((0, 0), 1, 1, transform=self.axes.transAxes, color=ground, zorder=0, clip_on=False)
        return [walls, self.axes.add_patch(box)]

    def _frame_picture(self, seen):
        low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
        margin = 0.03 * (high - low)
        self.axes.set_aspect("equal")
        self.axes.set_xlim(low[0] - margin[0], high[0] + margin[0])
        self.axes.set_ylim(low[1] - margin[1] - 6, high[1] + margin[1])
        self.axes.axis("off")


def colours_of(organ, normals):
    """Of triangles, by grade and light: pale outside, darker and wet inside, both lit from the camera's side."""
    grades = numpy.clip(numpy.rint(organ.grades).astype(int), 0, 3)[organ.triangles]
    is_inside = normals[:, 2] < 0
    tables = [numpy.array([rgb(c) for c in (ground, *GRADE_COLOURS)]) for ground in (OUTSIDE, INSIDE)]
    base = numpy.where(is_inside[:, None], tables[1][grades].mean(axis=1), tables[0][grades].mean(axis=1))
    turned = normals * numpy.where(is_inside, -1, 1)[:, None]
    diffuse = numpy.clip(turned @ LIGHT, 0, 1)[:, None]
    dark = numpy.where(is_inside[:, None], 0.40, 0.74)  # the glass casts light shadows
    return numpy.clip(base * (dark + (1.06 - dark) * diffuse) + 0.2 * diffuse**24, 0, 1)


def rgb(colour):
    return [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]


def draw_suture(axes, suture, number, frame):
    colour = SET_COLOURS[number % len(SET_COLOURS)]
    halo = [withStroke(linewidth=2.6, foreground="white", alpha=0.75)]
    if len(suture.thread) > 1:
        thread = 1e3 * numpy.array([[p.x, p.y, p.z] for p in suture.thread]) @ frame.T
        axes.add_collection(LineCollection([thread[:, :2]], colors=colour, lw=1.5, path_effects=halo))
    bites = 1e3 * numpy.array([[b.position.x, b.position.y, b.position.z] for b in suture.bites]).reshape(-1, 3)
    bites = bites @ frame.T
    for is_full, ring in ((True, FULL), (False, PARTIAL)):
        kept = [k for k, bite in enumerate(suture.bites) if bool(bite.full_thickness) == is_full]
        axes.scatter(bites[kept, 0], bites[kept, 1], s=17, facecolor="white", edgecolor=ring, lw=1.4, zorder=5)
    if len(bites):
        rightmost = bites[numpy.argmax(bites[:, 0])]
        axes.annotate(
            str(number + 1), rightmost[:2], xytext=(7, 0), textcoords="offset points", color=colour, fontsize=10,
            fontweight="bold", va="center", zorder=6, path_effects=[withStroke(linewidth=3, foreground="white")],
        )  # fmt: skip


def draw_scale(axes):
    left, low = axes.get_xlim()[0] + 3, axes.get_ylim()[0] + 3
    axes.plot([left, left + 50], [low, low], color=SOFT, lw=2, solid_capstyle="butt")
    axes.text(left + 25, low + 1.5, "50 mm", ha="center", va="bottom", fontsize=8, color=SOFT)
