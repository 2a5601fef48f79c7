# Made by scripts/make_stubs.py of vibe_python from the module; do not edit.
from typing import Any, Optional
from numpy import ndarray

BUTTONS: tuple[str, ...]


class Error(RuntimeError):
    """What the library raises: one sentence that names the error, its place and the remedy."""
JOINTS: tuple[str, ...]


class Anatomy:
    """Anatomical coordinates of a stomach in the shape that it has when this is made: along its axis, 0 apex of the fundus to 1 duodenum, and around it, angle from the greater curvature [rad], positive to the front. A place of the wall is a triangle and the weights (3,) of its corners."""
    def __init__(self, simulation: Simulation) -> None:
        """Takes some 40 ms for 3,618 particles."""
    def along(self, triangle: int, weight: Any) -> float:
        """Position along the axis, 0 to 1."""
    def around(self, triangle: int, weight: Any) -> float:
        """Angle around the axis [rad]."""
    def at(self, along: float, around: float) -> tuple:
        """The wall at a place: (triangle, weight (3,)). Raises vibe.Error in the openings of the organ."""
    @property
    def axis_length(self) -> float:
        """Length of the axis [m]."""
    def outward(self, triangle: int, weight: Any) -> ndarray:
        """New array (3,): unit vector out of the lumen."""
    def position(self, triangle: int, weight: Any) -> ndarray:
        """New array (3,) [m]."""


class Event:
    """Something that happened in a step."""
    def __init__(self, *args, **kwargs: Any) -> None:
        """Made by Simulation.step()."""
    @property
    def amount(self) -> float:
        """A second number."""
    @property
    def bite(self) -> int:
        """Number from 0; -1: none."""
    @property
    def kind(self) -> str:
        """'grab', 'bite missed', ..."""
    @property
    def limit(self) -> float:
        """What the value is compared with."""
    @property
    def particle(self) -> int:
        """Nearest particle; -1: none."""
    @property
    def reason(self) -> str:
        """Why a command was rejected; 'none' otherwise."""
    @property
    def region(self) -> str:
        """Where, if the kind has it."""
    @property
    def suture(self) -> int:
        """Number from 0; -1: none."""
    @property
    def text(self) -> str:
        """One sentence for people."""
    @property
    def time(self) -> float:
        """Simulated time at the end of the step [s]."""
    @property
    def value(self) -> float:
        """Depends on the kind, see docs/interfaces.md."""
    @property
    def wall(self) -> str:
        """Where, if the kind has it."""


class InputSource:
    """What gives the input of each step: Trainee or Script."""
    def __init__(self, *args, **kwargs: Any) -> None:
        """Made as Trainee or Script."""
    def next(self, simulation: Simulation) -> dict:
        """The input of the next step, as keywords of Simulation.step(). To be called once before every step."""


class Model:
    """Everything that is constant during a simulation. Shared between simulations and threads."""
    def __init__(self, *args, **kwargs: Any) -> None:
        """Made by vibe.load()."""
    @property
    def area(self) -> ndarray:
        """View (particles,): wall at rest [m^2]."""
    @property
    def end(self) -> ndarray:
        """View (particles,) uint8: 0 none, 1 oesophagus, 2 duodenum, which hold the organ."""
    def forward_kinematics(self, joints: Any) -> ndarray:
        """New array (4, 4): pose of scope_tip in world with the joints (7,), while nothing bends the scope [m]."""
    def inverse_kinematics(self, position: Any, direction: Any, start: Any) -> ndarray:
        """Joints (7,) that bring the tip to a position (3,) [m], looking along direction (3,), from the joints start (7,); the best there are, if none do."""
    @property
    def joint_limits(self) -> dict[str, tuple[float, float, float]]:
        """Dictionary: joint to (lower, upper, speed) [m], [rad], [m/s], [rad/s]."""
    @property
    def mass(self) -> ndarray:
        """View (particles,) [kg]."""
    @property
    def mesh_report(self) -> str:
        """What was guessed of an imported mesh, as the text of its sidecar file; empty if nothing was."""
    @property
    def name(self) -> str:
        """Name of the scene."""
    @property
    def particle_radius(self) -> float:
        """Half the mean thickness of the wall [m]."""
    @property
    def particles(self) -> int:
        """Number of particles of the wall."""
    @property
    def region(self) -> ndarray:
        """View (particles,) uint8: 0 cardia, 1 fundus, 2 body, 3 antrum, 4 pylorus."""
    @property
    def rest_positions(self) -> ndarray:
        """New array (particles, 3): the wall without stress [m]."""
    @property
    def scene(self) -> str:
        """The scene as YAML with every key, in SI units."""
    @property
    def step_period(self) -> float:
        """Simulated time per step [s]."""
    @property
    def triangles(self) -> ndarray:
        """View (triangles, 3) int32: particle numbers, oriented outwards."""
    @property
    def wall(self) -> ndarray:
        """View (particles,) uint8: 0 anterior, 1 greater curvature, 2 posterior, 3 lesser curvature."""


