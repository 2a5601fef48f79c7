"""The organ at the end of a session, to turn in the page: what a viewer draws, and the viewer itself. It is a script in the
share folder of this package, that another package puts there: vibe_web, where its page is built."""

import base64
import functools
import json

import numpy

from ..headless import find_in_package
from .point_cloud import particles_of

STEPS = 65535  # of a coordinate between the lowest and the highest
MILLILITRE = 1e-6  # [m^3]


@functools.lru_cache(maxsize=1)
def viewer_script():
    """The text of the viewer, or an empty one."""
    path = find_in_package("vibe_sessions", "viewer.js", "share")
    if path is None:
        return ""
    with open(path, encoding="utf-8") as file:
        return file.read().replace("</script", "<\\/script")


def organ_data(recording):
    """JSON of numbers only, which is safe inside a page; empty without an organ. It is the text of the element
    organ-data, for which the viewer looks."""
    topology, cloud = recording.topology, recording.particles
    if topology is None or len(topology.triangles) == 0:
        return ""
    points, grades, _ = particles_of(topology, cloud)
    points = numpy.nan_to_num(points)
    lowest = points.min(axis=0)
    step = (points.max(axis=0) - lowest) / STEPS
    places = numpy.rint((points - lowest) / numpy.where(step > 0, step, 1))
    return json.dumps(
        {
            "lowest": lowest.tolist(),
            "step": step.tolist(),
            "places": packed(places, "<u2"),
            "rest": packed(topology.rest_positions, "<f4"),
            "triangles": packed(topology.triangles, "<u4"),
            "grades": packed(numpy.clip(numpy.nan_to_num(grades), 0, 3), "u1"),
            "sutures": sutures_data(recording.sutures),
        },
        allow_nan=False,
    )


def packed(numbers, kind):
    return base64.b64encode(numpy.asarray(numbers).astype(kind).tobytes()).decode()


def sutures_data(message):
    if message is None:
        return {"sets": [], "wounds": []}
    return {"sets": [set_data(suture) for suture in message.sutures], "wounds": [wound_data(b) for b in message.bleedings]}


def set_data(suture):
    pieces = zip(suture.thread_offsets, suture.thread_offsets[1:], suture.tension)
    return {
        "stage": suture.stage,
        "tTag": xyz(suture.t_tag) if suture.has_t_tag else None,
        "cinch": xyz(suture.cinch) if suture.has_cinch else None,
        "bites": [{"place": xyz(bite.position), "full": bool(bite.full_thickness)} for bite in suture.bites],
        "threads": [
            {"tension": finite(tension), "points": [c for point in suture.thread[a : b + 1] for c in xyz(point)]}
            for a, b, tension in pieces
        ],
    }


def wound_data(bleeding):
    return {"place": xyz(bleeding.position), "rate": finite(bleeding.rate / MILLILITRE), "amount": finite(bleeding.amount / MILLILITRE)}


def xyz(point):
    return [finite(c) for c in (point.x, point.y, point.z)]


def finite(number):
    return round(float(numpy.nan_to_num(number)), 6)
