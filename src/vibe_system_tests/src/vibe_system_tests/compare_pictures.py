"""Do two pictures look alike? Two measures, both after a small blur, for edges differ by fractions of a pixel between
graphics drivers: the structural similarity of lightness (Wang et al. 2004, IEEE TIP 13:600; a Gaussian window of 1.5
pixels), and the mean colour difference in CIELAB (CIE 76). Both are means over the worst three percent of the tiles of
the picture, so that a small part that differs is not hidden by the background.

Usage: compare_pictures.py REFERENCE PICTURE [--region WIDTHxHEIGHT+X+Y] [--similarity LEAST] [--colour MOST]
Prints both figures; status 0: alike, 1: not, 2: cannot be compared.
"""

import argparse
import re
import sys

import numpy
from PIL import Image
from scipy.ndimage import gaussian_filter

BLUR = 1.0  # standard deviation [pixels]
WINDOW = 1.5  # standard deviation of the window of the similarity [pixels]
TILE = 32  # [pixels]
WORST = 0.03  # share of the tiles that counts
LEAST_SIMILARITY, MOST_COLOUR = 0.9, 3.0  # why: docs/rviz_benchmark.md#pictures

# sRGB with the white of D65 to CIE XYZ (IEC 61966-2-1), divided by that white
TO_XYZ = numpy.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = TO_XYZ.sum(axis=1)


class PictureError(Exception):
    """One sentence for the user."""


def load(file, region=None):
    """Red, green and blue between 0 and 1; `region` is (width, height, x, y) in pixels."""
    try:
        with Image.open(file) as picture:
            pixels = numpy.asarray(picture.convert("RGB"), dtype=float) / 255
    except OSError as error:
        raise PictureError("{} is no picture that can be read: {}".format(file, error)) from error
    if region is None:
        return pixels
    width, height, x, y = region
    if x + width > pixels.shape[1] or y + height > pixels.shape[0]:
        raise PictureError("{} is smaller than the region that is to be compared".format(file))
    return pixels[y : y + height, x : x + width]


def to_lab(rgb):
    """CIELAB of each pixel: lightness 0 to 100, then a and b."""
    linear = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    ratio = linear @ TO_XYZ.T / WHITE
    f = numpy.where(ratio > (6 / 29) ** 3, numpy.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    return numpy.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)


def similarity_map(a, b):
    """Structural similarity of two fields of lightness, for each pixel."""
    c1, c2 = (0.01 * 100) ** 2, (0.03 * 100) ** 2
    mean_a, mean_b = (gaussian_filter(field, WINDOW) for field in (a, b))
    variance_a = gaussian_filter(a * a, WINDOW) - mean_a**2
    variance_b = gaussian_filter(b * b, WINDOW) - mean_b**2
    covariance = gaussian_filter(a * b, WINDOW) - mean_a * mean_b
    above = (2 * mean_a * mean_b + c1) * (2 * covariance + c2)
    return above / ((mean_a**2 + mean_b**2 + c1) * (variance_a + variance_b + c2))


def tiles(field):
    """Means of the field over tiles; a rest at the edges is left out."""
    rows, columns = (size // TILE for size in field.shape)
    if rows == 0 or columns == 0:
        raise PictureError("pictures must have {0} x {0} pixels at least".format(TILE))
    cut = field[: rows * TILE, : columns * TILE]
    return cut.reshape(rows, TILE, columns, TILE).mean(axis=(1, 3)).ravel()


def compare(reference, picture):
    """Similarity (1: the same) and colour difference (0: the same; 2 is just seen side by side)."""
    if reference.shape != picture.shape:
        raise PictureError("the pictures have different sizes: {} and {}".format(reference.shape, picture.shape))
    a, b = (to_lab(gaussian_filter(rgb, (BLUR, BLUR, 0))) for rgb in (reference, picture))
    similarity = numpy.sort(tiles(similarity_map(a[..., 0], b[..., 0])))
    colour = numpy.sort(tiles(numpy.linalg.norm(a - b, axis=-1)))[::-1]
    count = max(1, round(WORST * len(colour)))
    return similarity[:count].mean(), colour[:count].mean()


def region_of(text):
    found = re.fullmatch(r"(\d+)x(\d+)\+(\d+)\+(\d+)", text)
    if found is None:
        raise argparse.ArgumentTypeError("'{}' is not WIDTHxHEIGHT+X+Y".format(text))
    return tuple(int(part) for part in found.groups())


def main():
    parser = argparse.ArgumentParser(allow_abbrev=False, description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("reference")
    parser.add_argument("picture")
    parser.add_argument("--region", type=region_of)
    parser.add_argument("--similarity", type=float, default=LEAST_SIMILARITY)
    parser.add_argument("--colour", type=float, default=MOST_COLOUR)
    arguments = parser.parse_args()
    try:
        pictures = [load(file, arguments.region) for file in (arguments.reference, arguments.picture)]
        similarity, colour = compare(*pictures)
    except PictureError as error:
        print("compare_pictures: {}.".format(error), file=sys.stderr)
        sys.exit(2)
    print("similarity {:.4f}, colour difference {:.2f}".format(similarity, colour))
    sys.exit(0 if similarity >= arguments.similarity and colour <= arguments.colour else 1)


if __name__ == "__main__":
    main()
