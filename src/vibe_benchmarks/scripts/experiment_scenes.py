"""Experiments on the organ of a scene, with the module vibe: what experiment.py calls for `scene`."""

import numpy
import vibe

REGIONS = {"fundus": 1, "corpus": 2, "antrum": 3}


def stretches(triangles, rest, now, axis):
    """Stretch (triangles, 2) of the middle surface along the projection of `axis` (triangles, 3) on it, and across."""
    def sides(places):
        a, b, c = (places[triangles[:, k]] for k in range(3))
        return numpy.stack([b - a, c - a], axis=2)

    before, after = sides(rest), sides(now)
    normal = numpy.cross(before[:, :, 0], before[:, :, 1])
    normal /= numpy.linalg.norm(normal, axis=1)[:, None]
    along = axis - (axis * normal).sum(1)[:, None] * normal
    along /= numpy.maximum(numpy.linalg.norm(along, axis=1), 1e-12)[:, None]
    inverse = numpy.linalg.pinv(before)
    found = []
    for direction in (along, numpy.cross(normal, along)):
        moved = numpy.einsum("tij,tjk,tk->ti", after, inverse, direction)
        found.append(numpy.linalg.norm(moved, axis=1))
    return numpy.stack(found, axis=1)


def rising(model, triangles, rest):
    """Direction (triangles, 3) in which the coordinate along the organ rises."""
    anatomy = vibe.Anatomy(vibe.Simulation(model))
    corner = numpy.eye(3)
    along = numpy.array([[anatomy.along(t, corner[k]) for k in range(3)] for t in range(len(triangles))])
    a, b, c = (rest[triangles[:, k]] for k in range(3))
    sides, rise = numpy.stack([b - a, c - a], axis=1), along[:, 1:] - along[:, :1]
    return numpy.einsum("tij,tj->ti", numpy.linalg.pinv(sides), rise)


def filled_stomach(litres, log, scale=1.0, particles=2000, **tissue):
    """The default stomach, alone and without weight, filled to volumes [L]: pressure [mmHg] by volume, and at the last
    volume the strain (along, around) of regions [%]."""
    model = vibe.load(geometry={"particles": particles, "scale": scale}, tissue=tissue,
                      gas={"regulated_pressure": "20 kPa", "flow_limit": "20 L/min"},
                      gravity={"acceleration": [0, 0, 0]}, foundation={"stiffness": 0})
    rest, triangles = numpy.array(model.rest_positions), numpy.array(model.triangles)
    axis = rising(model, triangles, rest)
    simulation = vibe.Simulation(model)
    log.write(f"  {1e3 * simulation.volume:.3f} L at rest\n")
    samples = {"pressure": {}}
    for volume in litres:
        while simulation.volume < 1e-3 * volume:
            simulation.step(insufflate=True)
            if simulation.time > 600:
                raise ValueError(f"the stomach holds {1e3 * simulation.volume:.2f} L after ten minutes; fill it less")
        simulation.run(120, insufflate=False)
        samples["pressure"][volume] = simulation.pressure / 133.322
    strain = stretches(triangles, rest, numpy.array(simulation.positions), axis) - 1
    region, wall = numpy.array(model.region)[triangles[:, 0]], numpy.array(model.area)[triangles].sum(1)
    for name, number in REGIONS.items():
        inside = (region == number) & (strain[:, 0] > -1)  # where the axis has no direction, at its ends, there is none
        samples[name] = tuple(100 * numpy.average(strain[inside], axis=0, weights=wall[inside]))
    return samples
