"""What a sensor_msgs/PointCloud2 holds."""

import numpy

TYPES = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 8: "<f8"}  # by datatype of PointField


def fields_of_cloud(cloud):
    """The points as an array with named fields."""
    kinds = {f.name: (TYPES[f.datatype], f.offset) for f in cloud.fields if f.datatype in TYPES}
    layout = {"names": list(kinds), "formats": [kind for kind, _ in kinds.values()],
              "offsets": [offset for _, offset in kinds.values()], "itemsize": cloud.point_step}  # fmt: skip
    return numpy.frombuffer(cloud.data, numpy.dtype(layout), count=cloud.width * cloud.height)


def positions_of(points):
    return numpy.stack([points[axis] for axis in "xyz"], axis=1)


def particles_of(topology, cloud):
    """(positions [m], grades, whether these are the undeformed ones) of tissue/particles."""
    rest = numpy.array(topology.rest_positions).reshape(-1, 3)
    if cloud is None or cloud.width * cloud.height != len(rest):
        return rest, numpy.zeros(len(rest)), True
    fields = fields_of_cloud(cloud)
    grades = fields["grade"].astype(float) if "grade" in fields.dtype.names else numpy.zeros(len(rest))
    return positions_of(fields).astype(float), grades, False