class Simulation:
    """A running simulation: a model and everything that changes.

    Units are SI, the frame is the world: x to the patient's front, y to the left, z to the head. Model, state and inputs determine all that follows to the bit, whatever the number of threads. One thread at a time may use it; long calls let other Python threads run. Arrays named `view` show the present state for as long as they exist, without a copy, and cannot be written; all others are new arrays."""
    def __enter__(self) -> Any:
        ...
    def __exit__(self, *args) -> None:
        ...
    def __init__(self, model: Model, seed: Optional[int] = None, threads: int = 1, metrics: bool = True, impedance: bool = True) -> None:
        """Begins at the initial state. seed: instead of the scene's; threads: inside a step, results do not depend on them; metrics=False: measures() stays empty; impedance=False: impedance() stays None, which saves time and memory, and hash(), which covers its past, differs once the tool has touched something."""
    @property
    def burn_grade(self) -> ndarray:
        """View (particles,) uint8: 0 none, then mark, burn, deep burn; (0,) without marking."""
    def camera(self, width: int = 128, height: int = 128, field_of_view: float = 1.7, normals: bool = False, colour: bool = False, tool: bool = False, pose: Any = None, lamp: float = 0.03) -> dict:
        """What a pinhole camera at the endoscope's lens sees of the wall, by exact rays and without a display; tool: with the suturing device and the threads. field_of_view: from the left to the right edge [rad]. A dictionary of arrays (height, width): depth float32 along the optical axis [m], NaN: nothing; label uint8: 0 nothing, else 1 + region (1 cardia, 2 fundus, 3 body, 4 antrum, 5 pylorus), 6 device, 7 thread; triangle int32, -1: not the wall; on request normal (height, width, 3) float32 in the camera, towards it; and colour (height, width, 3) uint8: red, green, blue of a matt wall that a lamp at the lens lights, 0: nothing. The colour is 255 sqrt(r / (1 + r)), r = albedo cos(angle of incidence) (lamp / distance)^2 with lamp [m]; it is not the look of rviz. pose: (4, 4) of a camera elsewhere in world, z along its optical axis, x to the right, y down [m]; from outside it sees through the near wall, and tool is the whole scope."""
    def close(self) -> None:
        """Ends it; views stay valid. Whatever uses it later raises vibe.Error."""
    @property
    def closed(self) -> bool:
        """Whether close() was called."""
    def contacts(self) -> dict:
        """Forces of the tissue on the tool in the last step; empty before it, and after restore() and reset(). A dictionary of new arrays, with a row per contact, all in world: point (n, 3), of the wall at the end of the step [m]; normal (n, 3), unit, out of the tool, zero for the grip of the helix; gap (n,), from the tool to the face of the wall, below 0: squeezed by as much [m]; force (n, 3), mean over the step, whose sum is the force of wrench [N]; normal_force (n,) and tangential_force (n, 3), its parts [N]; shape (n,) int32, of the tool, -1: grip; triangle (n,) int32, -1: none; nodes (n, 3) int32, -1: fewer, and weights (n, 3), whose mean is point, none where the helix holds a patch; region, wall (n,) uint8, as those of Model. Beside them link and kind ('contact' or 'grip'), lists of n names."""
    @property
    def dose(self) -> ndarray:
        """View (particles,) float32: dose of the argon beam [J]; (0,) without marking."""
    @property
    def events(self) -> list[Event]:
        """What happened in the last call of step(), run() or follow()."""
    @property
    def first_seen(self) -> ndarray:
        """New array (particles,) float32: when the lens saw each particle first since the start or the last restore() [s], NaN: not yet. None in scenes without inspection, and with metrics=False."""
    def follow(self, trainee: InputSource, seconds: Optional[float] = None) -> list[Event]:
        """Lets a Trainee or a Script give the input, until it has ended, or for simulated seconds. Returns what happened."""
    def hash(self) -> int:
        """64 bits of all of the state: equal hashes mean equal states, and, with one model, equal futures."""
    @property
    def heat(self) -> ndarray:
        """View (particles,) float32: heat of the argon beam; (0,) without marking."""
    def impedance(self) -> Any:
        """Of the tissue at the tip: None while nothing is touched, or stiffness and damping, as docs/interfaces.md has them."""
    @property
    def input(self) -> dict:
        """The input in force, as keywords of step()."""
    @property
    def jacobian(self) -> ndarray:
        """New array (6, 4): linear and angular velocity of scope_tip in world per speed of the four joints of the scope."""
    @property
    def joints(self) -> ndarray:
        """New array (7,): where the hand has the joints, in the order of vibe.JOINTS [m], [rad]."""
    def link_pose(self, name: str) -> ndarray:
        """New array (4, 4): pose of a link of the URDF in world [m]."""
    def load(self, file: str, other_model: bool = False) -> None:
        """Back to the state of a snapshot that save() or a node has written; see restore()."""
    def look_ahead(self) -> Any:
        """Where the tip looks: None, or triangle, point (3,) [m], normal (3,), distance [m]."""
    def measures(self) -> dict:
        """Measures of skill by name (docs/metrics.md), since the start or the last restore(); None where the session does not define one. Units: vibe.measure_units()."""
    @property
    def model(self) -> Model:
        """Its model."""
    @property
    def motion(self) -> dict:
        """New dict: what moves the organ by itself, as on the topic organ/motion: parts of a breath, of the period of
        contraction waves and of a beat, 0 to 1; whether and for how long the breath was held [s]; work of the muscle [J]."""
    @property
    def normals(self) -> ndarray:
        """New array (particles, 3): unit normals out of the lumen."""
    @property
    def positions(self) -> ndarray:
        """New array (particles, 3): positions [m]."""
    @property
    def pressure(self) -> float:
        """Of the gas, above ambient [Pa]."""
    def procedure(self) -> dict:
        """A dictionary: phase, grips, turns, arm_closed, needle_on_arm, needle_loaded, blood_lost [m^3], thread_used [m]."""
    def reset(self, seed: Optional[int] = None) -> None:
        """Back to the initial state."""
    def restore(self, snapshot: Snapshot, other_model: bool = False) -> None:
        """Back to a state; views show it. The input then holds the joints where they are, and no button but helix_grab and cinch, if they were pressed. Raises vibe.Error if it is of another model; other_model=True takes one of the same organ, step and parts whose scene has other values, such as of the tissue."""
    def run(self, steps: int, **kwargs: Any) -> list[Event]:
        """Some steps with one input.

        Keywords of the input (what is not named stays as it is):
          insertion [m], rotation [rad], tip_up_down [rad], tip_left_right [rad], helix_advance [m],
          helix_rotation [rad], needle_driver [m]: positions to which the joints are led, within their ranges and speeds
          apc_pedal, helix_grab, needle, t_tag, cinch, insufflate: buttons, True while pressed
          joints (7,), buttons (6,): all of them, in the order of vibe.JOINTS and vibe.BUTTONS
          pull=(particle, target (3,) [m]): the spring that pulls the tissue from outside; None: it lets go
          hold_breath: True while the breath is held

        Returns what happened. Ctrl+C ends it after a step."""
    def save(self, file: str) -> None:
        """Writes a snapshot."""
    def sees(self, leave_out: Any = None, field_of_view: Optional[float] = None, distance: Optional[float] = None, angle: Optional[float] = None) -> ndarray:
        """New array (particles,) bool: which particles of the wall the lens sees now, as docs/metrics.md#coverage defines it: within the field_of_view of the round picture [rad], no farther than distance [m], within angle of the normal [rad], hidden by no fold and not by the device; None: as the section inspection of the scene says, else its defaults. leave_out: (particles,) True where nobody wants to know, which saves time."""
    def snapshot(self, prepared: bool = False) -> Snapshot:
        """The present state, in memory. prepared=True, for states that many simulations go back to: keeps what the first step after restore() takes long to make, too (a megabyte with 1,000 particles), with the same results."""
    def step(self, **kwargs: Any) -> list[Event]:
        """One step.

        Keywords of the input (what is not named stays as it is):
          insertion [m], rotation [rad], tip_up_down [rad], tip_left_right [rad], helix_advance [m],
          helix_rotation [rad], needle_driver [m]: positions to which the joints are led, within their ranges and speeds
          apc_pedal, helix_grab, needle, t_tag, cinch, insufflate: buttons, True while pressed
          joints (7,), buttons (6,): all of them, in the order of vibe.JOINTS and vibe.BUTTONS
          pull=(particle, target (3,) [m]): the spring that pulls the tissue from outside; None: it lets go
          hold_breath: True while the breath is held

        Returns what happened."""
    @property
    def steps(self) -> int:
        """Steps since the initial state, through snapshots."""
    @property
    def strain(self) -> ndarray:
        """New array (particles,) float32: mean stretch in the wall relative to rest, minus 1."""
    def thread_contacts(self) -> dict:
        """What threads that pull do to the wall at their bites, with the tensions of the last step. A dictionary of new arrays: point (n, 3), world [m]; force (n, 3), on the wall, world [N]; thread, bite (n,) int32, numbers in threads() and of the bite."""
    def threads(self) -> list[dict]:
        """A dictionary per suture set: stage, technique, margin; bites (n, 3) [m], depth (n,) [m], time (n,) [s], full_thickness: n booleans; length (n-1,) [m] and tension (n-1,) [N] between them; drawn [m], cinch_tension [N], tear_outs."""
    @property
    def time(self) -> float:
        """Simulated time [s]."""
    @property
    def tip_pose(self) -> ndarray:
        """New array (4, 4): pose of the link scope_tip in world; its x axis is the view [m]."""
    @property
    def velocities(self) -> ndarray:
        """New array (particles, 3): velocities [m/s]."""
    @property
    def volume(self) -> float:
        """Of the lumen [m^3]."""
    @property
    def vx(self) -> ndarray:
        """View (particles,): velocities [m/s]."""
    @property
    def vy(self) -> ndarray:
        """View (particles,): velocities [m/s]."""
    @property
    def vz(self) -> ndarray:
        """View (particles,): velocities [m/s]."""
    def wall_contacts(self) -> dict:
        """Where the wall presses on itself in the present state; looked for in this call only. A dictionary of new arrays: point (n, 3), half way between two points of the wall, world [m]; normal (n, 3), unit, from the second to the first; distance (n,), of the two on the middle of the wall [m]; normal_force (n,), without friction [N]; nodes (n, 4) int32, -1: fewer, and weights (n, 4): above 0 at the first point, below 0 at the second."""
    def warm_up(self) -> None:
        """Takes the time that the first step needs besides; changes no result."""
    @property
    def wrench(self) -> ndarray:
        """New array (6,): force [N] and torque [N m] of the tissue on the tool, mean over the last step, about the origin of scope_tip and in its axes."""
    @property
    def x(self) -> ndarray:
        """View (particles,): positions [m]."""
    @property
    def y(self) -> ndarray:
        """View (particles,): positions [m]."""
    @property
    def z(self) -> ndarray:
        """View (particles,): positions [m]."""


