#!/usr/bin/env python3
"""Pages and other clients at the server of a running simulator: what the scripts in page/test find, as tests. They run in
Node and Chromium, and are skipped by name where those, or the page, are missing."""

import http.client
import json
import os
import re
import shutil
import socket
import ssl
import subprocess
import tempfile
import unittest
import urllib.request

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState, Joy
from vibe_msgs.msg import ReplayCommand
from vibe_testing.program import Program, find_program
from vibe_testing.recorder import Recorder
from vibe_testing.wait import wait_until

NGINX = shutil.which("nginx")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
NODE = shutil.which("node")
SIMULATOR = "stomach.yaml"
ADDRESS = r"https?://(?:\[[^]]*\]|[^:/]+):(\d+)"
UPGRADE = {
    "Connection": "Upgrade",
    "Upgrade": "websocket",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
}
# around the lines of docs/web.md
NGINX_CONFIGURATION = """
daemon off; pid {folder}/pid; error_log {folder}/errors; events {{}}
http {{
  access_log off; client_body_temp_path {folder}/b; proxy_temp_path {folder}/p; fastcgi_temp_path {folder}/f;
  uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;
  server {{
    listen 127.0.0.1:{port} ssl; ssl_certificate {certificates}/certificate.pem; ssl_certificate_key {certificates}/key.pem;
    {location}
  }}
}}"""


def page_work():
    """Where the page was built, with the modules that its tests need; empty: it was left out."""
    path = os.path.join(os.path.dirname(find_program("vibe_web", "web_node")), "../../share/vibe_web/page.work")
    if not os.path.exists(path):
        return ""
    with open(path, encoding="utf-8") as file:
        return file.read().strip()


def port_of(server):
    """Of the address that it prints."""
    wait_until(lambda: re.search(ADDRESS, server.output()))
    found = re.search(ADDRESS, server.output())
    return int(found.group(1)) if found else 0


def token_of(server):
    return re.search(r"#token=([0-9a-f]{32})", server.output()).group(1)


