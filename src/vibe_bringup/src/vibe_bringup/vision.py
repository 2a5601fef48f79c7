"""The camera that watches the instruments in a session, or one in software in its place."""

import os
import time

from .graph import GraphError

PATIENCE = 120.0  # for the simulated camera to draw its scene [s]
FAKE_ADDRESS = "127.0.0.1"


def serves(log):
    with open(log, encoding="utf-8", errors="replace") as text:
        return " serves " in text.read()


class Vision:
    """vision_node, whose joints take the place of those that buttons move."""

    def __init__(self, arguments):
        self.source, self.config = arguments.camera, arguments.vision_config
        self.fake = self.source == "fake"
        if self.fake:
            self.source, self.config = "gige:" + FAKE_ADDRESS, os.path.join(arguments.output, "rig.yaml")

    def start(self, graph, driver):
        """Starts the nodes; what they send must end before the recorder does, as for who drives."""
        if self.fake:
            self.start_fake(graph)
        graph.set_parameter("/vision_node/config", self.config)
        graph.set_parameter("/vision_node/source", self.source)
        graph.set_parameter("/vision_node/publish_images", False)  # the recorder would take all of them: 58 MB/s
        driver.senders.append(graph.start_node("vibe_vision", "vision_node", visible=True))

    def start_fake(self, graph):
        """Waits until it serves frames: it draws them first."""
        options = ["--address", FAKE_ADDRESS, "--config", self.config]
        camera = graph.start_node("vibe_vision", "vibe_fake_camera", *options)
        deadline = time.monotonic() + PATIENCE
        while not serves(camera.log):
            if camera.status() is not None or time.monotonic() > deadline:
                raise GraphError("vibe_fake_camera offers no camera; what it said:\n" + camera.last_words())
            time.sleep(0.1)
