"""What scripts/doctor finds in a ROS graph: topics of the CRTK convention that a client and no simulator knows, and
devices that publish where simulators listened up to release 1.0.0."""

MEASURED = ("measured_js", "measured_cp", "measured_cv", "measured_cf", "setpoint_js", "setpoint_cp", "operating_state",
            "jacobian")  # fmt: skip
COMMANDS = ("servo_jp", "servo_jr", "servo_jv", "servo_jf", "servo_cp", "servo_cr", "servo_cv", "servo_cf", "move_jp",
            "move_jr", "move_cp", "move_cr", "state_command")  # fmt: skip
FORMER = {"scope/measured_js": "scope/input/joint_states", "overstitch/measured_js": "suturing_device/input/joint_states"}


def simulators_of(published):
    return {node for topic, nodes in published.items() if topic.endswith("/applied_input") for node in nodes}


def unanswered(published, subscribed):
    """Sentences about topics that clients of a simulator wait for or send, and nobody answers. Nodes by topic."""
    simulators = simulators_of(published)
    if not simulators:
        return []
    found = []
    for former, present in FORMER.items():
        for topic, nodes in sorted(published.items()):
            devices = sorted(set(nodes) - simulators)
            if devices and topic.endswith("/" + former):
                found.append("{} publishes {}, which no simulator reads; let it publish {}".format(
                    ", ".join(devices), topic, topic[: -len(former)] + present))  # fmt: skip
    for names, mine, theirs, does, nobody in (
        (MEASURED, subscribed, published, "listens to", "nobody publishes"),
        (COMMANDS, published, subscribed, "sends", "nobody receives"),
    ):
        for topic, nodes in sorted(mine.items()):
            kind = topic.rsplit("/", 1)[-1]
            clients = sorted(set(nodes) - simulators)
            if kind in names and clients and topic not in theirs:
                others = sorted(each for each in theirs if each.endswith("/" + kind))
                there = "there is {}".format(", ".join(others)) if others else "this simulator has no {}".format(kind)
                found.append("{} {} {}, which {}; {}: remap the topic, or give the client the namespace of the arm".format(
                    ", ".join(clients), does, topic, nobody, there))  # fmt: skip
    return found
