#pragma once

#include <Eigen/Core>
#include <vector>

#include "vibe_core/solver/row_list.hpp"

namespace vibe {

class EnergyTerm;

/// A linear constraint on positions: sum over k of coefficient[k] . x[node[k]] = target - compliance * force.
/// Examples are held tissue and the weighted mean of a patch on a spring.
struct LinearConstraint {
  std::vector<int> node;
  std::vector<Eigen::Vector3d> coefficient;  ///< [1]
  double target = 0;                         ///< [m]
  double compliance = 0;                     ///< 0: exact [m/N]
  double force = 0;  ///< out: force of the constraint along its coefficients on the body, mean over the step [N]
};

/// A few nodes of which something outside feels the weighted mean.
struct AttachmentPoint {
  std::vector<int> node;
  std::vector<double> weight;  ///< [1]
  bool operator==(const AttachmentPoint& other) const { return node == other.node && weight == other.weight; }
};

/// Length of thread that stays between two attachment points, however hard it is drawn: a fold of the wall lies between
/// them, twice as thick as the wall (about 2.3 mm) [m].
constexpr double kMinThread = 5e-3;

/// A thread without mass or bending stiffness that runs through attachment points and pulls where it is tense. It
/// slides through the points between its ends with Coulomb friction (capstan).
struct ThreadLoad {
  int first_attachment = 0;     ///< index into BodyLoads::attachments; the others follow in the order along the thread
  std::vector<double> length;   ///< unstretched, per segment; out: after sliding [m]
  double stiffness = 0;         ///< force per strain [N]
  double friction = 0;          ///< Coulomb coefficient [1]
  std::vector<double> tension;  ///< per segment, of the last step; out: of this step; 0: slack [N]
};

/// A node that must not come nearer than its gap to a tool, with Coulomb friction against the tool's motion.
struct ContactConstraint {
  int node = -1;
  Eigen::Vector3d normal;                           ///< out of the tool, unit
  double offset = 0;                                ///< normal . x >= offset [m]
  double friction = 0;                              ///< Coulomb coefficient [1]
  Eigen::Vector3d anchor;                           ///< where the node would be if it stuck to the tool [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< out: tool on node, mean over the step [N]
};

/// The gas inside a closed shell.
struct GasLoad {
  enum class Control { None, Pressure, Amount, Volume };
  Control control = Control::None;
  double pressure = 0;       ///< gauge; given for Pressure, otherwise out [Pa]
  double amount = 0;         ///< absolute pressure times volume, for Amount [J]
  double ambient = 101325;   ///< [Pa]
  double target_volume = 0;  ///< for Volume [m^3]
  double volume = 0;         ///< out [m^3]
};

/// Everything that acts on the body during one step, beside its own elasticity, foundation and weight.
struct BodyLoads {
  RowList<LinearConstraint> constraints;
  RowList<ContactConstraint> contacts;
  RowList<AttachmentPoint> attachments;  ///< of the threads; those that stay from step to step keep their numbers
  RowList<ThreadLoad> threads;
  GasLoad gas;
  const EnergyTerm* extra = nullptr;  ///< null: none

  /// Removes everything, the gas included.
  void clear();
  /// Three constraints that hold the weighted mean of nodes at a target, exactly or by a spring.
  /// @param compliance  of the spring; 0: exact [m/N]
  /// @returns the index of the first of the three, for pointForce()
  std::size_t addPoint(const std::vector<int>& node, const std::vector<double>& weight, const Eigen::Vector3d& target,
                       double compliance);
  /// The force on the body of three constraints from addPoint(), mean over the step [N].
  Eigen::Vector3d pointForce(std::size_t first) const;
};

}  // namespace vibe
