from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["vibe_sessions", "vibe_sessions.export", "vibe_sessions.imports", "vibe_sessions.published", "vibe_sessions.report"],
        package_dir={"": "src"},
        package_data={"vibe_sessions.export": ["*.json"], "vibe_sessions.published": ["*.md"], "vibe_sessions.report": ["templates/*"]},
    )
)
