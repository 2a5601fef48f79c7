"""What tests share: each has a folder of its own."""
import os
import shutil
import tempfile
import unittest


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vibe_sessions_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, content=""):
        """The path of a file with this text, or these bytes."""
        path = os.path.join(self.folder, name)
        with open(path, "wb") as stream:
            stream.write(content if isinstance(content, bytes) else content.encode())
        return path
