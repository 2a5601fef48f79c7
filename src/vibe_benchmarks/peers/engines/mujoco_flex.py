"""MuJoCo: a 2D flex with the elasticity of a shell; the integrator `discrete` takes it implicitly."""

import mujoco
import numpy as np

from scenes import FRAME

NAME, PACKAGE, VERSION = "MuJoCo flex", "mujoco", mujoco.__version__
SWEEP = {f"{name} Hz": {"step": 1 / name, "damping": 0.01} for name in (60, 240)}  # damping of the stiffness [s]
HEAVY = 1.0  # [kg]
CM = 100.0  # lengths are in centimetres: in metres small triangles get no finite stiffness
UNSTABLE = [mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC]
AXES = (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1"))


def cannot(scene):
    return {"law": "Saint Venant-Kirchhoff, not neo-Hookean"} | (
        {"gas": "no gas: its forces come from the user"} if scene.pressure else {})


class Engine:
    def __init__(self, scene, settings):
        self.scene, self.step_size = scene, settings["step"]
        self.still = np.zeros(len(scene.nodes), bool)
        self.moving = [h for h in scene.holds.values() if h.motions]
        for hold in scene.holds.values():
            self.still[hold.nodes] = not hold.motions
        self.frame, self.extra = -1, 0.0
        self.settings, self.masses = settings, scene.masses()
        for hold in self.moving:  # a flex takes no mocap bodies: nodes so heavy that forces hardly move them
            self.masses[hold.nodes] = HEAVY
        self.model = mujoco.MjModel.from_xml_string(self.xml(self.still))
        self.data = mujoco.MjData(self.model)
        self.rows = np.cumsum(~self.still) - 1  # of the nodes that can move
        mujoco.mj_forward(self.model, self.data)

    def xml(self, still):
        s, damping = self.scene, 0 if self.scene.line is not None else self.settings["damping"]
        bodies = []
        for n, (place, mass) in enumerate(zip(s.nodes * CM, self.masses)):
            inside = "" if still[n] else f'<inertial pos="0 0 0" mass="{mass:.9g}" diaginertia="1 1 1"/>' + "".join(
                f'<joint type="slide" axis="{axis}" name="n{n}{name}"/>' for name, axis in AXES)
            bodies.append(f'<body name="n{n}" pos="{place[0]:.9g} {place[1]:.9g} {place[2]:.9g}">{inside}</body>')
        thread = ""
        if s.thread and still.any():
            links = "".join(f'<joint joint="n{n}x" coef="{sign * w:.9g}"/>' for sign, spot in
                            ((1, s.thread.plus), (-1, s.thread.minus)) for n, w in zip(*spot))  # fmt: skip
            thread = (f'<tendon><fixed name="thread">{links}</fixed></tendon><equality><tendon tendon1="thread" '
                      f'solref="{2 * self.step_size} 1" solimp="0.9999 0.9999 0.001"/></equality>')
        return (f'<mujoco><option timestep="{self.step_size}" integrator="discrete" solver="CG" '
                f'cone="pyramidal" gravity="0 0 {-s.gravity * CM}"/><size memory="1G"/><worldbody>{"".join(bodies)}</worldbody>'
                f'<deformable><flex name="wall" dim="2" radius="0.01" '
                f'body="{" ".join(f"n{n}" for n in range(len(s.nodes)))}" '
                f'element="{" ".join(map(str, s.triangles.ravel()))}"><contact contype="0" conaffinity="0" '
                f'selfcollide="none"/><elasticity young="{s.young / CM}" poisson="{s.poisson}" thickness="{s.thickness * CM}" '
                f'damping="{damping}" elastic2d="both"/></flex></deformable>{thread}</mujoco>')

    def place(self, time):
        speed = self.data.qvel.reshape(-1, 3)
        for hold in self.moving:
            rows, rest = self.rows[hold.nodes], self.scene.nodes[hold.nodes]
            speed[rows] = ((hold.at(rest, time) - rest) * CM - self.data.qpos.reshape(-1, 3)[rows]) / self.step_size
        if self.scene.thread:
            self.pull(time)

    def pull(self, time):
        """The equality is soft: the user corrects its target by what was missing, once per frame."""
        thread = self.scene.thread
        rest = thread.length(self.scene.nodes)
        wanted = min(time, 1) * (thread.distance - rest)
        if int(time / FRAME) > self.frame:
            self.frame = int(time / FRAME)
            self.extra += 0.5 * (wanted + rest - thread.length(self.positions()))
        self.model.eq_data[0, 0] = (wanted + self.extra) * CM

    def apply(self, forces):
        self.data.qfrc_applied[:] = forces[~self.still].ravel() * CM

    def step(self):
        mujoco.mj_step(self.model, self.data)
        if any(self.data.warning[w].number for w in UNSTABLE):  # MuJoCo starts anew then
            raise RuntimeError(f"unstable at {self.data.time:.2f} s")

    def positions(self):
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_flex(self.model, self.data)
        return self.data.flexvert_xpos / CM

    def force(self):
        """Of the tool on a hold, from the elastic forces of the same mesh without holds; or the tension."""
        name, direction, _ = self.scene.force
        if name == "thread":
            return abs(float(self.data.efc_force[0])) / CM
        free = mujoco.MjModel.from_xml_string(self.xml(np.zeros_like(self.still)))
        data = mujoco.MjData(free)
        data.qpos[:] = (self.positions() - self.scene.nodes).ravel() * CM
        mujoco.mj_forward(free, data)
        return float(-data.qfrc_spring.reshape(-1, 3)[self.scene.holds[name].nodes].sum(0) @ direction) / CM
