"""What scripts/accuracy measures: sections, each a file of docs/measured, and their parts, each a run of a program."""

import csv
import dataclasses
import glob
import json
import os
import re
import resource
import subprocess
import tempfile

import measured_policy

SESSION_TEXT = "first_session.txt"  # what the first session printed, which first_run.md shows
STOMACH = "package://vibe_core/scenes/stomach.yaml"
PATIENT = ("geometry: {{particles: 1000, shape: {}, volume: {} L, fundus_width: {}, antrum_angle: {} deg}}\n"
           "tissue: {{young_modulus: {} kPa, thickness: {{cardia: {} mm, fundus: {} mm, body: {} mm, antrum: {} mm, "
           "pylorus: {} mm}}}}\n")
SCENES = {  # variants of the default scene: a text that follows its line, or (line to remove, None)
    "rigid": ("  compliance: {}", None),
    "small": (None, "geometry: {particles: 1000}\n"),
    "fine": (None, "geometry: {particles: 16000}\n"),
    "coarse": (None, "geometry: {particles: 900}\ngas: {flow_limit: 30 L/min}\n"),
    "thin": (None, "tissue: {thickness: {cardia: 0.8 mm, fundus: 0.8 mm, body: 0.8 mm, antrum: 0.8 mm}}\n"),
    "shape_matching": (None, "tissue: {model: shape_matching, young_modulus: 100 kPa, self_contact: false}\n"),
    # of vibe_population --seed 1, by number: four small ones, of them a soft and a thin one, and one that is stiff
    "population_33": (None, PATIENT.format("sthenic", 0.5467, 1.009, -5.667, 65.29, 2.119, 2.119, 2.506, 2.904, 2.904)),
    "population_69": (None, PATIENT.format("j", 0.5701, 0.934, -7.571, 33.97, 2.373, 2.373, 2.807, 3.253, 3.253)),
    "population_73": (None, PATIENT.format("j", 0.5637, 1.0676, -5.686, 126.22, 1.31, 1.31, 1.55, 1.796, 1.796)),
    "population_25": (None, PATIENT.format("steer_horn", 0.6055, 1.045, 3.606, 99.26, 1.75, 1.75, 2.07, 2.399, 2.399)),
    "population_12": (None, PATIENT.format("steer_horn", 0.967, 1.0087, -4.878, 427.33, 1.29, 1.29, 1.526, 1.769, 1.769)),
    # six that the trainee's rules were not made on, of other seeds: seed and number
    "population_2_2": (None, PATIENT.format("j", 1.0114, 1.0248, 1.820, 100.47, 1.826, 1.826, 2.160, 2.503, 2.503)),
    "population_3_3": (None, PATIENT.format("steer_horn", 0.6267, 1.0618, 1.162, 80.78, 2.947, 2.947, 3.486, 4.040, 4.040)),
    "population_3_4": (None, PATIENT.format("steer_horn", 0.7311, 0.9930, 4.815, 92.51, 1.473, 1.473, 1.742, 2.019, 2.019)),
    "population_5_3": (None, PATIENT.format("steer_horn", 0.6410, 0.9121, -8.625, 124.27, 2.123, 2.123, 2.511, 2.910, 2.910)),
    "population_7_0": (None, PATIENT.format("steer_horn", 0.9480, 0.9602, 9.550, 99.23, 2.300, 2.300, 2.720, 3.152, 3.152)),
    "population_7_3": (None, PATIENT.format("j", 0.6484, 0.9762, 7.288, 165.74, 1.645, 1.645, 1.946, 2.255, 2.255)),
}
ORGANS = ("stomach", "stomach_small", "stomach_large", "stomach_j", "stomach_steer_horn", "stomach_8mmhg",
          "stomach_12mmhg")
REST_ORGANS = ("stomach_small", "stomach_large", "stomach_steer_horn")
QUICK_CASES = ("case4_sphere", "case5_inflation", "case5_limit", "case6_bite", "case6_bite_refined", "case7_cinch")
QUICK_EXPERIMENTS = ("shell_stiffness", "rubber_balloon", "rubber_width_held", "silicone_beam", "porcine_filling")
MEASURES = ("time", "sets", "sets_as_planned", "bites", "bites_full_thickness", "tear_outs", "missed_bites", "slips",
            "bites_per_5_min", "max_force", "max_pressure", "area_reduction", "volume_reduction", "length_reduction",
            "tool_work", "gas_work", "thread_work", "correction_work", "energy_balance")


