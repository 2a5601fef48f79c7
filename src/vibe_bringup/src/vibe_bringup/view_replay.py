"""A recording in rviz: master, robot_state_publisher, vibe_player and rviz with the bar of the times. Ends when rviz is
closed."""

import os
import tempfile
import time

from . import places
from .graph import Graph, GraphError
from .session import carry_out


def rviz_config(folder):
    """The configuration of sessions with the panel of replays in place of that of the procedure's commands."""
    with open(places.find(places.RVIZ_CONFIG), encoding="utf-8") as file:
        text = file.read()
    panel = "Panels:\n  - Class: vibe_rviz_plugins/Replay\n    Name: Replay\n"
    path = os.path.join(folder, "replay.rviz")
    with open(path, "w", encoding="utf-8") as file:  # not whole: scratch
        file.write(text.replace("Panels:\n", panel, 1))
    return path


def show(graph, arguments, folder):
    graph.start_master()
    print(graph.how_to_attach(), flush=True)
    graph.set_parameter("/use_sim_time", True)
    graph.set_parameter("/vibe_player/recording", arguments.bags[0])
    graph.set_parameter("/vibe_player/session", arguments.session or "")
    graph.set_parameter("/vibe_player/namespace", arguments.namespace or "")
    graph.start_robot()
    player = graph.start_node("vibe_sim", "vibe_player", visible=True)
    rviz = graph.start_rviz(rviz_config(folder))
    while rviz.status() is None:
        dead = graph.dead()
        if dead is player:
            raise GraphError("vibe_player ended with status {}; what it said is above".format(player.status()))
        if dead is not None:
            raise GraphError("{} died with status {}; see {}".format(dead.name, dead.status(), dead.log))
        time.sleep(0.1)


def view(arguments):
    """Returns the exit status."""
    with tempfile.TemporaryDirectory(prefix="vibe_replay_") as folder:
        graph = Graph(folder)
        return carry_out("replay", [lambda: show(graph, arguments, folder)], graph.stop_all, may_be_interrupted=True)
