"""The views of which scripts/views takes pictures, and their sessions."""

import collections

View = collections.namedtuple("View", "name session seconds followed", defaults=(None,))
# followed: from when on the camera listens, for what depends on the past: smoke, and the colour of marks
SESSIONS = {  # script, and what differs from the default scene
    "eye": ("eye", {}),
    "touch": ("touch", {}),
    "states": ("five_states", {}),
    "bleeding": ("five_states", {"mild_probability": 1.0, "brisk_probability": 0.0}),
}
VIEWS = [
    View("rest", "eye", 1.9),
    View("5mmhg", "eye", 5.6),
    View("10mmhg", "eye", 16.0),
    View("antrum", "eye", 21.5),
    View("retroflexed", "eye", 35.5),
    View("near", "touch", 14.8),
    View("touched", "touch", 17.8),
    View("marked", "states", 48.0),
    View("sutured", "states", 89.5),
    View("bleeding", "bleeding", 89.5),
    View("smoke", "eye", 48.4, followed=45.0),
    View("scar", "eye", 332.0, followed=45.0),
]
