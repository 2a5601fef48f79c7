#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/thermal/argon_beam.hpp"

namespace vibe {

/// Shape and resolution of the organ.
struct GeometryScene {
  /// Stomach: procedural; Mesh: imported from a file; Sphere: for tests and benchmarks.
  enum class Kind { Stomach, Mesh, Sphere };
  Kind kind = Kind::Stomach;  ///< decides which of the keys below count
  int particles = 3618;       ///< exactly this many vertices of the mid-surface, 100 to 200,000

  double scale = 1;  ///< factor on all lengths of the organ, but not on the thickness of its wall

  // kind: stomach (procedural)
  std::string shape = "sthenic";  ///< sthenic, j, steer_horn; see stomachKnots()
  double fundus_width = 1;        ///< factor on the width of the fundus, 1 in the body (ratio)
  double antrum_angle = 0;        ///< by which the antrum turns upwards about the incisura [rad]
  double volume = 0.9e-3;         ///< enclosed volume without stress and before `scale` [m^3]

  // kind: sphere (tests and benchmarks)
  double radius = 0.05;  ///< [m]

  // kind: mesh (import)
  std::string file;          ///< OBJ, STL, PLY, glTF; relative to the scene file
  double unit = 0.0;         ///< metres per unit of the file [m]; 0: from the file's own statement, or an error
  double target_volume = 0;  ///< scale uniformly to this volume [m^3]; 0: keep the size
  std::array<double, 3> rotation_rpy{0, 0, 0};  ///< fixed-axis roll, pitch, yaw from the file's axes to ours [rad]
  std::optional<Eigen::Vector3d> oesophagus, fundus, incisura, pylorus;  ///< landmarks in the file's frame and unit
  std::optional<double> landmark_confidence;  ///< of guessed landmarks, 0 to 1, see useMesh(); empty: stated
};

/// Fibres in the wall, in two families at an angle to each side of the organ's long axis.
struct FibreScene {
  double modulus = 10e3;  ///< of each family [Pa]
  double stiffening = 1;  ///< ratio
  double angle = 0;       ///< 0: both along the organ, pi/2: both around it [rad]
};

/// Stress that relaxes at constant strain: quasi-linear viscoelasticity with a Prony series. The law of the wall is
/// that of fast strains; of its stress the share ratios[k] fades with the time times[k].
struct RelaxationScene {
  std::vector<double> ratios{0.252, 0.246};  ///< each above 0, together below 1 (ratio)
  std::vector<double> times{6.1, 43};        ///< one per ratio [s]
};

/// The sum of the ratios: the share of the stress that is gone in the end (ratio).
double relaxingShare(const RelaxationScene& relaxation);
/// What is wrong with the numbers together, for steps of a length [s]: a part of a sentence with the remedy. Empty:
/// nothing.
std::string relaxationFault(const RelaxationScene& relaxation, double step_period);

/// The wall.
struct TissueScene {
  std::string model = "shell";   ///< a word of choicesOf("tissue.model")
  std::string law = "yeoh";      ///< a word of choicesOf("tissue.law"), of model shell
  double density = 1050;         ///< [kg/m^3]
  double young_modulus = 110e3;  ///< [Pa]
  double poisson_ratio = 0.45;   ///< ratio
  double stiffening = 2.0;       ///< of the laws fung, gent and yeoh (ratio)
  std::array<double, kRegionCount> thickness{1.97e-3, 1.97e-3, 2.33e-3, 2.70e-3, 2.70e-3};  ///< per Region [m]
  std::array<double, kRegionCount> stiffness{1, 1, 1, 1, 1};  ///< factor per Region, of model shell
  std::optional<FibreScene> fibres;                           ///< of model shell
  std::optional<RelaxationScene> relaxation;                  ///< of model shell; empty: the wall is elastic
  double mass_damping = 30;                                   ///< Rayleigh damping, mass part [1/s]
  double stiffness_damping = 15e-6;  ///< Rayleigh damping, stiffness part; damps short waves [s]
  int iterations = 2;                ///< quasi-Newton iterations per step, of model shell
  double spectral_radius = 0.2;      ///< generalised-alpha, of model shell (ratio)
  bool self_contact = false;         ///< contact between walls that are pulled together, of model shell
  int substeps = 0;  ///< substeps per step, of model shape_matching; 0: the fewest that are stable, see Model
};

/// Gas in the lumen, isothermal. The insufflator raises or lowers the amount at a limited flow until the regulated
/// pressure is reached; while it is off the amount is closed in.
struct GasScene {
  double initial_pressure = 0;          ///< gauge pressure at the start [Pa]
  double regulated_pressure = 1333.22;  ///< gauge set point of the insufflator [Pa]
  double flow_limit = 5e-5;             ///< of the insufflator, at ambient pressure [m^3/s]
  bool insufflator_on = false;          ///< at the start
};

struct GravityScene {
  Eigen::Vector3d acceleration{-9.81, 0, 0};  ///< [m/s^2]; the default is a patient on the back
};

/// Neighbouring organs: springs from every particle to its position at rest.
struct FoundationScene {
  double stiffness = 5e3;      ///< per area of wall [Pa/m]
  bool carries_weight = true;  ///< the foundation balances the weight, so that the organ is at rest in its given shape
};

/// The diaphragm moves the foundation and the entry up and down; see OrganAnchors.
struct BreathingScene {
  double rate = 16.0 / 60;   ///< breaths [1/s]
  double amplitude = 20e-3;  ///< from the end of an expiration to that of an inspiration [m]
  double deformation = 0;    ///< by how much less the pylorus moves than the apex of the fundus [m]
  double inspiration = 0.5;  ///< share of a breath (ratio)
};

/// What moves a living stomach by itself; breathing as BreathingScene says, and where that is absent as
/// breathingOf() completes it.
struct MotionScene {
  int grade = 2;                  ///< of all amplitudes: 0 none, 1 slight, 2 the healthy mean, 3 strong; see gradeOf()
  double wave_rate = 0.0472;      ///< contraction waves of the antrum [1/s]
  double wave_speed = 2.7e-3;     ///< at the pylorus [m/s]
  double wave_amplitude = 7e-3;   ///< by how much the wall moves inwards at a crest [m]
  double wave_width = 14e-3;      ///< at the pylorus, full width at half height [m]
  double heart_rate = 70.0 / 60;  ///< beats [1/s]
  double heart_amplitude = 0.5e-3;  ///< of what is beside the cardia [m]
};

/// An endoscope that gives way under load, see ScopeSprings.
struct ScopeComplianceScene {
  double shaft_rigidity = 0.027;     ///< flexural, of the insertion tube [N m^2]
  double torsional_rigidity = 0.40;  ///< of the insertion tube [N m^2]
  double outer_length = 0.40;        ///< between the hand and the entry, which twists as well [m]
  double axial_stiffness = 2000;     ///< between the hand and the tip [N/m]
  double bending_stiffness = 0.3;    ///< of the bending section's wires, per total bend [N m/rad]
  double relaxation_time = 0.05;     ///< viscosity over stiffness [s]
};

/// The endoscope with its suturing device.
struct ScopeScene {
  /// Endoscope with device: a path, or an address such as resolveAddress() takes.
  std::string urdf = "package://vibe_description/urdf/scope.urdf";
  bool base_from_anatomy = true;                   ///< scope_base at the organ's entry, x axis into the lumen
  Eigen::Vector3d base_position{0, 0, 0};          ///< otherwise this position, in world [m]
  std::array<double, 3> base_rpy{0, 0, 0};         ///< and this orientation [rad]
  double friction = 0.1;                           ///< Coulomb coefficient tool on mucosa
  bool needle_arm = false;                         ///< the needle arm is a body for the wall; else it is only drawn
  std::optional<ScopeComplianceScene> compliance;  ///< empty: a rigid scope
};

/// Tissue helix: holds the particles near its tip.
struct HelixScene {
  double reach = 4e-3;              ///< grips if the wall is within this distance of the tip [m]
  double grip_radius = 5e-3;        ///< of the disc of wall that it holds, at rest [m]
  double hold_force = 8.0;          ///< slips above this force when fully turned in [N]
  double hold_turns = 3.0;          ///< turns until it is fully turned in
  double initial_hold_force = 0.5;  ///< holds without a turn [N]; between the two the force grows with the turns
};

/// Needle, thread, T-tag and cinch of the suturing device.
struct SutureScene {
  double bite_radius = 4e-3;             ///< of the disc of wall that the thread pulls on, at rest [m]
  double thread_stiffness = 323;         ///< force per strain, see polypropylene20() [N]
  double thread_friction = 0.15;         ///< Coulomb coefficient thread on tissue
  double thread_strength = 14.1;         ///< breaks above this tension [N]
  double thread_length = 1.2;            ///< of one thread, from the T-tag to where the device releases it [m]
  double pull_out_force = 8.0;           ///< tears out of a full-thickness bite above this force [N]
  int min_bites = 2;                     ///< of a set that can be cinched
  int max_bites = 32;                    ///< of a set
  double cinch_speed = 15e-3;            ///< at which the cinch draws thread [m/s]
  double cinch_tension = 3.0;            ///< at which the cinch stops drawing [N]
  double loose_tension = 0.5;            ///< a cinch released below this is loose [N]
  std::string cinch_model = "thread";    ///< how a set pulls: `thread`, or `groups` (ViBE prototype)
  double strain_limit = 0.5;             ///< of the wall at which `groups` stops drawing
  int group_particles = 5;               ///< most per group of techniques other than U and Z
  std::string classifier = "corrected";  ///< or `printed`: equation 2 of the ViBE prototype as printed
};

/// Bleeding after a bite. All values are design choices; no rates are published.
struct BleedingScene {
  double mild_probability = 0.25;   ///< of a bite
  double brisk_probability = 0.03;  ///< of a bite
  double mild_rate = 1.0e-8;        ///< [m^3/s]
  double brisk_rate = 2.5e-7;       ///< [m^3/s]
  double mild_duration = 60;        ///< after which mild bleeding stops by itself [s]
  double brisk_time = 90;           ///< within which the suture is to be completed [s]
};

/// Argon plasma coagulation from a probe in the scope.
struct MarkingScene {
  ApcParameters apc;  ///< the probe and its effect on the wall
  /// How the wall deforms while the pedal is down: `solver` keeps the tissue model, `gradient` makes the wall give way
  /// in the gradient domain (ViBE prototype).
  std::string deformation = "solver";
};

/// What of the inside of the wall counts as seen by the endoscope.
struct InspectionScene {
  double field_of_view = 140 * 0.017453292519943295;  ///< of the lens, across its picture [rad]
  double distance = 0.1;                              ///< from the lens, farther is too dark [m]
  double angle = 75 * 0.017453292519943295;  ///< between line of sight and normal; beyond, it is too oblique [rad]
};

/// Factor of a grade on amplitudes: 0, 0.5, 1, 1.25. Between waves of one person the depth has a standard deviation of
/// a quarter (58 +- 14 % of the lumen: Neurogastroenterol Motil 2001, doi 10.1046/j.1365-2982.2001.00285.x).
double gradeOf(const MotionScene& motion);

/// The content of a scene file, validated. An absent part costs nothing at run time.
struct Scene {
  std::string file;               ///< where it was read, empty if built in code
  std::string name = "unnamed";   ///< for reports and messages
  std::uint64_t seed = 1;         ///< of the random generator, 0 to 2^53 - 1 in a file; equal seeds give equal sessions
  double step_period = 1.0 / 60;  ///< simulated time per step [s]
  GeometryScene geometry;         ///< the organ
  TissueScene tissue;             ///< its wall
  bool attach_oesophagus = false;             ///< fix the particles of this end
  bool attach_duodenum = false;               ///< fix the particles of this end
  std::optional<GasScene> gas;                ///< empty: no pressure in the lumen
  std::optional<GravityScene> gravity;        ///< empty: the wall has no weight
  std::optional<FoundationScene> foundation;  ///< empty: no neighbours hold the organ
  std::optional<BreathingScene> breathing;    ///< empty: nothing breathes; needs `foundation`
  std::optional<MotionScene> motion;          ///< empty: the organ does not move by itself; needs `foundation`
  std::optional<ScopeScene> scope;            ///< empty: no tool
  std::optional<HelixScene> helix;            ///< empty: nothing can be grabbed; needs `scope`
  std::optional<SutureScene> suture;          ///< empty: the needle takes no bites; needs `helix`
  std::optional<BleedingScene> bleeding;      ///< empty: no bite bleeds; needs `suture`
  std::optional<MarkingScene> marking;        ///< empty: the pedal has no effect; needs `scope`
  std::optional<InspectionScene> inspection;  ///< empty: nobody measures what was seen; needs `scope`
  bool render_surface = false;                ///< finer render surface
};

/// How a scene breathes: as `breathing` says, else as a healthy adult to the grade of `motion`; empty: it does not.
std::optional<BreathingScene> breathingOf(const Scene& scene);

}  // namespace vibe