@dataclasses.dataclass(frozen=True)
class Part:
    """One run of a program, without the option that names its table. {NAME} in a word is a scene of SCENES, {root} the
    workspace."""
    name: str
    words: tuple
    minutes: float  # of processor time, about
    quick: bool = False  # is run by the test
    cores: int = 1  # is measured where the machine has so many


@dataclasses.dataclass(frozen=True)
class Section:
    name: str
    about: str
    keys: tuple  # columns that name a row of a part
    compared: tuple  # columns that the test compares, where parts are quick
    parts: tuple


def case_parts(root):
    for case in sorted(glob.glob(os.path.join(root, "src/vibe_benchmarks/cases/*.yaml"))):
        name = os.path.splitext(os.path.basename(case))[0]
        words = ("vibe_bench", "--case", "{root}/src/vibe_benchmarks/cases/" + name + ".yaml")
        yield Part(name, words, 0.1, name in QUICK_CASES)


def experiment_parts(root):
    for file in sorted(glob.glob(os.path.join(root, "src/vibe_benchmarks/measurements/*.yaml"))):
        name = os.path.splitext(os.path.basename(file))[0]
        yield Part(name, ("src/vibe_benchmarks/scripts/experiment.py", name), 0.1, name in QUICK_EXPERIMENTS)


def contact_parts():
    rates = ("--rate", "60", "120", "240")
    for name, minutes in (("free", 1), ("free_closed", 1), ("pressed", 2), ("wound", 6), ("cinch1", 3), ("cinch6", 8)):
        yield Part(name, ("vibe_contact", "states", name, *rates), minutes)
    yield Part("pressed_rigid", ("vibe_contact", "states", "pressed", "--scene", "{rigid}", *rates), 2)
    words = ("vibe_contact", "states", "free", "pressed", "--rate", "1020", "--iterations", "1", "--no-reference")
    yield Part("steps_1_ms", words, 1)
    yield Part("steps_1_ms_small", (*words, "--scene", "{small}"), 0.3)


def ways_parts():
    yield Part("states", ("vibe_contact", "ways", "free", "pressed", "wound", "cinch1", "cinch6"), 3)
    yield Part("jump", ("vibe_contact", "ways", "jump"), 1)
    yield Part("sleeve", ("vibe_contact", "ways", "sleeve"), 6)


def rest_parts():
    for particles, poses, minutes in (("3618", "50", 7), ("2000", "50", 4), ("1000", "100", 5), ("680", "100", 4), ("300", "200", 4)):
        words = ("vibe_contact", "rest", "--particles", particles, "--poses", poses, "--hold", "19")
        yield Part(particles, words, minutes)
    scenes = (("thin", "{thin}"), *((name, f"package://vibe_core/scenes/{name}.yaml") for name in REST_ORGANS))
    for name, scene in scenes:
        words = ("vibe_contact", "rest", "--scene", scene, "--particles", "1000", "--poses", "40", "--hold", "19")
        yield Part(name, words, 2)


def threads_parts():
    for count in ("2", "4", "8"):
        words = ("vibe_contact", "states", "free", "pressed", "wound", "--no-reference", "--real-time", "--repeats", "3")
        yield Part(count, (*words, "--threads", "1", count), 0.8, cores=int(count))


def instructions_parts():
    yield Part("tool", ("scripts/instructions", "free", "pressed"), 2)
    yield Part("folds", ("scripts/instructions", "wound", "cinch1", "cinch6"), 10)


def hard_parts():
    for name, minutes in (("ram_0.15", 1), ("ram_0.3", 1), ("ram_0.5", 1), ("ram_1", 1), ("wind", 2), ("across", 2),
                          ("desufflate", 2), ("sets_20", 10), ("over_set", 2), ("pressure", 1), ("sleeve", 6),
                          ("8x7", 5), ("14x4", 7)):
        yield Part(name, ("vibe_contact", "hard", name), minutes)
    for seed in range(1, 11):
        yield Part("random_{}".format(seed), ("vibe_contact", "hard", "random", "--seed", str(seed)), 1)
        yield Part("jump_{}".format(seed), ("vibe_contact", "hard", "jump", "--seed", str(seed)), 1)


