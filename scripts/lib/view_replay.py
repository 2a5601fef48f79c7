"""A recording in rviz: master, robot_state_publisher, vibe_player and rviz with the bar of the times.

scripts/replay has checked the arguments, built the workspace and sourced its environment. Ends when rviz is closed.
"""

import argparse
import os
import signal
import sys
import tempfile
import time

from graph import Graph, GraphError


def rviz_config(workspace, folder):
    """The configuration of sessions with the panel of replays in place of that of the procedure's commands."""
    with open(os.path.join(workspace, "src/vibe_description/rviz/vibe.rviz"), encoding="utf-8") as file:
        text = file.read()
    panel = "Panels:\n  - Class: vibe_rviz_plugins/Replay\n    Name: Replay\n"
    path = os.path.join(folder, "replay.rviz")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace("Panels:\n", panel, 1))
    return path


def start(graph, arguments, folder):
    graph.start_master()
    print(graph.how_to_attach(), flush=True)
    graph.set_parameter("/use_sim_time", True)
    with open(os.path.join(arguments.workspace, "src/vibe_description/urdf/scope.urdf"), encoding="utf-8") as urdf:
        graph.set_parameter("/robot_description", urdf.read())
    graph.set_parameter("/robot_state_publisher/publish_frequency", 200.0)
    graph.set_parameter("/vibe_player/recording", arguments.bag)
    graph.start("robot_state_publisher", ["rosrun", "robot_state_publisher", "robot_state_publisher"])
    player = graph.start("vibe_player", ["rosrun", "vibe_sim", "vibe_player"], visible=True)
    config = rviz_config(arguments.workspace, folder)
    return player, graph.start("rviz", ["rosrun", "rviz", "rviz", "-d", config], essential=False)


def watch(graph, player, rviz):
    while rviz.status() is None:
        dead = graph.dead()
        if dead is player:
            raise GraphError("vibe_player ended with status {}; what it said is above".format(player.status()))
        if dead is not None:
            raise GraphError("{} died with status {}; see {}".format(dead.name, dead.status(), dead.log))
        time.sleep(0.1)


def main():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument("--workspace", required=True)
    parser.add_argument("bag")
    arguments = parser.parse_args()
    failure = None
    with tempfile.TemporaryDirectory(prefix="vibe_replay_") as folder:
        graph = Graph(folder)
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.default_int_handler)
        try:
            watch(graph, *start(graph, arguments, folder))
        except GraphError as error:
            failure = str(error)
        except KeyboardInterrupt:
            print()
        graph.stop_all()
    if failure:
        sys.exit("replay: " + failure)


if __name__ == "__main__":
    main()