class Snapshot:
    """The state of a simulation at one time. Cheap to make and to restore; can be pickled."""
    def __init__(self, bytes: bytes) -> None:
        """Of the bytes of a snapshot; they are checked when it is restored."""
    def to_bytes(self) -> bytes:
        """The bytes, as Simulation.save() writes them to a file."""


class Script(InputSource):
    """Motions of joints and buttons over time (docs/trainee_scripts.md)."""
    def __init__(self, file: str) -> None:
        """A file, package://PACKAGE/file, or the text of one."""
    @property
    def duration(self) -> float:
        """How long it takes [s]."""


class Trainee(InputSource):
    """A trainee that looks and pursues the goals of a protocol (docs/protocols.md)."""
    def __init__(self, model: Model, protocol: str, novice: Optional[float] = None, seed: Optional[int] = None) -> None:
        """protocol: a file, package://PACKAGE/file, or the text of one; novice: skill instead of the protocol's, 0 expert to 1 novice; seed: of aim errors and tremor, instead of the protocol's."""
    @property
    def activity(self) -> str:
        """What it is doing: 'bite 3 of 7, second try'."""
    @property
    def done(self) -> bool:
        """Whether every goal has ended."""
    @property
    def results(self) -> list[dict]:
        """A dictionary per goal: goal, reached, reason."""


