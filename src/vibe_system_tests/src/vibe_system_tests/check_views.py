"""Properties of the nine pictures of scripts/views --truth, each with a control that must fail.

A property is a function of pictures: what an endoscopist knows of the view, not how it looks today. The control is the
same function of pictures that do not have the property, most often those of the neighbouring view. Every line says what
was measured.

Usage: check_views.py FOLDER
Prints `ok NAME (VIEWS: VALUES)` or `not ok ...` for each property and each control, as scripts/test counts them. Status 0
unless something could not be measured.
"""

import argparse
import collections
import os

import numpy
from PIL import Image
from scipy import ndimage

VIEWS = ("rest", "5mmhg", "10mmhg", "antrum", "retroflexed", "touched", "marked", "sutured", "bleeding")
MARK_SIZE = 12  # a mark of fewer pixels is not judged: its rim and its middle are the same pixels
GLARE = 0.65  # blue to red of a wall that mirrors light; without that it is 0.4 to 0.5
RIM = 5  # how far around a thing the wall is its surroundings [px]


class View:
    """A picture with its truth. `picture`: height x width x 3, 0 to 255; `named`: label of each pixel in words."""

    def __init__(self, folder, name):
        self.name = name
        with Image.open(os.path.join(folder, "eye_{}.png".format(name))) as picture:
            self.picture = numpy.asarray(picture.convert("RGB"), float)
        with numpy.load(os.path.join(folder, "eye_{}.npz".format(name))) as truth:
            self.depth = truth["depth"]
            self.numbers, self.names = truth["labels"], truth["names"]

    def where(self, *words):
        """Pixels whose label has all of these words."""
        found = [all(word in name.replace("_", " ").split() for word in words) for name in self.names]
        return numpy.array(found)[self.numbers]

    def wall(self):
        """The plain wall, without what is next to something else, and without highlights."""
        regions = [self.where(region) for region in ("cardia", "fundus", "body", "antrum", "pylorus")]
        plain = numpy.any(regions, axis=0) & ~self.where("mark") & ~self.where("burn")
        return ndimage.binary_erosion(plain, iterations=4) & (self.picture.min(axis=2) < 200)


def with_truth_of(view, other):
    """The picture of one view with the truth of another: nothing is where the truth says."""
    wrong = View.__new__(View)
    wrong.__dict__.update(other.__dict__, name="{} with the truth of {}".format(view.name, other.name))
    wrong.picture = view.picture
    return wrong


def blurred(values, mask, sigma):
    """Gaussian blur that takes nothing from outside of the mask."""
    weight = ndimage.gaussian_filter(mask.astype(float), sigma)
    return ndimage.gaussian_filter(numpy.where(mask, values, 0), sigma) / numpy.maximum(weight, 1e-6)


def contrast(view, fine=1.0, coarse=6.0):
    """Median contrast of the wall at the size of folds: what lies between two blurs [px], as part of the level."""
    mask, green = view.wall(), view.picture[..., 1]
    level = blurred(green, mask, coarse)
    return float(numpy.sqrt(numpy.mean(((blurred(green, mask, fine) - level)[mask] / level[mask]) ** 2)))


def paleness(view, *region):
    """Median of green to red."""
    mask = view.wall() & (view.where(*region) if region else True)
    return float(numpy.median(view.picture[mask][:, 1] / view.picture[mask][:, 0])) if mask.any() else 0.0


def parts(mask, least=MARK_SIZE):
    """Connected parts of a mask, each a mask, that have at least so many pixels."""
    numbers, count = ndimage.label(mask, structure=numpy.ones((3, 3)))
    return [numbers == k for k in range(1, count + 1) if (numbers == k).sum() >= least]


def ring(thing, distance=RIM):
    """What is near a thing but not next to it."""
    return ndimage.binary_dilation(thing, iterations=2 * distance) & ~ndimage.binary_dilation(thing, iterations=distance)


def surroundings(view, thing):
    """Plain wall near a thing."""
    return ring(thing) & view.wall()


def stands_free(view, thing):
    """Whether there is nothing but plain wall around a thing: no instrument and no highlight."""
    return surroundings(view, thing).sum() > 0.95 * ring(thing).sum()


