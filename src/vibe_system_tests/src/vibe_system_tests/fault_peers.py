"""Peers of a node that speak TCPROS and XML-RPC by themselves, so that they can speak it wrongly.

As a program: publishes ready-made messages at a rate that rospy does not reach.
"""

import argparse
import math
import os
import signal
import socket
import struct
import sys
import threading
import time
import xmlrpc.client
import xmlrpc.server
from io import BytesIO

from sensor_msgs.msg import JointState

SCOPE_JOINTS = ["insertion", "rotation", "tip_up_down", "tip_left_right"]
SUTURING_DEVICE_JOINTS = ["helix_advance", "helix_rotation", "needle_driver"]
BATCH = 0.01  # between two bursts of a flood [s]
POSITION = 0.0101  # of the first joint in the messages of a flood [m]
TIMEOUT = 3.0  # for an answer [s]


def encode_header(**fields):
    """A TCPROS header with its length in front."""
    body = b""
    for key, value in fields.items():
        field = "{}={}".format(key, value).encode()
        body += struct.pack("<I", len(field)) + field
    return struct.pack("<I", len(body)) + body


def decode_header(body):
    fields = {}
    while len(body) >= 4:
        (size,) = struct.unpack_from("<I", body)
        key, _, value = body[4 : 4 + size].partition(b"=")
        fields[key.decode(errors="replace")] = value.decode(errors="replace")
        body = body[4 + size :]
    return fields


def receive(connection, size):
    """So many bytes; fewer if the peer has closed."""
    data = b""
    while len(data) < size:
        piece = connection.recv(size - len(data))
        if not piece:
            break
        data += piece
    return data


def receive_header(connection):
    """The fields of a header, or None if the peer has closed instead."""
    size = receive(connection, 4)
    return decode_header(receive(connection, struct.unpack("<I", size)[0])) if len(size) == 4 else None


class Timed(xmlrpc.client.Transport):
    """A node that does not answer is a node that has failed."""

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = TIMEOUT
        return connection


class Victim:
    """The ports of a node."""

    def __init__(self, master_uri, name):
        code, _, uri = xmlrpc.client.ServerProxy(master_uri).lookupNode("/peer", name)
        if code != 1:
            raise OSError("the master does not know " + name)
        self.uri = uri
        self.slave = xmlrpc.client.ServerProxy(uri, transport=Timed())
        host, port = uri.split("//")[1].strip("/").split(":")
        self.slave_address = host, int(port)

    def ping(self):
        """As rosnode ping does it. How long the answer took [s]."""
        begin = time.monotonic()
        code, _, _ = self.slave.getPid("/peer")
        assert code == 1
        return time.monotonic() - begin

    def tcpros(self, topic):
        """Address of its TCPROS server."""
        code, message, (_, host, port) = self.slave.requestTopic("/peer", topic, [["TCPROS"]])
        assert code == 1, message
        return host, port


def connect(address, data=b""):
    """A connection to an address, with something said already."""
    connection = socket.create_connection(address, TIMEOUT)
    try:
        connection.sendall(data)
    except OSError:
        pass  # it has hung up already
    return connection


def subscribe(victim, topic, buffer):
    """A connection that a node sends a topic to; nobody reads it. `buffer` is that of the kernel for it [bytes]."""
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
    connection.settimeout(TIMEOUT)
    connection.connect(victim.tcpros(topic))
    connection.sendall(encode_header(callerid="/listener", topic=topic, type="*", md5sum="*", tcp_nodelay=1))
    answer = receive_header(connection)
    if answer is None or "error" in answer:
        raise OSError("{} is not served: {}".format(topic, answer))
    return connection


class Listener:
    """Takes what a node publishes on a topic and throws it away, but counts the bytes."""

    def __init__(self, victim, topic):
        self.topic, self.bytes = topic, 0
        self.connection = subscribe(victim, topic, 1 << 20)
        self.connection.settimeout(None)
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        try:
            while data := self.connection.recv(1 << 20):
                self.bytes += len(data)
        except OSError:
            pass  # closed


