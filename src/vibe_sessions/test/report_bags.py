"""Recordings with known numbers, for the tests of the reports."""

import math
import struct

import genpy
import rosbag
from geometry_msgs.msg import PoseStamped, WrenchStamped, Point
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import String
from vibe_msgs.msg import (
    Bite, GoalProgress, ProcedureEvent, ProcedureState, SkillMetrics, SolverStatistics, StageTime, StepInput, Suture,
    SutureArray, TissueTopology, TraineeProgress,
)  # fmt: skip

PERIOD = 1 / 60
RADIUS = 0.05  # of the circle of the tip [m]
TURN = 5.0  # time of a turn [s]
SCENE = "name: test\nseed: 3\n"


def time_of(seconds):
    return genpy.Time.from_sec(seconds)


def sphere(rings=12, segments=16):
    """Vertices and triangles of a sphere of 60 mm."""
    points, triangles = [], []
    for i in range(rings + 1):
        for j in range(segments):
            a, b = math.pi * (i + 0.5) / (rings + 1), 2 * math.pi * j / segments
            points.append((0.06 * math.sin(a) * math.cos(b), 0.06 * math.sin(a) * math.sin(b), 0.06 * math.cos(a)))
    for i in range(rings):
        for j in range(segments):
            a, b = i * segments + j, i * segments + (j + 1) % segments
            triangles += [(a, a + segments, b), (b, a + segments, b + segments)]
    return points, triangles