def organ_parts(meshes):
    script = ("--script", "package://vibe_core/trainees/expert.yaml")
    for name in ORGANS:
        yield Part(name, ("vibe_headless", "--scene", f"package://vibe_core/scenes/{name}.yaml", *script), 12)
    for name in (scene for scene in SCENES if scene.startswith("population_")):
        yield Part(name, ("vibe_headless", "--scene", "{" + name + "}", *script), 2)
    for mesh in meshes:
        name = "imported_" + os.path.splitext(os.path.basename(mesh))[0]
        yield Part(name, ("vibe_headless", "--scene", STOMACH, "--mesh", mesh, *script), 12)


STATE_ERRORS = ("motion_error", "motion_error_end", "force_error", "force_error_end", "largest_force_N")


def guard_parts():
    reference = ("--reference-rate", "240", "--reference-iterations", "4")
    words = ("vibe_contact", "states", "pressed", "wound", "cinch1", "--scene", "{coarse}", *reference)
    yield Part("states", words, 0.2, True)
    words = ("vibe_contact", "refinement", "--scene", "{coarse}", "--particles", "900", "--sites", "1")
    yield Part("refinement", words, 0.1, True)


def outcome_parts():
    all_three = ("as_cinched", "sewn_empty", "same_thread", "fine_mesh", "no_friction", "no_foundation")
    names = [name + "_" + pattern for name in all_three for pattern in "cuz"]
    for name in (*names[:3], "tight_u", "loose_u", *names[3:]):
        yield Part(name, ("vibe_sutures", "outcomes", "--trial", name), 2.5 if name.startswith("fine_mesh") else 0.7)


def refinement_parts():
    for count in (1000, 2000, 3618, 8000, 16000):
        yield Part(str(count), ("vibe_contact", "refinement", "--particles", str(count)), count / 1500)


def session_parts():
    trainees = "package://vibe_core/trainees/"
    yield Part("first", ("vibe_headless", "--script", trainees + "first.yaml"), 1)
    yield Part("grabs", ("vibe_headless", "--script", trainees + "demo/grabs.yaml"), 0.5)
    words = ("vibe_headless", "--scene", "{shape_matching}", "--script", trainees + "demo/grabs.yaml")
    yield Part("grabs_shape_matching", words, 1.5)


def fine_parts():
    for threads in ("1", "2"):
        words = ("--scene", "{fine}", "--script", "package://vibe_core/trainees/demo/grabs.yaml", "--threads", threads)
        yield Part("threads_" + threads, ("vibe_headless", *words), 4)


def sections(root, meshes=()):
    """All of them, quick ones first."""
    case = ("case", "method", "setting")
    return (
        Section("guard", "states of contact and a grip with 900 particles: what the test runs",
                ("state", "grip", "site"), (*STATE_ERRORS, "iterations_mean", "force_N"), tuple(guard_parts())),
        Section("fem", "shell and tetrahedra against finite elements", case, ("reference_error", "energy_drift"),
                tuple(case_parts(root))),
        Section("measurements", "published experiments that nothing was fitted to", ("experiment", "run", "quantity", "at"),
                ("predicted",), tuple(experiment_parts(root))),
        Section("motion", "speed and error of settings, cost by number of particles", (*case, "particles"), (),
                (Part("methods", ("vibe_bench", "--methods"), 8),)),
        Section("pulling", "two bites pulled together by thread and by groups", case, (),
                (Part("pulling", ("vibe_bench", "--pulling"), 3),)),
        Section("states", "steps in contact", ("state", "rate", "iterations"), STATE_ERRORS, tuple(contact_parts())),
        Section("ways", "ways on which steps go on otherwise than foreseen", ("case", "way"), (), tuple(ways_parts())),
        Section("rest", "whether the wall rests while the scope is held", ("particles", "pose"), (), tuple(rest_parts())),
        Section("threads", "wall time of steps by number of threads", ("state", "threads"), (), tuple(threads_parts())),
        Section("instructions", "instructions of steps in contact", ("state",), (), tuple(instructions_parts())),
        Section("refinement", "force of a grip on finer meshes", ("grip", "site"), (), tuple(refinement_parts())),
        Section("hard", "hard cases of contact", ("case",), (), tuple(hard_parts())),
        Section("policy", "what each number that steers a step changes", ("number", "factor"), (),
                (Part("numbers", ("vibe_policy", "--scene", "{coarse}"), 20),
                 Part("walls", ("vibe_policy", *measured_policy.numbers_of_walls()), 10))),
        Section("scenarios", "time of each suture set", ("scenario", "set"), (),
                (Part("scenarios", ("vibe_sutures", "scenarios", "--quick"), 12),)),
        Section("outcomes", "idealised sleeves in C, U and Z", ("trial", "pattern"), (),
                tuple(outcome_parts())),
        Section("sessions", "the first session and a minute of grabs", (), (), tuple(session_parts())),
        Section("fine", "a minute of grabs with 16,000 particles", (), (), tuple(fine_parts())),
        Section("organs", "an expert's sleeve on all organs", (), (), tuple(organ_parts(meshes))),
    )  # fmt: skip