class RawPublisher:
    """A publisher of one topic that does with its subscribers whatever `serve(connection)` does, each in a thread. It
    may be one that answers their header with another one than it should: `answer`."""

    def __init__(self, master_uri, name, topic, kind, serve, answer=None):
        self.serve = serve
        self.answer = encode_header(callerid=name, md5sum=kind._md5sum, type=kind._type, latching=0)
        if answer is not None:
            self.answer = answer
        self.name, self.topic = name, topic
        self.connections = []
        self.listener = socket.create_server(("localhost", 0))
        self.slave = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False, allow_none=True)
        self.slave.register_function(self.request_topic, "requestTopic")
        self.slave.register_function(lambda *_: [1, "", os.getpid()], "getPid")
        self.slave.register_function(lambda *_: [1, "", 0], "publisherUpdate")
        threading.Thread(target=self.slave.serve_forever, daemon=True).start()
        threading.Thread(target=self.accept, daemon=True).start()
        self.uri = "http://localhost:{}/".format(self.slave.server_address[1])
        self.master = xmlrpc.client.ServerProxy(master_uri)
        self.master.registerPublisher(name, topic, kind._type, self.uri)

    def request_topic(self, *_):
        return [1, "", ["TCPROS", "localhost", self.listener.getsockname()[1]]]

    def accept(self):
        while True:
            try:
                connection = self.listener.accept()[0]
            except OSError:
                return
            self.connections.append(connection)
            threading.Thread(target=self.talk, args=(connection,), daemon=True).start()

    def talk(self, connection):
        try:
            receive_header(connection)
            connection.sendall(self.answer)
            self.serve(connection)
        except OSError:
            pass  # the subscriber has hung up

    def close(self):
        self.master.unregisterPublisher(self.name, self.topic, self.uri)
        self.listener.close()
        for connection in self.connections:
            connection.close()
        self.slave.shutdown()
        self.slave.server_close()


def serialized(message):
    buffer = BytesIO()
    message.serialize(buffer)
    body = buffer.getvalue()
    return struct.pack("<I", len(body)) + body


def message_of(kind, joints=SCOPE_JOINTS):
    """What a flood sends: positions that are right, one that is wrong, or bytes that are no message."""
    message = JointState(name=joints, position=[math.nan if kind == "invalid" else POSITION] + [0] * (len(joints) - 1))
    data = bytearray(serialized(message))
    if kind == "garbage":
        data[16:20] = b"\xff\xff\xff\xff"  # length of frame_id
    return data


class Flood:
    """Sends copies of a message, each with a stamp of its own, at a rate [Hz]."""

    STAMP_AT = 8  # behind the length of the message and the sequence number

    def __init__(self, message, rate, ahead=0.0):
        self.message, self.ahead = message, ahead
        self.count = max(1, round(rate * BATCH))
        self.period = self.count / rate
        self.burst = bytearray(self.message * self.count)
        self.sent = 0

    def serve(self, connection):
        due = time.monotonic()
        while True:
            now = time.time_ns() + round(1e9 * self.ahead)
            for k in range(self.count):
                seconds, rest = divmod(now + k, 10**9)
                struct.pack_into("<II", self.burst, k * len(self.message) + self.STAMP_AT, seconds, rest)
            connection.sendall(self.burst)
            self.sent += self.count
            due = max(due + self.period, time.monotonic() - 10 * self.period)
            time.sleep(max(0.0, due - time.monotonic()))


def main():
    parser = argparse.ArgumentParser(allow_abbrev=False, description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--name", required=True)
    parser.add_argument("--topic", required=True)
    parser.add_argument("--kind", choices=("valid", "invalid", "garbage"), default="valid")
    parser.add_argument("--rate", type=float, default=10000.0, help="[Hz]")
    parser.add_argument("--ahead", type=float, default=0.0, help="by which its clock is fast [s]")
    arguments = parser.parse_args()
    joints = SUTURING_DEVICE_JOINTS if "suturing_device" in arguments.topic else SCOPE_JOINTS
    flood = Flood(message_of(arguments.kind, joints), arguments.rate, arguments.ahead)
    uri = os.environ["ROS_MASTER_URI"]
    publisher = RawPublisher(uri, arguments.name, arguments.topic, JointState, flood.serve)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    begin = time.monotonic()
    try:
        while True:
            time.sleep(0.5)
            print("{:.2f} {}".format(time.monotonic() - begin, flood.sent), flush=True)
    except KeyboardInterrupt:
        publisher.close()


if __name__ == "__main__":
    sys.exit(main())