def ratio(view, mask, channel):
    """Mean of a channel over red, under a mask."""
    return float((view.picture[mask][:, channel] / numpy.maximum(view.picture[mask][:, 0], 1)).mean())


# --- the properties: whether it holds, and what was measured


def folds_flatten(collapsed, half, full):
    """Folds lose their contrast from collapsed over 5 to 10 mmHg."""
    values = [contrast(view) for view in (collapsed, half, full)]
    return values[0] > 1.2 * values[1] and values[1] > 1.2 * values[2], "contrast {:.3f}, {:.3f}, {:.3f}".format(*values)


def touch_is_red(touched):
    """A wall that lies on the lens is red all over, and neither black nor white."""
    seen = touched.picture[touched.depth > 0].sum(axis=1)  # [levels of three channels]
    black, white, green = (seen < 15).mean(), (seen > 735).mean(), ratio(touched, touched.depth > 0, 1)
    said = "black {:.3f}, white {:.3f}, green to red {:.2f}".format(black, white, green)
    return black < 0.05 and white < 0.05 and green < 0.45, said


def antrum_is_paler(antrum, body):
    """The antrum is paler than the body."""
    values = paleness(antrum, "antrum"), paleness(body, "body")
    return values[0] > 1.07 * values[1], "green to red {:.3f} and {:.3f}".format(*values)


def antrum_is_smooth(antrum, body):
    """The antrum is smoother than a folded body."""
    values = contrast(antrum), contrast(body)
    return values[0] < 0.7 * values[1], "contrast {:.3f} and {:.3f}".format(*values)


def levels_across_edges(view, mask):
    """Level just behind each edge of depth within the mask, as a part of the level just before it."""
    depth, level = numpy.nan_to_num(view.depth), view.picture.mean(axis=2)
    inside = ndimage.binary_erosion(mask, iterations=3)
    slope = numpy.stack(numpy.gradient(depth), axis=-1)
    steep = numpy.linalg.norm(slope, axis=-1)
    parts = []
    for pixel in numpy.argwhere(inside & (steep > 0.08 * depth)):
        aside = 4 * slope[tuple(pixel)] / steep[tuple(pixel)]
        behind, before = (tuple(numpy.rint(pixel + sign * aside).astype(int)) for sign in (1, -1))
        if inside[behind] and inside[before]:
            parts.append(level[behind] / level[before])
    return parts


def pylorus_is_an_opening(view):
    """The pylorus is farther away than the antrum, and it is dark behind the edge of its opening."""
    pylorus, antrum = view.where("pylorus"), view.where("antrum")
    if pylorus.sum() < 500 or antrum.sum() < 500:
        return False, "{} px of pylorus".format(pylorus.sum())
    depth = [numpy.nanmedian(view.depth[mask]) for mask in (pylorus, antrum)]
    parts = levels_across_edges(view, pylorus)
    if len(parts) < 30:
        return False, "{} px of edge".format(len(parts))
    words = "depth {:.0f} and {:.0f} mm, behind the edge {:.2f} of the level ({} px)"
    return depth[0] > 1.2 * depth[1] and numpy.median(parts) < 0.75, words.format(
        *(1e3 * d for d in depth), numpy.median(parts), len(parts))


def shaft_enters_at_the_cardia(view):
    """The shaft is seen from outside, dark before the wall, and is next to the cardia."""
    shaft, cardia = view.where("shaft"), view.where("cardia")
    touching = (ndimage.binary_dilation(shaft, iterations=2) & cardia).sum()
    if shaft.sum() < 300 or touching == 0:
        return False, "{} px of shaft, {} beside the cardia".format(shaft.sum(), touching)
    dark = view.picture[ndimage.binary_erosion(shaft)].mean() / view.picture[view.wall()].mean()
    return dark < 0.5, "{} px of shaft, {} beside the cardia, {:.2f} of the light of the wall".format(
        shaft.sum(), touching, dark
    )


def place_of_blob(view, mark):
    """Where the picture itself has its white near a mark: half as white as the middle of the mark, and more."""
    white = view.picture[..., 2] / numpy.maximum(view.picture[..., 0], 1)
    around = numpy.median(white[surroundings(view, mark)])
    near = ndimage.binary_dilation(mark, iterations=RIM)
    weight = numpy.where(near, numpy.clip((white - around) / max(white[mark].max() - around, 0.1) - 0.5, 0, 1), 0)
    return numpy.array(ndimage.center_of_mass(weight)) if weight.sum() > 0 else numpy.full(2, numpy.inf)