def build_model(scene: str, overrides: str, mesh: str) -> Model:
    """The model of a scene file. overrides: a JSON object on top of it, or empty; mesh: a surface file, or empty. vibe.load() is the friendlier way."""


def measure_units() -> dict:
    """Units of Simulation.measures() by name, SI; '1' for counts and shares."""


def observe_all(simulations: list[Simulation]) -> dict:
    """A dictionary of new arrays: joints (n, 7), tip_pose (n, 4, 4), wrench (n, 6), time (n,), contacts (n,) int32, grips (n,) bool; as the attributes of Simulation."""


def recognise_technique(bites: Any, printed: bool = False) -> dict:
    """The stitch pattern of bites (n, 3) in any unit: technique, margin from 0 to 1, transitions. printed: by the rule of the ViBE paper as printed."""


def step_all(simulations: list[Simulation], joints: Any, buttons: Any, steps: int, threads: int) -> list[list[Event]]:
    """Some steps of many simulations, each in one of the threads: joints (n, 7) are reached evenly over the steps, buttons (n, 6) are pressed. Returns a list of events per simulation. The results are those of one after the other. Ctrl+C ends it within some steps."""


def wall_points(simulations: list[Simulation], triangles: Any, weights: Any) -> ndarray:
    """New array (n, k, 3): present positions of places of the wall, triangles (n, k) and weights (n, k, 3) of their corners [m]."""