class SyntheticSession:
    """Writes a session in which the tip goes round on a circle and the force is a half sine of 6 N every 5 s."""

    def __init__(self, path, duration=5.0, origin=1.0, namespace="", scene=SCENE, rate=60, **options):
        self.path, self.duration, self.origin, self.namespace = path, duration, origin, namespace
        self.scene_text, self.rate = scene, rate  # of pose and force [Hz]
        self.scene_name = options.get("scene_name", "test")
        self.skip_steps = options.get("skip_steps", ())
        self.caller = options.get("caller", "/gamepad_node")
        self.delay = options.get("delay", 0.020)  # of the inputs [s]
        self.compression = options.get("compression", rosbag.Compression.NONE)
        self.metrics = options.get("metrics", {})
        self.event_text = options.get("event_text", "Something.")
        self.broken_sensor = options.get("broken_sensor", False)  # NaN and infinity among the values
        self.peak = options.get("peak", {})  # {second: tension of the thread [N]}
        self.windows = options.get("windows")  # of solver_statistics [s]; default: one a second
        self.lose_every = options.get("lose_every", 0)  # input message on the way to the recorder
        self.unhashed = options.get("unhashed", ())
        self.identity = options.get("identity", 0)  # of the session
        self.run = 1
        self.without = options.get("without", ())
        self.sequence = 0

    def write(self):
        with rosbag.Bag(self.path, "w", compression=self.compression, chunk_threshold=64 * 1024) as self.bag:
            self._begin()
            steps = round(self.duration / PERIOD)
            for step in range(steps):
                self._step(step)
            self._end(self.origin + steps * PERIOD)
        return self.path

    def put(self, topic, message, stamp, received=None, caller=None):
        if topic in self.without:
            return
        if hasattr(message, "header"):
            message.header.stamp = time_of(stamp)
        header = {"callerid": caller} if caller else None
        if header:
            kind = type(message)
            header.update(topic=self.namespace + "/" + topic, type=kind._type, md5sum=kind._md5sum,
                          message_definition=kind._full_text)  # fmt: skip
        self.bag.write(self.namespace + "/" + topic, message, time_of(received or stamp), connection_header=header)

    def _begin(self):
        self.put("scene", String(self.scene_text), self.origin)
        points, triangles = sphere()
        topology = TissueTopology(
            revision=1, name="test", triangles=[k for t in triangles for k in t],
            rest_positions=[v for p in points for v in p],
        )  # fmt: skip
        self.put("tissue/topology", topology, self.origin)
        self.put("procedure/events", ProcedureEvent(kind=ProcedureEvent.WARNING, text=self.event_text), self.origin + 0.1)

    def _step(self, step):
        stamp = self.origin + step * PERIOD
        if step not in self.skip_steps:
            state_hash = 0 if step in self.unhashed else step + 1
            message = StepInput(step=step, version=2, run=self.run, state_hash=state_hash,
                                session=self.identity)  # fmt: skip
            self.put("applied_input", message, stamp, stamp + PERIOD)
        seconds = (step + 1) * PERIOD
        if step % max(1, round(60 / self.rate)) == 0:
            self._tool(seconds)
        if step % 60 == 0:
            self._second(seconds)
        if self.origin > 1e6:
            self._input(stamp)

    def _input(self, stamp):
        self.sequence += 1
        if self.lose_every and self.sequence % self.lose_every == 0:
            return
        message = JointState(name=["insertion"], position=[0.1])
        message.header.seq = self.sequence
        self.put("scope/input/joint_states", message, stamp, stamp + self.delay, self.caller)

    def _tool(self, seconds):
        angle = 2 * math.pi * seconds / TURN
        pose = PoseStamped()
        pose.pose.position = Point(RADIUS * math.cos(angle), RADIUS * math.sin(angle), 0.01)
        pose.pose.orientation.w = 1
        self.put("scope/measured_cp", pose, self.origin + seconds)
        wrench = WrenchStamped()
        wrench.wrench.force.z = 6 * max(0.0, math.sin(angle))
        if self.broken_sensor and seconds > 0.9 * self.duration:
            wrench.wrench.force.z = math.nan
        self.put("scope/measured_cf", wrench, self.origin + seconds)

    def _second(self, seconds):
        stamp = self.origin + seconds
        phase = "inspect" if seconds < 0.4 * self.duration else "suture"
        state = ProcedureState(
            scene=self.scene_name, seed=3, step_period=PERIOD, origin=time_of(self.origin), phase=phase,
            volume=1e-3, pressure=1333.22387415, bites=2, sutures=1, time=seconds,
        )  # fmt: skip
        self.put("procedure/state", state, stamp)
        self.put("sutures", self._sutures(seconds), stamp)
        if self.windows is None:
            self._statistics(1.0, seconds, stamp)

    def _statistics(self, window, seconds, stamp):
        stage = StageTime(name="solver", p50=3.0, p99=9.0, max=math.inf if self.broken_sensor else 20.0 + seconds)
        energy = StageTime(name="solver_energy", p50=1.0, p99=3.0, max=5.0)
        paths = StageTime(name="solver_paths", p50=1.5, p99=2.0, max=4.0)
        statistics = SolverStatistics(
            window=window, stages=[stage, energy, paths], real_time_factor=1.5, missed_deadlines=2, particle_count=208, residual=1e-6,
            state_hash="0123456789abcdef",
        )  # fmt: skip
        self.put("solver_statistics", statistics, stamp)

    def _sutures(self, seconds):
        bites = [
            Bite(position=Point(0.06, 0.02 * k, 0.0), time=1.0 + 60 * k, depth=0.004, thickness=0.003, full_thickness=k == 0)
            for k in range(2)
        ]
        thread = [Point(0.062, 0.02 * k / 5, 0.0) for k in range(6)]
        suture = Suture(
            stage=Suture.CINCHED, bites=bites, thread=thread, thread_offsets=[0, 5], length=[0.021],
            tension=[self.peak.get(int(seconds), 0.5 * seconds)],
            technique=Suture.TECHNIQUE_U, technique_name="u", technique_margin=0.5, pulled=0.03, cinch_tension=3.0,
            begin=1.0, end=80.0, taken=[Point(0.06, 0.0, 0.0), Point(0.06, 0.025, 0.0)],
        )  # fmt: skip
        return SutureArray(sutures=[suture])

    def _end(self, stamp):
        for window in self.windows or ():
            self._statistics(window, 0.0, stamp)
        skill = SkillMetrics(time=self.duration, max_force=6.0, path_length=0.314, full_thickness_share=0.5,
                             log_dimensionless_jerk=math.nan, coverage=math.nan)  # fmt: skip
        for name, value in self.metrics.items():
            setattr(skill, name, value)
        self.put("procedure/skill_metrics", skill, stamp)
        points, _ = sphere()
        fields = [PointField(name, 4 * k, PointField.FLOAT32, 1) for k, name in enumerate("xyz")]
        fields.append(PointField("grade", 12, PointField.UINT8, 1))
        data = b"".join(struct.pack("<3fB3x", *p, 1 if k < 5 else 0) for k, p in enumerate(points))
        cloud = PointCloud2(height=1, width=len(points), fields=fields, point_step=16, row_step=len(data), data=data)
        self.put("tissue/particles", cloud, stamp)
        goals = [GoalProgress(id=1, state=GoalProgress.REACHED), GoalProgress(id=2, state=GoalProgress.FAILED)]
        self.put("trainee/progress", TraineeProgress(skill="expert", goals=goals), stamp)