def status(port, target, kind=http.client.HTTPSConnection, origin="", **options):
    """What a server on this machine answers to a request for a stream."""
    connection = kind("localhost", port, timeout=20, **options)
    try:
        connection.request("GET", target, headers={**UPGRADE, **({"Origin": origin} if origin else {})})
        return connection.getresponse().status
    finally:
        connection.close()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Web(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = os.environ.get("VIBE_WEB_PICTURES") or tempfile.mkdtemp()
        os.makedirs(cls.folder, exist_ok=True)
        cls.work = page_work()
        cls.simulator = Program(
            "vibe_sim", "sim_node", name="sim_node", scene="package://vibe_core/scenes/" + SIMULATOR, time_source="wall"
        )
        cls.server = Program("vibe_web", "web_node", name="web_node", port=0)
        cls.port = port_of(cls.server)
        cls.commands = Recorder("/replay/command", ReplayCommand)  # as the recorder of a session listens to all topics
        cls.setpoint = Recorder("/scope/setpoint_js", JointState)
        cls.setpoint.waits_for()

    @classmethod
    def tearDownClass(cls):
        cls.status = cls.server.stop()
        cls.simulator.stop()
        if "VIBE_WEB_PICTURES" not in os.environ:
            shutil.rmtree(cls.folder)

    def run_script(self, script, *arguments):
        """@return what the checks of a script found, by name"""
        if not NODE or not self.work:
            self.skipTest("the page has not been built: it needs nodejs and npm")
        run = subprocess.run(
            [NODE, os.path.join(self.work, "test", script), *map(str, arguments)],
            cwd=self.work,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=700,
        )
        checks = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
        print(run.stdout)
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertTrue(checks, run.stdout)
        failed = ["{name}: {problem}".format(**check) for check in checks if not check["ok"]]
        self.assertFalse(failed, "\n".join([*failed, self.server.last_words()]))
        return {check["name"]: check.get("detail") for check in checks}

    def run_in_chromium(self, script, *arguments):
        if not CHROMIUM:
            self.skipTest("Chromium is not installed")
        return self.run_script(script, *arguments)

    def test_0_hands(self):
        self.run_script("hands.mjs", 10000)

    def test_1_stream(self):
        self.run_script("stream.mjs", self.port)
        self.assertTrue(self.server.is_running(), self.server.last_words())

    def test_2_browser(self):
        found = self.run_in_chromium("browser.mjs", self.port, CHROMIUM, self.folder)
        for name in ("a key drives", "a gamepad drives"):
            shown = found[name]["joints"][:4]
            nearest = min(max(abs(a - b) for a, b in zip(m.position, shown)) for m in self.setpoint.messages)
            self.assertLess(nearest, 1e-6, name + ": the simulator's joints never were where the page says")
        self.assertTrue(self.server.is_running(), self.server.last_words())

    def test_3_lan_needs_token_and_tls(self):
        with tempfile.TemporaryDirectory() as folder:
            server = Program("vibe_web", "web_node", "--lan", name="web_node_lan", port=0, certificates=folder)
            self.addCleanup(server.stop)
            port = port_of(server)
            token = token_of(server)
            context = ssl.create_default_context(cafile=folder + "/root.pem")
            self.assertEqual(status(port, "/stream", context=context), 403)
            self.assertEqual(status(port, "/stream?token=" + "0" * 32, context=context), 403)
            self.assertEqual(status(port, "/stream?token=" + token, context=context), 101)
            with self.assertRaises(ssl.SSLError):  # signed by nobody that a machine knows
                status(port, "/stream?token=" + token, context=ssl.create_default_context())
            plain = http.client.HTTPConnection("localhost", port, timeout=20)
            plain.request("GET", "/a?b")
            answer = plain.getresponse()
            self.assertEqual((answer.status, answer.headers["Location"]), (307, "https://localhost:{}/a?b".format(port)))
            with urllib.request.urlopen("https://localhost:{}/root.crt".format(port), context=context) as answer:
                self.assertEqual(answer.headers["Content-Type"], "application/x-x509-ca-cert")
                root = ssl.DER_cert_to_PEM_cert(answer.read())
            with open(folder + "/root.pem", encoding="ascii") as file:
                self.assertEqual(file.read(), root)
            self.run_in_chromium("elsewhere.mjs", "lan", port, CHROMIUM, token)
            self.assertEqual(server.stop(), 0)

    def test_4_wrong_options_are_refused(self):
        wrong = (["--wan"], {}), ([], {"port": 70000}), ([], {"lann": True}), ([], {"behind": "lab.example/vibe"})
        for arguments, parameters in wrong:
            server = Program("vibe_web", "web_node", *arguments, name="web_node_wrong", **parameters)
            self.assertEqual(server.ends(), 2, server.output())
            self.assertEqual(len([line for line in server.lines if line.startswith("web_node:")]), 1, server.output())

    def test_5_a_recording_has_its_line(self):
        bag = os.path.join(self.folder, "session.bag")
        recorder = Program("vibe_sim", "vibe_record", bag, name="vibe_record")
        self.assertTrue(wait_until(lambda: os.path.exists(bag + ".active")))
        rospy.rostime.wallsleep(6)
        self.assertEqual(recorder.stop(), 0)
        rospy.set_param("/use_sim_time", True)  # of nodes that start from now on
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        names = ["__ns:=replayed", "/clock:=/replayed/clock", "robot_description:=/robot_description"]
        player = Program("vibe_sim", "vibe_player", *names, name="vibe_player", recording=bag)
        self.addCleanup(player.stop)
        server = Program("vibe_web", "web_node", *names, name="web_replayed", port=0)
        self.addCleanup(server.stop)
        self.run_in_chromium("elsewhere.mjs", "recording", port_of(server), CHROMIUM, self.folder, player.process.pid)

    def test_6_parts_of_the_same_name_are_told_apart(self):
        link = '<link name="{1}"><visual><geometry><mesh filename="file://{0}/{1}/part.obj"/></geometry></visual></link>'
        joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
        for name in "ab":
            os.mkdir(os.path.join(self.folder, name))
            with open(os.path.join(self.folder, name, "part.obj"), "w", encoding="utf-8") as file:
                file.write("# {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".format(name))
        links = link.format(self.folder, "a") + link.format(self.folder, "b")
        server = Program("vibe_web", "web_node", "__ns:=other", name="web_other", port=0)
        self.addCleanup(server.stop)
        port = port_of(server)

        def part(number):
            connection = http.client.HTTPConnection("localhost", port, timeout=20)
            connection.request("GET", "/mesh/{}/part.obj".format(number))
            try:
                return connection.getresponse().read().decode()
            finally:
                connection.close()

        self.assertFalse(part(0).startswith("#"))  # the description comes later than the server
        rospy.set_param("/other/robot_description", '<robot name="r">' + links + joint + "</robot>")
        for number, name in enumerate("ab"):
            self.assertTrue(wait_until(lambda: part(number).startswith("# " + name)), part(number))
        self.run_in_chromium("elsewhere.mjs", "nothing", port, CHROMIUM)

    def test_7_presses_end(self):
        self.run_in_chromium("presses.mjs", self.port, CHROMIUM, 60)

    def test_8_the_page_says_what_is_wrong(self):
        self.run_in_chromium("truth.mjs", self.port, CHROMIUM, self.simulator.process.pid, self.server.process.pid)

    def test_7_headset(self):
        seen = {name: Recorder("/viewer/" + name, PoseStamped) for name in ("head", "left_hand", "right_hand")}
        buttons = Recorder("/viewer/buttons", Joy)
        self.run_in_chromium("room.mjs", self.port, CHROMIUM, self.folder)
        for name, recorder in seen.items():
            self.assertTrue(recorder.messages, name)
            self.assertEqual({message.header.frame_id for message in recorder.messages}, {"world"})
        self.assertTrue(any(message.buttons[6] for message in buttons.messages), "the grip of the right hand")
        self.assertTrue(any(message.axes[1] > 0.9 for message in buttons.messages), "the stick of the left hand, ahead")
        # the patient lies, and the viewer stands to the right: above the organ, and looking to the patient's left
        head = seen["head"].messages[-1].pose
        self.assertGreater(head.position.x, 0.3)
        self.assertLess(head.position.y, -0.3)
        turn = head.orientation
        self.assertGreater(abs(turn.x + turn.y + turn.z + turn.w) / 2, 0.99)  # x ahead is y of the world, and z is x
        self.assertTrue(self.server.is_running(), self.server.last_words())

    def start_nginx(self, folder, server_port):
        """Before the server, below /vibe/ as docs/web.md shows it; returns its port."""
        with open(os.path.join(os.path.dirname(__file__), "proxy.conf"), encoding="utf-8") as file:
            location = file.read().replace("8890", str(server_port))
        port = free_port()
        with open(folder + "/nginx.conf", "w", encoding="utf-8") as file:
            file.write(NGINX_CONFIGURATION.format(folder=folder, certificates=folder, port=port, location=location))
        nginx = subprocess.Popen([NGINX, "-p", folder, "-c", folder + "/nginx.conf"])
        self.addCleanup(nginx.wait)
        self.addCleanup(nginx.terminate)
        self.assertTrue(wait_until(lambda: os.path.exists(folder + "/pid")))
        return port

    def test_7_behind_a_proxy(self):
        if not NGINX:
            self.skipTest("nginx is not installed")
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        lan = Program("vibe_web", "web_node", "--lan", name="web_certificate", port=0, certificates=folder)
        port_of(lan)
        lan.stop()
        context = ssl.create_default_context(cafile=folder + "/root.pem")
        server_port = free_port()
        port = self.start_nginx(folder, server_port)
        address = "https://localhost:{}".format(port)
        server = Program("vibe_web", "web_node", name="web_behind", port=server_port, behind=address + "/vibe")
        self.addCleanup(server.stop)
        self.assertTrue(wait_until(lambda: address + "/vibe/#token=" in server.output()), server.output())
        target = "/vibe/stream?token=" + token_of(server)
        self.assertEqual(status(port, target, origin=address, context=context), 101)
        self.assertEqual(status(port, target, origin="https://evil.example", context=context), 403)
        self.assertEqual(status(port, "/vibe/stream", origin=address, context=context), 403)
        self.assertEqual(status(self.port, "/stream", http.client.HTTPConnection, origin=address), 403)  # of another server
        self.run_in_chromium("elsewhere.mjs", "lan", "{}/vibe".format(port), CHROMIUM, token_of(server))


if __name__ == "__main__":
    rospy.init_node("web_test")
    rostest.rosrun("vibe_web", "browser", Web)