def in_highlight(view, mark):
    """Whether the film of mucus mirrors the light around a mark: what it mirrors is as white as a mark."""
    return ratio(view, surroundings(view, mark), 2) > GLARE


def marks_are_white(view, fewest=3):
    """Every mark of the truth that stands free in the picture is whiter than the wall around, at its place."""
    marks = [m for m in parts(view.where("mark")) if stands_free(view, m) and not in_highlight(view, m)]
    good, farthest = 0, 0.0
    for mark in marks:
        whiter = ratio(view, mark, 2) > 1.3 * ratio(view, surroundings(view, mark), 2)
        aside = numpy.linalg.norm(place_of_blob(view, mark) - ndimage.center_of_mass(mark))
        good += whiter and aside < 2
        farthest = max(farthest, aside)
    words = "{} of {} marks, {:.1f} px aside at most".format(good, len(marks), farthest)
    return len(marks) >= fewest and good == len(marks), words


def thread_is_blue(view):
    """Where the truth has thread many pixels are blue: it is thinner than a pixel."""
    thread = view.where("thread")
    if thread.sum() < 20:
        return False, "{} px of thread".format(thread.sum())
    share = float((view.picture[thread][:, 2] > view.picture[thread][:, 0] + 10).mean())
    return share > 0.2, "{:.0f} % of {} px are blue".format(100 * share, thread.sum())


def blood_is_red(view, without):
    """Where the truth has blood the picture is darker and redder than without bleeding, and the same elsewhere."""
    blood = view.where("blood")
    if blood.sum() < 50:
        return False, "{} px of blood".format(blood.sum())
    redness = ratio(view, blood, 1), ratio(without, blood, 1)
    change = numpy.abs(view.picture - without.picture).max(axis=2)
    wall = view.wall() & ~ndimage.binary_dilation(blood, iterations=6)
    elsewhere = float(numpy.median(change[wall]))
    words = "green to red {:.2f} and {:.2f}, changed by {:.0f} there and {:.0f} elsewhere"
    holds = redness[0] < 0.6 * redness[1] and change[blood].mean() > 5 * elsewhere + 10
    return holds, words.format(*redness, change[blood].mean(), elsewhere)


Property = collections.namedtuple("Property", "measure views controls")
# a control is the names of its views; a pair "A/B" is the picture of A with the truth of B
PROPERTIES = [
    Property(folds_flatten, "rest 5mmhg 10mmhg", ["5mmhg 5mmhg 10mmhg", "rest 10mmhg 10mmhg"]),
    Property(antrum_is_paler, "antrum 10mmhg", ["10mmhg/antrum 10mmhg"]),
    Property(antrum_is_smooth, "antrum 5mmhg", ["rest 5mmhg", "antrum 10mmhg"]),
    Property(pylorus_is_an_opening, "antrum", ["10mmhg", "10mmhg/antrum"]),
    Property(shaft_enters_at_the_cardia, "retroflexed", ["antrum", "marked/retroflexed"]),
    Property(touch_is_red, "touched", ["rest", "10mmhg", "retroflexed"]),
    Property(marks_are_white, "marked", ["10mmhg", "10mmhg/marked", "sutured/marked"]),
    Property(thread_is_blue, "sutured", ["marked", "marked/sutured"]),
    Property(blood_is_red, "bleeding sutured", ["sutured sutured", "sutured/bleeding sutured"]),
]


def check(views, names, measure, expected):
    wanted = []
    for name in names.split():
        picture, _, truth = name.partition("/")
        wanted.append(with_truth_of(views[picture], views[truth]) if truth else views[picture])
    holds, values = measure(*wanted)
    title = "{}: {}".format("views" if expected else "control, must fail", measure.__doc__.strip())
    print("{} {} ({}: {})".format("ok" if holds == expected else "not ok", title, names, values))


def main():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument("folder")
    folder = parser.parse_args().folder
    views = {name: View(folder, name) for name in VIEWS}
    for of in PROPERTIES:
        check(views, of.views, of.measure, True)
        for names in of.controls:
            check(views, names, of.measure, False)


if __name__ == "__main__":
    main()
