"""What Rerun's own reader finds in FILE.rrd, as JSON: rows of each entity, whether there is a layout, the first wall.

Run by export_readers.py with the Python of rerun.txt."""

import collections
import json
import sys

from rerun.chunk import RrdReader


def main(path):
    reader, rows, wall = RrdReader(path), collections.Counter(), None
    for chunk in reader.stream():
        rows[chunk.entity_path] += chunk.num_rows
        if chunk.entity_path == "/world/organ/wall" and wall is None:
            batch = chunk.to_record_batch()
            wall = {name.partition(":")[2]: batch.column(name)[0].as_py() for name in batch.schema.names if name.startswith("Mesh3D:")}
    names = "vertex_positions", "triangle_indices", "vertex_normals"
    print(json.dumps({"rows": rows, "layouts": len(reader.blueprints()), **{name: wall[name] for name in names}}))


main(sys.argv[1])
