#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "tissue/elastic_elements.hpp"

namespace vibe {

class EnergyTerm;
class ShellElements;

/// A soft body as an implicit solver sees it. Constant.
struct ElasticBody {
  std::shared_ptr<const ElasticElements> elements;
  const ShellElements* shell = nullptr;               ///< the same elements where they enclose gas; null: no gas
  std::vector<Eigen::Vector3d> rest;                  ///< of the nodes [m]
  std::vector<double> mass;                           ///< lumped, per node [kg]
  std::vector<char> fixed;                            ///< per node: it never moves
  std::vector<double> foundation;                     ///< spring from each node to its rest position [N/m]; empty: none
  std::vector<Eigen::Vector3d> load;                  ///< dead load per node [N]; empty: none
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double mass_damping = 0;                            ///< force -rate m v [1/s]
  double stiffness_damping = 0;                       ///< force -time K v: the time constant of the tissue [s]

  int nodeCount() const { return static_cast<int>(rest.size()); }
};

/// The motion of the nodes, structure of arrays (nodeCount) [m], [m/s], [m/s^2]; views into a State or a BodyMotion.
struct MotionView {
  std::array<double*, 3> x, v, a;
};

/// The same with its own memory.
struct BodyMotion {
  explicit BodyMotion(const ElasticBody& body);  ///< at rest
  MotionView view();
  std::array<std::vector<double>, 3> x, v, a;
};

/// A linear condition on positions: sum over k of coefficient[k] . x[node[k]] = target - compliance * force.
/// What the tool holds, what a suture pulls together, and weighted means of spots are conditions.
struct LinearConstraint {
  std::vector<int> node;
  std::vector<Eigen::Vector3d> coefficient;  ///< [1]
  double target = 0;                         ///< [m]
  double compliance = 0;                     ///< 0: exact [m/N]
  double force = 0;  ///< out: with which the condition acts along its coefficients on the body [N]
};

/// A few nodes of which something outside feels the weighted mean.
struct AttachmentPoint {
  std::vector<int> node;
  std::vector<double> weight;  ///< [1]
  bool operator==(const AttachmentPoint& other) const { return node == other.node && weight == other.weight; }
};

/// Length of thread that stays between two spots, however hard it is drawn: a fold of the wall lies between them, twice
/// as thick as the wall (about 2.3 mm) [m].
constexpr double kMinThread = 5e-3;

/// A thread without mass or bending that runs through spots and pulls where it is tense. It slides through the spots
/// between its ends with Coulomb friction (capstan).
struct ThreadLoad {
  int first_attachment = 0;     ///< of BodyLoads::spots; the others follow in the order along the thread
  std::vector<double> length;   ///< of thread per segment, unstretched; out: after it has slid [m]
  double stiffness = 0;         ///< force per strain [N]
  double friction = 0;          ///< Coulomb coefficient [1]
  std::vector<double> tension;  ///< per segment, that of the step before; out: of this one; 0: slack [N]
};

/// A node that must not come nearer than its gap to a tool, with Coulomb friction against the tool's motion.
struct ContactConstraint {
  int node = -1;
  Eigen::Vector3d normal;                           ///< out of the tool, unit
  double offset = 0;                                ///< normal . x >= offset [m]
  double friction = 0;                              ///< Coulomb coefficient [1]
  Eigen::Vector3d anchor;                           ///< where the node would be if it stuck to the tool [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< out: tool on node [N]
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

/// Everything that acts on the body during one step.
struct BodyLoads {
  std::vector<LinearConstraint> constraints;
  std::vector<ContactConstraint> contacts;
  std::vector<AttachmentPoint> attachments;  ///< of the threads; those that stay from step to step keep their numbers
  std::vector<ThreadLoad> threads;
  GasLoad gas;
  const EnergyTerm* extra = nullptr;  ///< null: none
};

}  // namespace vibe
