"""Peers that do not speak the protocol of ROS: the simulator steps on, answers, and keeps nothing of them."""

import socket
import struct
import time
import xmlrpc.client

from sensor_msgs.msg import JointState
from vibe_msgs.msg import StepInput
from vibe_testing.wait import wait_until

from .fault_bench import Flow, Row, expect, pace
from .fault_peers import POSITION, Flood, RawPublisher, Victim, connect, encode_header, message_of, receive_header

WINDOW = 1.5  # [s]
LEAST_PACE = 0.9  # of real time, while the peers are there
MOST_MEMORY = 30.0  # resident [MB]
MOST_ADDRESSES = 4096.0  # reserved: roscpp makes room for what a length announces, up to 1 GB for each of 4 peers [MB]
KEPT = 3  # connections that the threads of the master keep to a node that they have told of a publisher
ENDLESS = 16  # of an XML-RPC header that does not end: libxmlrpcpp keeps all of it [MB]
MOST_PING = 2.0  # [s]
RETURN = 5.0  # until the descriptors are closed after the peers are gone [s]
HUGE = 0xFFFFFFFF  # of a length [bytes]
BELOW_LIMIT = 999_999_999  # roscpp takes lengths up to 1e9 for possible [bytes]
IDLE = 200  # connections
TOPIC = "/step_result"


