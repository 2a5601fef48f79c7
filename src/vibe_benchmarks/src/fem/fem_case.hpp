#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fem/bench_mesh.hpp"
#include "vibe_core/tissue/material_registry.hpp"

namespace vibe::benchmarks {

enum class ElementKind { LinearTet, QuadraticTet, Shell };

/// A weighted mean over the nodes within a radius of a point: weight (1 - r^2/a^2)^2 times the mass of the node.
struct SpotRule {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< at rest [m]
  double radius = 0;                                 ///< a [m]
  Eigen::Vector3d along = Eigen::Vector3d::Zero();   ///< r is measured perpendicular to this direction; zero: in space
};

/// Factor of a load at a level: the level itself, or 0 up to `from` and 1 from `to` on, linear between.
struct Ramp {
  double from = 0, to = 0;  ///< equal: the level itself
  double at(double level) const { return from == to ? level : std::clamp((level - from) / (to - from), 0.0, 1.0); }
};

/// Motion of a set of nodes: a rotation about an axis, then a translation, both scaled by the ramp.
struct SetMotion {
  std::string set;
  std::array<bool, 3> held{{true, true, true}};           ///< which of x, y, z are prescribed
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();       ///< point on the axis [m]
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();         ///< unit; zero: no rotation
  double angle = 0;                                       ///< [rad]
  Ramp ramp;
};

/// Moves the mean of a spot by displacement times the ramp.
struct AttachmentPull {
  std::string spot;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< [m]
  Ramp ramp;
};

/// A dead load distributed over a spot by its weights.
struct AttachmentForce {
  std::string spot;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< times the ramp [N]
  Ramp ramp;
};

/// An inextensible thread along a direction between two spots: (mean of first - mean of second) . direction.
struct Cinch {
  std::string first, second;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double distance = 0;  ///< where the ramp is 1; where it is 0, the distance is that at rest [m]
  Ramp ramp;
};

struct GasRule {
  bool by_volume = false;
  double pressure = 0;      ///< times the ramp [Pa]
  double volume_ratio = 1;  ///< ratio of the volume where the ramp is 1 to that at rest
  Ramp ramp;
};

enum class SampleKind {
  Reaction,         ///< force of the tool on a set along a direction [N]
  Torque,           ///< moment of the tool on a set about an axis [N m]
  Displacement,     ///< mean over a set, or of the nodes nearest to a point, along a direction [m]
  AttachmentForce,  ///< force on a pulled spot along a direction [N]
  Tension,          ///< of the cinch [N]
  Volume,           ///< enclosed [m^3]
  Pressure,         ///< of the gas [Pa]
  LimitPressure,    ///< largest pressure over all levels [Pa]
  Profile,          ///< displacements at points compared with a table
  Frequency,        ///< of one vibration mode, or of the oscillation of a displacement [Hz]
  Kept,             ///< ratio of the amplitude to that one period earlier
  Series,           ///< displacement over time compared with a table
  StaticField,      ///< like Profile, at the end of a transient
};

/// One quantity to report, with its reference values.
struct Sample {
  std::string name;
  SampleKind kind = SampleKind::Displacement;
  std::string set, spot;
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int mode = 0;                                  ///< of Frequency in `modes`, from 1
  double rest_volume = 0;                        ///< of Volume: the volume at rest; 0: that of the mesh [m^3]
  double until = 0;                              ///< of Series: end of the comparison; 0: the end of the run [s]
  std::string table, column;                     ///< of Profile and Series: a CSV file
  std::vector<std::optional<double>> reference;  ///< per level, or one
};

struct StaticRun {
  std::vector<double> levels;
  int substeps = 1;         ///< between two levels
  double tolerance = 1e-9;  ///< largest remaining node displacement [m]
};

struct TransientRun {
  double step = 1.0 / 60, duration = 1;  ///< [s]
  double spectral_radius = 1;
  bool backward_euler = false;
  int iterations = 3;
  double tolerance = 1e-9;                  ///< [m]
  double refactor_interval = 1.0 / 6;       ///< maximum age of the stiffness used by the steps [s]
  double start_level = 0;                   ///< start at the equilibrium of this level ...
  bool start_at_equilibrium = false;        ///< ... if true
  int start_mode = 0;                       ///< or in this mode (from 1) ...
  double start_amplitude = 0;               ///< ... with this largest displacement [m]
  std::vector<std::array<double, 2>> path;  ///< time [s], level; linear between
};

struct ModesRun {
  int count = 0;
};

/// A case as described by a file.
struct FemCase {
  std::string name, source, file;
  bool slow = false;  ///< omitted from a quick run
  BenchMesh mesh;
  ElementKind element = ElementKind::LinearTet;
  int refine = 0;
  Eigen::Vector3d project =
      Eigen::Vector3d::Zero();  ///< refined nodes are projected onto the ellipsoid with these semi-axes [m]
  Material material;
  double density = 1000, thickness = 0;
  Eigen::Vector3d thickness_along = Eigen::Vector3d::Zero();  ///< direction of `thickness`; zero: that of the normal
  double mass_damping = 0, stiffness_damping = 0, foundation = 0;
  std::vector<std::string> clamped, hinged;
  std::map<std::string, SpotRule> spots;
  std::vector<SetMotion> motions;
  std::vector<AttachmentPull> pulls;
  std::vector<AttachmentForce> forces;
  std::optional<Cinch> cinch;
  std::optional<GasRule> gas;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< times the level [m/s^2]
  std::optional<StaticRun> statics;
  std::optional<TransientRun> transient;
  std::optional<ModesRun> modes;
  std::vector<Sample> samples;
};

/// Reads a case and its mesh; mesh and table files are relative to the case's folder.
/// @throws Error "file:line: key: what is wrong; remedy"
FemCase readCase(const std::string& file);

}  // namespace vibe::benchmarks