def write_scene(root, name, folder):
    """A variant of the default scene as a file of its own."""
    removed, added = SCENES[name]
    with open(os.path.join(root, "src/vibe_core/scenes/stomach.yaml"), encoding="utf-8") as text:
        lines = text.read().splitlines(keepends=True)
    if removed:
        kept = [line for line in lines if not line.startswith(removed)]
        if len(kept) != len(lines) - 1:
            raise ValueError("stomach.yaml has no line '{}'".format(removed))
        scene = "".join(kept)
    else:
        scene = "base: {}\nname: {}\n{}".format(STOMACH, name, added)
    file = os.path.join(folder, name + ".yaml")
    with open(file, "w", encoding="utf-8") as out:  # not whole: scratch
        out.write(scene)
    return file


def session_row(said, measures):
    """What a session of vibe_headless printed and its table of measures, as one row."""
    row = {name: "{:.6g}".format(value) if value is not None else ""
           for name in MEASURES for value in (measures["measures"][name]["value"],)}
    row["steps"], row["state_hash"] = measures["steps"], measures["state_hash"]
    solver = r"^solver per step +([\d.]+) ms p50 +([\d.]+) ms p99 +([\d.]+) ms max.* of (\d+) particles"
    row["ms_p50"], row["ms_p99"], row["ms_max"], row["particles"] = re.search(solver, said, re.MULTILINE).groups()
    row["real_time_factor"] = re.search(r"^real-time factor +([\d.]+)$", said, re.MULTILINE).group(1)
    times = [float(found) for found in re.findall(r"^ +\d+ +\w+ .* ([\d.]+)  cinched$", said, re.MULTILINE)]
    row["set_s_least"], row["set_s_most"] = (min(times), max(times)) if times else ("", "")
    return row


class Runner:
    """Runs parts with the programs of a devel folder."""

    def __init__(self, root, devel, log):
        self.root, self.devel, self.log = root, devel, log

    def program(self, name):
        if "/" in name:
            return os.path.join(self.root, name)
        package = "vibe_core" if name == "vibe_headless" else "vibe_benchmarks"
        return os.path.join(self.devel, "lib", package, name)

    def file(self, name, folder):
        return self.root if name == "root" else write_scene(self.root, name, folder)

    def run(self, part):
        """Rows of the part, its processor time [s], and what the program printed."""
        with tempfile.TemporaryDirectory(prefix="vibe_accuracy.") as folder:
            words = [re.sub(r"\{(\w+)\}", lambda found: self.file(found.group(1), folder), word) for word in part.words]
            table = os.path.join(folder, "table")
            option = "--measures" if words[0] == "vibe_headless" else "--csv"
            python = [os.path.join(self.devel, "lib/python3/dist-packages"), os.environ.get("PYTHONPATH")]
            environment = {**os.environ, "VIBE_DEVEL": self.devel, "PYTHONPATH": os.pathsep.join(filter(None, python))}
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run([self.program(words[0]), *words[1:], option, table], stdout=subprocess.PIPE,
                                  stderr=self.log, check=True, text=True, env=environment)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            with open(table, newline="", encoding="utf-8") as stream:
                if option == "--csv":
                    rows = list(csv.DictReader(stream))
                else:
                    rows = [session_row(done.stdout, json.load(stream))]
        return rows, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout
