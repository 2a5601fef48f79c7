#!/usr/bin/env python3
"""Every topic that the simulator sends: type, rate, frame, stamps that are sample times, and a value that physics or
kinematics fixes. The simulation is paused and stepped, so that all of it is exact."""

import math
import sys
import unittest

import numpy
import rospy
import rostest
import sensor_msgs.point_cloud2
import tf2_ros
from geometry_msgs.msg import Point, PoseStamped, WrenchStamped
from node_test_support import EPOCH, SUTURING_DEVICE_JOINTS, PERIOD, SCOPE_JOINTS, buttons, joints, stamp_of
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, Joy, PointCloud2
from vibe_msgs.msg import ProcedureEvent, ProcedureState, SkillMetrics, SolverStatistics, StepInput, StepResult, SutureArray
from vibe_msgs.msg import TissuePull, TissuePullState, TissueTopology, ToolContacts
from vibe_msgs.srv import Reset, Step
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

STREAMS = {
    "scope/measured_cp": (PoseStamped, "world"),
    "suturing_device/helix/measured_cp": (PoseStamped, "world"),
    "scope/measured_cf": (WrenchStamped, "scope_tip"),
    "scope/contacts": (ToolContacts, "world"),
    "joint_states": (JointState, "scope_base"),
    "scope/setpoint_js": (JointState, "scope_base"),
    "tissue/particles": (PointCloud2, "stomach"),
    "step_result": (StepResult, "world"),
    "applied_input": (StepInput, ""),
}
BASE_X = -0.12  # of scope_base in balloon.yaml [m]


class TopicsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recorders = {topic: Recorder(topic, kind) for topic, (kind, _) in STREAMS.items()}
        cls.clock = Recorder("/clock", Clock)
        cls.events = Recorder("procedure/events", ProcedureEvent)
        cls.procedure = Recorder("procedure/state", ProcedureState)
        cls.skill = Recorder("procedure/skill_metrics", SkillMetrics)
        cls.topology = Recorder("tissue/topology", TissueTopology)
        cls.performance = Recorder("solver_statistics", SolverStatistics)
        cls.scope = rospy.Publisher("scope/input/joint_states", JointState, queue_size=100)
        cls.suturing_device = rospy.Publisher("suturing_device/input/joint_states", JointState, queue_size=100)
        cls.buttons = rospy.Publisher("scope/buttons", Joy, queue_size=100)
        cls.pull = rospy.Publisher("tissue/pull", TissuePull, queue_size=100)
        cls.pull_state = Recorder("tissue/pull_state", TissuePullState)
        cls.tf = tf2_ros.Buffer()
        cls.tf_listener = tf2_ros.TransformListener(cls.tf)
        rospy.wait_for_service("step", 20)
        cls.step_service = rospy.ServiceProxy("step", Step)
        cls.reset_service = rospy.ServiceProxy("reset", Reset)
        everything = list(cls.recorders.values()) + [
            cls.clock, cls.events, cls.procedure, cls.skill, cls.performance, cls.pull_state]
        assert wait_until(lambda: all(r.is_connected() for r in everything), 20)
        publishers = (cls.scope, cls.suturing_device, cls.buttons, cls.pull)
        assert wait_until(lambda: all(p.get_num_connections() > 0 for p in publishers), 20)

    def setUp(self):
        self.assertTrue(self.reset_service(seed=0, keep_time=False).success)
        wait_until(lambda: self.procedure.messages and self.procedure.messages[-1].step == 0)
        for recorder in list(self.recorders.values()) + [self.events, self.procedure, self.skill, self.clock]:
            recorder.clear()

    def step(self, n):
        """Steps and waits until all messages of these steps are here."""
        applied = self.recorders["applied_input"]
        before = len(applied.messages)
        reply = self.step_service(n)
        self.assertTrue(reply.success, reply.message)
        self.assertTrue(wait_until(lambda: len(applied.messages) == before + n))
        last = self.now()
        for topic in STREAMS:
            wanted = last if topic != "applied_input" else 0
            wait_until(lambda: self.recorders[topic].stamps()[-1:] >= [wanted])

    def now(self):
        self.last_step = self.recorders["applied_input"].messages[-1].step + 1
        return stamp_of(self.last_step)

    def command(self, scope, suturing_device=(0, 0, 0), pressed=()):
        """Sends inputs for the present time and waits until a step has used them."""
        stamp = rospy.Time(nsecs=EPOCH)
        for attempt in range(100):
            self.scope.publish(joints(SCOPE_JOINTS, scope, stamp))
            self.suturing_device.publish(joints(SUTURING_DEVICE_JOINTS, suturing_device, stamp))
            self.buttons.publish(buttons(pressed, stamp))
            self.step(1)
            used = self.recorders["applied_input"].messages[-1]
            wanted = tuple(scope) + tuple(suturing_device)
            if used.joints == wanted and [i for i in range(6) if used.buttons[i]] == list(pressed):
                return attempt
        self.fail("the command was never used")

    def test_every_step_has_its_stamp_and_frame(self):
        self.step(120)
        for topic, (_, frame) in STREAMS.items():
            with self.subTest(topic=topic):
                recorder = self.recorders[topic]
                first = 0 if topic == "applied_input" else 1
                self.assertEqual(recorder.stamps()[-120:], [stamp_of(k) for k in range(first, first + 120)])
                self.assertEqual({m.header.frame_id for m in recorder.messages}, {frame})

    def test_particles_come_at_sixty_hertz_of_simulated_time(self):
        self.step(60)
        stamps = self.recorders["tissue/particles"].stamps()[-60:]
        rate = (len(stamps) - 1) / (1e-9 * (stamps[-1] - stamps[0]))
        self.assertAlmostEqual(rate, 60.0, delta=0.01)

    def test_clock_says_each_time_once_while_it_runs(self):
        self.step(50)
        wait_until(lambda: self.clock.messages[-1].clock.to_nsec() == stamp_of(50))
        times = [m.clock.to_nsec() for m in self.clock.messages]
        self.assertEqual(times, sorted(times))
        self.assertEqual(times[-1], stamp_of(50))
        running = [t for t in times if EPOCH < t < stamp_of(50)]
        self.assertEqual(len(running), len(set(running)))
        # rospy itself reads the clock with a queue of one, so that some may be missing here
        self.assertTrue(set(running) <= {stamp_of(k) for k in range(1, 50)})

    def test_a_second_clock_is_reported_with_its_name(self):
        self.events.clear()
        rival = rospy.Publisher("/clock", Clock, queue_size=1)
        try:
            warning = self.events.waits_for(lambda m: "/clock" in m.text, 10)
            self.assertIsNotNone(warning)
            self.assertEqual(warning.kind, ProcedureEvent.WARNING)
            self.assertIn(rospy.get_name(), warning.text)
        finally:
            rival.unregister()

    def test_clock_is_repeated_at_ten_hertz_while_paused(self):
        self.step(3)
        self.assertTrue(wait_until(lambda: rospy.get_rostime().to_nsec() == stamp_of(3)))
        self.clock.clear()
        begin = rospy.get_rostime()
        self.assertTrue(wait_until(lambda: len(self.clock.messages) >= 10, 1.5))
        self.assertEqual({m.clock.to_nsec() for m in self.clock.messages}, {stamp_of(3)})
        self.assertEqual(rospy.get_rostime(), begin)

    def test_applied_input_is_what_was_sent(self):
        scope, suturing_device = (0.05, 0.1, -0.2, 0.3), (0.004, 0.5, 0.002)
        self.command(scope, suturing_device, pressed=(2, 5))
        used = self.recorders["applied_input"].messages[-1]
        self.assertEqual(used.joints, scope + suturing_device)
        self.assertEqual(list(used.buttons), [0, 0, 1, 0, 0, 1])

    def test_future_inputs_wait_for_their_step(self):
        self.command((0.01, 0, 0, 0))
        due = self.last_step + 20
        self.scope.publish(joints(SCOPE_JOINTS, (0.02, 0, 0, 0), rospy.Time(nsecs=stamp_of(due))))
        rospy.rostime.wallsleep(0.3)
        self.step(30)
        for used in self.recorders["applied_input"].messages[-30:]:
            self.assertEqual(used.joints[0], 0.02 if used.step >= due else 0.01, used.step)

    def test_tip_pose_is_the_kinematics_of_the_joints(self):
        self.command((0.05, 0.4, 0, 0))
        self.step(60)
        pose = self.recorders["scope/measured_cp"].messages[-1].pose
        # a straight scope: the tip is at its insertion, turned about its axis
        self.assertAlmostEqual(pose.position.x, BASE_X + 0.05, delta=1e-9)
        self.assertAlmostEqual(pose.position.y, 0, delta=1e-9)
        self.assertAlmostEqual(pose.position.z, 0, delta=1e-9)
        self.assertAlmostEqual(abs(pose.orientation.x), math.sin(0.2), delta=1e-9)
        self.assertAlmostEqual(abs(pose.orientation.w), math.cos(0.2), delta=1e-9)

    def test_helix_advances_along_the_tip(self):
        self.command((0.02, 0, 0, 0), (0, 0, 0))
        self.step(60)
        before = self.recorders["suturing_device/helix/measured_cp"].messages[-1].pose.position
        self.command((0.02, 0, 0, 0), (0.005, 0, 0))
        self.step(60)
        after = self.recorders["suturing_device/helix/measured_cp"].messages[-1].pose.position
        self.assertAlmostEqual(after.x - before.x, 0.005, delta=1e-9)
        self.assertAlmostEqual(after.y - before.y, 0, delta=1e-9)

    def test_tf_agrees_with_the_published_poses(self):
        self.command((0.05, 0.4, 0.6, -0.2))
        self.step(60)
        arrived = self.now()
        self.tf.clear()  # tests before this one left transforms with later stamps, since a reset sets the time back
        for attempt in range(50):  # robot_state_publisher limits its rate in simulated time
            self.step(6)
            rospy.rostime.wallsleep(0.05)
            if self.tf.can_transform("world", "scope_tip", rospy.Time(0)):
                # what it sent before the tip was there may be all that there is yet
                if self.tf.lookup_transform("world", "scope_tip", rospy.Time(0)).header.stamp.to_nsec() >= arrived:
                    break
        for frame, topic in (("scope_tip", "scope/measured_cp"), ("helix", "suturing_device/helix/measured_cp")):
            with self.subTest(frame=frame):
                transform = self.tf.lookup_transform("world", frame, rospy.Time(0)).transform.translation
                position = self.recorders[topic].messages[-1].pose.position
                for axis in "xyz":
                    self.assertAlmostEqual(getattr(transform, axis), getattr(position, axis), delta=1e-6)
        self.assertTrue(self.tf.can_transform("world", "stomach", rospy.Time(0)))
        self.assertTrue(self.tf.can_transform("world", "scope_camera_optical", rospy.Time(0)))

    def test_wrench_is_zero_in_the_air_and_pushes_back_on_contact(self):
        self.command((0.03, 0, 0, 0))
        self.step(60)
        for message in self.recorders["scope/measured_cf"].messages[-50:]:
            self.assertEqual((message.wrench.force.x, message.wrench.force.y, message.wrench.force.z), (0, 0, 0))
        self.command((0.075, 0, 0, 0))
        self.step(120)
        force = self.recorders["scope/measured_cf"].messages[-1].wrench.force
        self.assertLess(force.x, -0.1)
        self.assertLess(abs(force.y) + abs(force.z), 0.5 * abs(force.x))
        contacts = self.recorders["scope/contacts"].messages[-1].contacts
        total = [sum(getattr(c.force, axis) for c in contacts) for axis in "xyz"]
        size = math.hypot(force.x, force.y, force.z)  # in the frame of the tip
        self.assertAlmostEqual(math.hypot(*total), size, delta=1e-6 * size)
        self.assertTrue(contacts and all(c.link and c.triangle >= 0 for c in contacts))
        self.assertIsNotNone(self.events.waits_for(lambda m: m.kind == ProcedureEvent.CONTACT_BEGIN))

    def test_particles_are_the_rest_shape_at_the_start(self):
        wait_until(lambda: self.topology.messages)
        topology = self.topology.messages[-1]
        rest = numpy.array(topology.rest_positions).reshape(-1, 3)
        self.step(1)
        self.assertTrue(self.reset_service(seed=0, keep_time=False).success)
        cloud = self.recorders["tissue/particles"].waits_for(lambda m: m.header.stamp.to_nsec() == EPOCH)
        points = list(sensor_msgs.point_cloud2.read_points(cloud, ["x", "y", "z", "strain", "id", "revision", "region"]))
        self.assertEqual(len(points), 300)
        self.assertLess(numpy.abs(numpy.array([p[:3] for p in points]) - rest).max(), 1e-8)
        self.assertLess(max(abs(p[3]) for p in points), 1e-6)
        self.assertEqual([p[4] for p in points], list(range(300)))
        self.assertEqual({p[5] for p in points}, {topology.revision})
        self.assertEqual([p[6] for p in points], list(topology.region))

    def test_topology_is_a_closed_surface_with_a_skin(self):
        wait_until(lambda: self.topology.messages)
        topology = self.topology.messages[-1]
        self.assertEqual(topology.name, "balloon")
        self.assertEqual(topology.header.frame_id, "stomach")
        triangles = numpy.array(topology.triangles).reshape(-1, 3)
        self.assertEqual(len(triangles), 2 * 300 - 4)  # Euler's formula for a sphere
        edges = {(a, b) for t in triangles for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
        self.assertTrue(all((b, a) in edges for a, b in edges))
        self.assertEqual(len(topology.render_triangles), 4 * len(topology.triangles))
        offsets = topology.render_offsets
        for v in range(len(offsets) - 1):
            self.assertAlmostEqual(sum(topology.render_weights[offsets[v] : offsets[v + 1]]), 1, delta=1e-5)

    def test_procedure_state_tells_volume_pressure_and_time(self):
        self.step(61)
        state = self.procedure.waits_for(lambda m: m.step >= 60)
        sphere = 4 / 3 * math.pi * 0.05**3
        self.assertAlmostEqual(state.volume, sphere, delta=0.05 * sphere)
        self.assertEqual(state.scene, "balloon")
        self.assertEqual(state.seed, 7)
        self.assertEqual(state.step_period, PERIOD)
        self.assertEqual(state.origin.to_nsec(), EPOCH)
        self.assertEqual(state.header.stamp.to_nsec(), stamp_of(state.step))
        self.assertAlmostEqual(state.time, state.step * PERIOD, delta=1e-9)
        self.assertTrue(state.paused)

    def test_insufflation_raises_volume_and_pressure_to_the_set_point(self):
        self.command((0, 0, 0, 0), pressed=(5,))
        self.step(240)
        event = self.events.waits_for(lambda m: m.kind == ProcedureEvent.PRESSURE_REACHED)
        self.assertIsNotNone(event)
        self.assertAlmostEqual(event.value, 1333, delta=0.02 * 1333)
        states = self.procedure.messages
        self.assertEqual(states[0].tool_state, "insufflation")
        self.assertGreater(states[-1].volume, states[0].volume)

    def test_grab_holds_tissue_and_release_lets_it_go(self):
        self.command((0.075, 0, 0, 0), (0.004, 0, 0))
        self.step(90)
        self.command((0.075, 0, 0, 0), (0.004, 0, 0), pressed=(1,))
        grab = self.events.waits_for(lambda m: m.kind == ProcedureEvent.GRAB)
        self.assertIsNotNone(grab)
        self.assertGreaterEqual(grab.value, 1)
        held = self.procedure.waits_for(lambda m: m.held_particles > 0)
        self.assertEqual(held.tool_state, "grip")
        self.assertEqual(held.held_particles, grab.value)
        self.command((0.075, 0, 0, 0), (0.004, 0, 0))
        release = self.events.waits_for(lambda m: m.kind == ProcedureEvent.RELEASE)
        self.assertIsNotNone(release)
        self.assertGreater(release.header.stamp, grab.header.stamp)
        last = self.skill.waits_for(lambda m: m.releases == 1)
        self.assertIsNotNone(last)
        self.assertEqual((last.grabs, last.header.stamp), (1, release.header.stamp))
        self.assertGreater(last.max_force, 0)
        state = self.procedure.waits_for(lambda m: m.header.stamp == release.header.stamp)
        self.assertEqual(state.held_particles, 0)

    def test_skill_metrics_are_latched_and_come_with_the_state(self):
        self.step(150)
        state = self.procedure.waits_for(lambda m: m.step == 150)  # once per second, and after the last step
        self.assertIsNotNone(state)
        self.assertIsNotNone(self.skill.waits_for(lambda m: m.header.stamp == state.header.stamp))
        # the one of the reset may come late
        self.assertEqual(set(self.skill.stamps()) - {EPOCH}, set(self.procedure.stamps()) - {EPOCH})
        self.assertEqual(len(set(self.skill.stamps()) - {EPOCH}), 3)
        late = Recorder("procedure/skill_metrics", SkillMetrics)
        message = late.waits_for()
        self.assertIsNotNone(message, "latched")
        self.assertEqual(message.header.stamp, state.header.stamp)
        self.assertAlmostEqual(message.time, message.phase_time[0], delta=1e-9)  # all of it inspection
        self.assertEqual((message.grabs, message.rejected, message.organ_reference), (0, 0, "rest"))
        self.assertTrue(math.isnan(message.bite_depth_mean))
        late.subscriber.unregister()

    def test_sutures_are_latched_and_empty_at_the_start(self):
        self.step(1)
        self.assertTrue(self.reset_service(seed=0, keep_time=False).success)
        late = Recorder("sutures", SutureArray)
        message = late.waits_for(lambda m: m.header.stamp.to_nsec() == EPOCH)
        self.assertIsNotNone(message)
        self.assertEqual(message.header.frame_id, "world")
        self.assertEqual((len(message.sutures), len(message.bleedings), message.blood_lost), (0, 0, 0))
        self.step(120)  # nothing to tell, nothing sent
        self.assertEqual(len(late.messages), 1)
        late.subscriber.unregister()

    def test_a_hand_pulls_the_tissue_feels_it_and_lets_go_when_it_falls_silent(self):
        topology = self.topology.waits_for()
        places = numpy.reshape(topology.rest_positions, (-1, 3))
        message = TissuePull(particle=int(numpy.argmax(places[:, 0])))  # far from where the scope enters
        place = Point(*places[message.particle])
        message.header.frame_id = "stomach"
        message.target = Point(place.x + 0.01, place.y, place.z)
        self.pull_state.clear()
        self.pull.publish(message)
        rospy.rostime.wallsleep(0.3)
        self.step(29)
        first = self.recorders["applied_input"].messages[-29].step
        wait_until(lambda: len(self.pull_state.messages) == 29)
        self.assertEqual(self.pull_state.stamps(), [stamp_of(first + 1 + k) for k in range(29)])
        used = self.recorders["applied_input"].messages[-1]
        self.assertEqual((used.pull_particle, used.pull_target), (message.particle, message.target))
        held = self.pull_state.messages[-1]
        self.assertEqual((held.header.frame_id, held.particle), ("world", message.particle))
        self.assertGreater(held.force.x, 0.1)
        self.assertGreater(held.position.x, place.x)
        for axis in "xyz":
            self.assertAlmostEqual(getattr(held.target, axis), getattr(message.target, axis), delta=1e-9)
            stretch = getattr(held.target, axis) - getattr(held.position, axis)
            self.assertAlmostEqual(getattr(held.force, axis), 300 * stretch, delta=2e-3)  # the mean over a step
        self.events.clear()
        self.step(120)
        self.assertIsNotNone(self.events.waits_for(lambda m: "tissue/pull has been silent" in m.text))
        self.assertEqual(self.recorders["applied_input"].messages[-1].pull_particle, -1)
        wait_until(lambda: self.pull_state.messages[-1].particle == -1)
        self.assertEqual([m.particle for m in self.pull_state.messages].count(-1), 1)
        self.assertEqual(self.pull_state.messages[-1].force.x, 0)

    def test_a_cinch_without_a_thread_is_rejected_with_a_reason(self):
        self.command((0, 0, 0, 0), pressed=())
        self.command((0, 0, 0, 0), pressed=(4,))
        rejected = self.events.waits_for(lambda m: m.kind == ProcedureEvent.REJECTED)
        self.assertIsNotNone(rejected)
        self.assertEqual(rejected.value, 4)
        self.assertEqual(rejected.text, "There is no thread to cinch: take bites and drop the T-tag first.")
        self.assertIsNotNone(self.skill.waits_for(lambda m: m.rejected == 1))
        state = self.procedure.waits_for(lambda m: m.header.stamp == rejected.header.stamp)
        self.assertIsNotNone(state)
        self.assertEqual((state.phase, state.sutures, state.bites), ("inspect", 0, 0))
        self.assertTrue(state.needle_loaded and state.needle_on_arm)

    def test_performance_is_reported_once_a_second(self):
        self.performance.clear()
        self.assertTrue(wait_until(lambda: len(self.performance.messages) >= 2, 4))
        self.step(30)
        self.performance.clear()
        message = self.performance.waits_for(lambda m: True, 3)
        parts = ("loads", "factor", "energy", "inverse", "rows", "paths", "walls", "other")
        expected = ["solver", "solver_wall", "publish", "total"] + ["solver_" + part for part in parts]
        self.assertEqual([s.name for s in message.stages], expected)
        self.assertEqual(message.particle_count, 300)
        self.assertEqual(message.active_count, 300)
        self.assertEqual(message.missed_deadlines, 0)
        self.assertEqual(message.unfinished_steps, 0)
        self.assertLess(message.residual, 1e-3)
        self.assertGreater(message.window, 0.9)
        self.assertLess(message.window, 3)
        self.assertEqual(len(message.state_hash), 16)
        int(message.state_hash, 16)
        for stage in message.stages:
            self.assertLessEqual(stage.p50, stage.p99)
            self.assertLessEqual(stage.p99, stage.max)


if __name__ == "__main__":
    rospy.init_node("topics_test")
    rostest.rosrun("vibe_sim", "topics_test", TopicsTest, sys.argv)
