"""Which sessions a published set has, and how they are split."""
import os

from vibe_sessions.cohort_plan import FORMAT, Plan, Session, digest, versions
from vibe_sessions.whole_file import open_whole

ORGANS = ("stomach", "stomach_small", "stomach_large", "stomach_j", "stomach_steer_horn", "stomach_8mmhg", "stomach_12mmhg")
BREATHING = {"still": 0, "calm": 8, "deep": 20}  # amplitude of the diaphragm at rest, 16 breaths per minute [mm]
PERSONS = 10  # experts and novices in turn
MOST = len(ORGANS) * len(BREATHING) * PERSONS  # each organ, grade and person once: their numbers have no common divisor
HELD_OUT_ORGAN, HELD_OUT_PERSONS = "stomach_j", (4, 9)  # an expert and a novice
SCRIPT = "package://vibe_core/trainees/first.yaml"
SPLITS = ("train", "test_person", "test_organ")


def member(number):
    """(organ, grade of breathing, person) of a session; the first few differ in all three."""
    return ORGANS[number % len(ORGANS)], list(BREATHING)[number % len(BREATHING)], number % PERSONS


def key_of(number):
    return "{:03d}_{}_{}_person{}".format(number, *member(number))


def split_of(number):
    """An organ that no training session has, persons that none has, or training."""
    organ, _, person = member(number)
    return "test_organ" if organ == HELD_OUT_ORGAN else "test_person" if person in HELD_OUT_PERSONS else "train"


def write_scenes(folder):
    os.makedirs(folder, exist_ok=True)
    for organ in ORGANS:
        for grade, amplitude in BREATHING.items():
            breathing = f"{{rate: 16 1/min, amplitude: {amplitude} mm}}" if amplitude else "none"
            with open_whole(os.path.join(folder, f"{organ}_{grade}.yaml")) as file:
                file.write(f"base: package://vibe_core/scenes/{organ}.yaml\nname: {organ}_{grade}\nbreathing: {breathing}\n")


class SetPlan(Plan):
    """The plan of a cohort whose sessions are members of a set."""

    @classmethod
    def make(cls, options):
        folder = os.path.join(os.path.abspath(options.output), "scenes")
        scenes = sorted({os.path.join(folder, "{}_{}.yaml".format(*member(k))) for k in range(options.count)})
        return cls({"format": FORMAT, "versions": versions(), "script": SCRIPT, "scenes": scenes, "meshes": [],
                    "novice": [0.0, 1.0], "first_seed": 1, "count": options.count, "duration": options.duration,
                    "rate": options.rate, "digests": {address: digest(address) for address in [SCRIPT, *scenes]}})

    def sessions(self):
        plan = self.content
        for number in range(len(self)):
            organ, grade, person = member(number)
            scene = next(scene for scene in plan["scenes"] if scene.endswith(f"/{organ}_{grade}.yaml"))
            yield Session(key_of(number), plan["script"], scene, "", float(person % 2), person + 1, plan["duration"],
                          tuple((address, plan["digests"][address]) for address in (plan["script"], scene)),
                          tuple(sorted(plan["versions"].items())))

    def __len__(self):
        return self.content["count"]