class Peers:
    """The simulator alone. Each attack returns what holds it open and what the peers were told."""

    def __init__(self, bench):
        self.bench = bench
        self.uri = bench.graph.env["ROS_MASTER_URI"]

    def prepare(self):
        self.bench.graph.start_master()
        self.bench.observe()
        self.steps = Flow("applied_input", StepInput, True)
        self.bench.start_simulator()
        expect(self.steps.wait(time.monotonic()), "the simulator does not run")
        self.victim = Victim(self.uri, "/sim_node")
        self.address = self.victim.tcpros(TOPIC)
        time.sleep(1)
        self.descriptors = self.bench.descriptors("sim_node")  # to which their number returns after all attacks

    def faults(self):
        attacks = (
            ("random bytes at its TCPROS port", self.random_bytes),
            ("a header of 4 GB", self.lengths(HUGE)),
            ("a header of 999,999,999 bytes that does not come", self.lengths(BELOW_LIMIT)),
            ("headers that ask for the wrong thing", self.wrong_headers),
            ("half a header, then silence", self.half_header),
            ("200 idle connections", self.idle),
            ("garbage at its XML-RPC port", self.garbage_calls),
            ("an XML-RPC header without an end", self.endless_call),
            ("a publisher that announces messages of 4 GB", self.lying_publisher(HUGE)),
            ("a publisher that announces messages of 999,999,999 bytes", self.lying_publisher(BELOW_LIMIT)),
            ("publishers that answer with garbage", self.garbage_publisher),
        )
        return [(name, lambda name=name, attack=attack: self.endure(name, attack)) for name, attack in attacks]

    def endure(self, name, attack):
        bench, lasting = self.bench, []
        self.victim.ping()  # its connection stays open
        memory, reserved = bench.memory("sim_node"), bench.memory("sim_node", "VmSize")
        mark, begin = bench.mark("sim_node"), time.monotonic()
        try:
            held, told = attack(lasting)
            speed = pace(self.steps, WINDOW)
            ping = self.victim.ping()
            # but for that of the ping; not since this attack began: what is left of the one before may close meanwhile
            open_now = bench.descriptors("sim_node") - self.descriptors - 1
            grown, reserved = bench.memory("sim_node") - memory, bench.memory("sim_node", "VmSize") - reserved
        finally:
            for each in lasting:
                each.close()
        closed = time.monotonic()
        returned = wait_until(lambda: bench.descriptors("sim_node") <= self.descriptors + KEPT, RETURN)
        seconds = time.monotonic() - closed
        figures = "pace {:.2f}, ping {:.0f} ms, {} descriptors, resident {:+.1f} MB, reserved {:+.0f} MB".format(
            speed, 1e3 * ping, open_now, grown, reserved)
        said = [line for line in bench.said("sim_node", mark)]
        print("{}: {}; {} lines in the log: {}".format(name, figures, len(said), set(said)))
        bench.check_alive()
        expect(self.steps.gap(begin, closed) < 1, "the simulator stood still for {:.2f} s".format(
            self.steps.gap(begin, closed)))
        expect(speed > LEAST_PACE, figures)
        expect(ping < MOST_PING, figures)
        expect(open_now >= held - 1, "{} connections, {} wanted: the peers are not there".format(open_now, held))
        expect(returned, "{} descriptors are left open".format(bench.descriptors("sim_node") - self.descriptors))
        expect(grown < MOST_MEMORY and reserved < MOST_ADDRESSES, figures)
        return [Row(name, "nothing; " + figures, seconds, told or (said[0] if said else "nothing"))]

    def random_bytes(self, lasting):
        import random

        source = random.Random(1)
        lasting += [connect(self.address, source.randbytes(4096)) for _ in range(20)]
        return 0, ""

    def lengths(self, length):
        def attack(lasting):
            lasting += [connect(self.address, struct.pack("<I", length) + b"x" * 100_000) for _ in range(4)]
            return 0, ""

        return attack

    def wrong_headers(self, lasting):
        good = dict(callerid="/peer", topic=TOPIC, type="vibe_msgs/StepResult", md5sum="*")
        cases = (
            ({"md5sum": None}, "md5sum"),
            ({"md5sum": "0" * 32}, "md5sum"),
            ({"topic": "/no_such_topic"}, "topic"),
            ({"topic": None}, "topic"),
        )
        answers = []
        for change, word in cases:
            fields = {key: value for key, value in {**good, **change}.items() if value is not None}
            connection = connect(self.address, encode_header(**fields))
            lasting.append(connection)
            try:
                answer = receive_header(connection)
            except TimeoutError:
                answer = None  # neither topic nor service: roscpp says nothing and waits
            error = "" if answer is None else answer.get("error", "")
            print("{} -> {}".format(change, answer))
            expect(answer is None or word in error, "{} was answered with {}".format(change, answer))
            answers.append(error)
        lasting.append(connect(self.address, encode_header(**good)))  # the control: a good one is served
        answer = receive_header(lasting[-1])
        expect(answer is not None and "error" not in answer, "a good header was answered with {}".format(answer))
        return 1, "to the peer: \"{}\"".format(next((text for text in answers if text), "connection closed"))

    def half_header(self, lasting):
        header = encode_header(callerid="/peer", topic=TOPIC, type="*", md5sum="*")
        lasting += [connect(self.address, header[:20]) for _ in range(10)]
        return 10, ""

    def idle(self, lasting):
        lasting += [connect(self.address) for _ in range(IDLE)]
        return IDLE, ""

    def garbage_calls(self, lasting):
        address = self.victim.slave_address
        deep = b"<?xml version='1.0'?><methodCall><methodName>getPid</methodName><params>"
        deep += b"<param><value><array><data>" * 2000
        calls = (
            b"\x00\xff\x17 garbage \r\n\r\n" * 50,
            b"GET / HTTP/1.1\r\n\r\n",
            b"POST /RPC2 HTTP/1.1\r\nContent-Length: 4000000000\r\n\r\n<",
            b"POST /RPC2 HTTP/1.1\r\nContent-Length: -1\r\n\r\n<",
            b"POST /RPC2 HTTP/1.1\r\nContent-Length: word\r\n\r\n<",
            b"POST /RPC2 HTTP/1.1\r\nContent-Length: " + str(len(deep)).encode() + b"\r\n\r\n" + deep,
            b"POST /RPC2 HTTP/1.1\r\nContent-Le",
        )
        lasting += [connect(address, call) for call in calls]
        wrong = xmlrpc.client.ServerProxy(self.victim.uri)
        for name, arguments in (("publisherUpdate", ("/x", TOPIC)), ("publisherUpdate", (1, 2, 3)), ("noSuch", ()),
                                ("requestTopic", ("/x", 5, "y")), ("paramUpdate", ("/x", 1))):  # fmt: skip
            try:
                print(name, arguments, "->", getattr(wrong, name)(*arguments))
            except (xmlrpc.client.Error, OSError) as error:
                print(name, arguments, "->", type(error).__name__, str(error)[:100])
        return 0, ""

    def endless_call(self, lasting):
        connection = socket.create_connection(self.victim.slave_address, 2)
        lasting.append(connection)
        try:
            for _ in range(ENDLESS):
                connection.sendall(b"x" * 1_000_000)
        except OSError as error:
            print("the peer was cut off: {}".format(error))
        return 0, ""

    def lying_publisher(self, length):
        def attack(lasting):
            lie = struct.pack("<I", length) + b"x" * 100_000
            lasting.append(RawPublisher(self.uri, "/liar", "/scope/servo_jp", JointState, lambda c: c.sendall(lie)))
            expect(wait_until(lambda: lasting[-1].connections, 5), "the simulator does not connect")
            return 0, ""

        return attack

    def garbage_publisher(self, lasting):
        answers = (b"\xff" * 64, encode_header(callerid="/liar", md5sum="0" * 32, type="x/Y"), b"\x20\x00\x00\x00half",
                   encode_header(error="no"), encode_header())  # fmt: skip
        for k, answer in enumerate(answers):
            lasting.append(RawPublisher(self.uri, "/liar{}".format(k), "/scope/servo_jp", JointState,
                                        lambda c: time.sleep(60), answer))
            expect(wait_until(lambda: lasting[-1].connections, 5), "the simulator does not connect")
        begin = time.monotonic()
        good = Flood(message_of("valid"), 100)
        lasting.append(RawPublisher(self.uri, "/good", "/scope/servo_jp", JointState, good.serve))
        heard = self.steps.wait(begin, lambda m: m.joints[0] == POSITION, 5)
        expect(heard is not None, "a good publisher beside them is not heard")
        return 0, ""
