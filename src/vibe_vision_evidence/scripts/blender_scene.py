"""What render_with_blender.py draws: the rig, and situations that change light, lens, camera and markers."""
import math

RATE = 147.0  # frames per second
WIDTH, HEIGHT, FOCAL = 728, 544, 4600.0  # [px]
CENTRE = (361.4, 274.2)  # principal point [px]
SCALE = 10.0  # [px/mm]
DISTANCE = FOCAL / SCALE  # of the camera from both axes [mm]
ANGLE = math.radians(0.5)  # of both axes in the image
ROWS = {"helix": 180.3, "needle_driver": 300.6}  # where the axes pass the middle of the image [px]
RADIUS, LENGTH, PAPER = 1.5, 10.0, 0.1  # of the sleeve, thickness of the paper [mm]
SIDE, OUTER = 7.0, 4.0  # of the ring's square, diameter of the ring [mm]
TEXELS, FINER = 100, 8  # of a marker's texture per mm; pdftoppm moves edges to whole pixels, so it draws finer ones
BLACK, WHITE = 0.05, 0.85  # reflectance of ink and paper
GAIN, READ, OPTICS = 0.096, 0.6, 0.6  # [DN], [DN], [px]
# Cycles' table of the shutter has 256 entries, and its pictures show the motion one entry early: 0.37 % of the exposure,
# measured with the ring in two situations.
EARLY = 1 / 256
FINE = 3  # parts of a pixel's side that are drawn one by one, so that the optics' blur comes before the pixels

# Keys: speed [m/s] at the middle of the motion, turn [rad/s], exposure [s]; lambert: share of the light that comes from
# the lamp and shades as matt paper does, the rest is even; light: angle of the lamp from the camera [deg], and around;
# defocus: radius of the disc [px]; gamma of the response; white: of the brightest paper [DN]; step: from one frame, at
# rest, to the next [mm].
STANDARD = dict(speed=0.5, turn=30.0, exposure=1e-3, lambert=0.0, light=(0, 0), defocus=0.0, gamma=1.0, white=200.0,
                gloss=0.0, lamps=1, extra="", jpeg=0, bayer=False, row_time=0.0, step=0.0)
SITUATIONS = {
    "rest": dict(speed=0.0, turn=0.0),
    "stops": dict(speed=0.0, turn=0.0, lambert=1.0, step=3.0),
    "moving": {},
    "lambert35": dict(lambert=0.35),
    "lambert": dict(lambert=1.0),
    "lambert_side": dict(lambert=1.0, light=(40, 90)),
    "lambert_along": dict(lambert=1.0, light=(40, 0)),
    "two_lamps": dict(lambert=1.0, light=(35, 90), lamps=2),
    "window": dict(lambert=0.7, light=(60, 60)),
    "defocus2": dict(defocus=2.0),
    "defocus3": dict(defocus=3.0),
    "gamma22": dict(gamma=2.2),
    "gamma24": dict(gamma=2.4),
    "long_exposure": dict(exposure=4e-3),
    "grey": dict(white=80.0),
    "jpeg": dict(jpeg=75),
    "bayer": dict(bayer=True),
    "wet": dict(lambert=1.0, light=(25, 90), gloss=0.6),
    "fingers": dict(extra="fingers"),
    "dirt": dict(extra="dirt"),
    "curled": dict(extra="curled"),
    "bent": dict(extra="bent"),
    "askew": dict(extra="askew"),
    "rolling": dict(row_time=10e-6),
    "everything": dict(lambert=0.7, light=(30, 90), defocus=1.5, gamma=1.6, extra="fingers", gloss=0.3, white=150.0),
}


def motion(settings, t):
    """Slides of helix and needle driver [mm], and rotation of the helix [rad], at a time [s]."""
    w = 2 * math.pi * 5.3
    speed, turn = settings["speed"] * 1e3 / w, settings["turn"] / w
    if settings["speed"] == 0:
        k = round(t * RATE)
        way = settings["step"] * (k - 6)
        return 3.137 + way, -5.413 + way, 0.4 + (0.7 * k if settings["step"] else 0)
    return (speed * math.sin(w * t) + 0.31, speed * math.sin(w * t + 1.1) + 0.2, turn * math.sin(w * t + 0.6) + 0.4)


def place(name, slide):
    """Of a marker's centre, relative to the camera: x right, y down, z away [mm]."""
    x = ((WIDTH - 1) / 2 - CENTRE[0]) / SCALE + slide * math.cos(ANGLE)
    return x, (ROWS[name] - CENTRE[1]) / SCALE + slide * math.sin(ANGLE), DISTANCE


def pixel(point):
    return tuple(FOCAL * point[k] / point[2] + CENTRE[k] for k in range(2))
