"""vibe_view_bench with what it needs: a ROS master and a virtual display. Ends with its status."""

import sys
import tempfile

from vibe_bringup.graph import Graph, GraphError
from vibe_bringup.rviz_window import RvizWindow


def main():
    with tempfile.TemporaryDirectory(prefix="vibe-bench-") as folder:
        graph = Graph(folder)
        window = RvizWindow(graph, folder, "")
        try:
            graph.start_master()
            window.start_display()
            command = ["env", "DISPLAY=" + window.display, "rosrun", "vibe_rviz_plugins", "vibe_view_bench"]
            bench = graph.start("vibe_view_bench", command, visible=True)
            bench.process.wait()
            status = bench.status()
        except GraphError as error:
            print("bench_view: {}".format(error), file=sys.stderr)
            status = 2
        finally:
            graph.stop_all()
    sys.exit(status)


if __name__ == "__main__":
    main()
