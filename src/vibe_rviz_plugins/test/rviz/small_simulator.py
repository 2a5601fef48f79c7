"""What the tool 'Drive scope' needs of a simulator: time, a state, and joints that follow the commands as fast as they
may."""

import threading
import time

import rospy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from vibe_msgs.msg import ProcedureState

SCOPE = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
SUTURING_DEVICE = ["helix_advance", "helix_rotation", "needle_driver"]
SPEEDS = dict(zip(SCOPE + SUTURING_DEVICE, [0.15, 3.1, 3.1, 3.1, 0.1, 25.0, 0.1]))  # greatest ones, as in the URDF [1/s]
START = dict(zip(SCOPE + SUTURING_DEVICE, [0.1, 0.5, 0.3, -0.2, 0.01, 2.0, 0.005]))
PERIOD = 1.0 / 60  # of a step [s]
STATE_INTERVAL = 0.5  # of wall time [s]


class SmallSimulator:
    """Takes a step every PERIOD in a thread of its own."""

    def __init__(self):
        self.joints, self.command = dict(START), {}
        self.now, self.step = 1.0, 0
        self.runs = self.clock_runs = self.publishes = True
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.states = rospy.Publisher("/procedure/state", ProcedureState, queue_size=10, latch=True)
        self.positions = rospy.Publisher("/joint_states", JointState, queue_size=10)
        self.subscribers = [
            rospy.Subscriber("/scope/servo_jp", JointState, self.take, queue_size=100),
            rospy.Subscriber("/scope/input/joint_states", JointState, self.take, queue_size=100),
            rospy.Subscriber("/suturing_device/input/joint_states", JointState, self.take, queue_size=100),
        ]
        self.last_state = 0.0
        self.ends = threading.Event()
        self.thread = threading.Thread(target=self.spin)

    def start(self):
        self.thread.start()

    def stop(self):
        self.ends.set()
        self.thread.join()

    def take(self, message):
        if self.runs:
            self.command.update(zip(message.name, message.position))

    def follow(self):
        for name, goal in list(self.command.items()):
            way = SPEEDS[name] * PERIOD
            self.joints[name] += min(max(goal - self.joints[name], -way), way)

    def spin(self):
        while not self.ends.wait(PERIOD):
            if self.clock_runs:
                self.now += PERIOD
            stamp = rospy.Time.from_sec(self.now)
            if self.publishes and self.runs and self.clock_runs:
                self.step += 1
                self.follow()
                message = JointState(name=list(self.joints), position=list(self.joints.values()))
                message.header.stamp = stamp
                self.positions.publish(message)
            if self.publishes and time.monotonic() - self.last_state > STATE_INTERVAL:
                self.tell_state()
            self.clock.publish(Clock(stamp))

    def tell_state(self):
        state = ProcedureState(scene="small", step=self.step, step_period=PERIOD, time=self.step * PERIOD)
        state.header.stamp = rospy.Time.from_sec(self.now)
        state.paused = not self.runs
        state.needle_loaded = state.needle_on_arm = True
        self.states.publish(state)
        self.last_state = time.monotonic()

    def set_running(self, on):
        self.runs = on
        self.tell_state()

    def reset(self):
        self.joints, self.command, self.step = dict(START), {}, 0
        self.tell_state()
