"""Which connections of a bag belong to a session: by the end of the topic's name and the type of its messages."""

STEP_INPUT = "vibe_msgs/StepInput"
TYPES = {
    "applied_input": STEP_INPUT,
    "session_info": "vibe_msgs/SessionInfo",
    "scene": "std_msgs/String",
    "procedure/state": "vibe_msgs/ProcedureState",
    "procedure/events": "vibe_msgs/ProcedureEvent",
    "procedure/skill_metrics": "vibe_msgs/SkillMetrics",
    "sutures": "vibe_msgs/SutureArray",
    "solver_statistics": "vibe_msgs/SolverStatistics",
    "scope/measured_cp": "geometry_msgs/PoseStamped",
    "scope/measured_cf": "geometry_msgs/WrenchStamped",
    "step_result": "vibe_msgs/StepResult",
    "tissue/topology": "vibe_msgs/TissueTopology",
    "tissue/particles": "sensor_msgs/PointCloud2",
    "trainee/progress": "vibe_msgs/TraineeProgress",
    "suturing_device/tracking": "vibe_msgs/InstrumentTrackArray",
}
# what a person, a device or a program sends to the simulator; they tell who drove and how late it came
INPUTS = {
    "scope/input/joint_states": "sensor_msgs/JointState",
    "scope/servo_jp": "sensor_msgs/JointState",
    "scope/servo_cp": "geometry_msgs/PoseStamped",
    "scope/move_jp": "sensor_msgs/JointState",
    "scope/buttons": "sensor_msgs/Joy",
    "suturing_device/input/joint_states": "sensor_msgs/JointState",
    "suturing_device/servo_jp": "sensor_msgs/JointState",
    "suturing_device/move_jp": "sensor_msgs/JointState",
}
ABSOLUTE = {"/diagnostics": "diagnostic_msgs/DiagnosticArray", "/clock": "rosgraph_msgs/Clock"}


def namespaces_of(bag):
    """Prefixes of the topics applied_input, "" for /applied_input."""
    return sorted(
        {
            without_slash(("/" + connection.topic)[: -len("/applied_input")])
            for connection in bag.connections.values()
            if connection.datatype == STEP_INPUT and ("/" + connection.topic).endswith("/applied_input")
        }
    )


def without_slash(namespace):
    """"/left" of "left", "/left" and "/left/"; "" of the root."""
    namespace = namespace.strip("/")
    return "/" + namespace if namespace else ""


def quoted(namespaces):
    return ", ".join("'{}'".format(name or "/") for name in namespaces)


def find_topics(bag, namespace):
    """Numbers of the connections by short name, each a list: a topic may have had several publishers."""
    found = {}
    for short, datatype in {**TYPES, **INPUTS}.items():
        found[short] = select(bag, namespace + "/" + short, datatype)
    for topic, datatype in ABSOLUTE.items():
        found[topic] = select(bag, topic, datatype)
    return found


def select(bag, topic, datatype):
    topic = "/" + topic.lstrip("/")
    return [
        key
        for key, connection in bag.connections.items()
        if "/" + connection.topic.lstrip("/") == topic and connection.datatype == datatype and bag.count(key) > 0
    ]
