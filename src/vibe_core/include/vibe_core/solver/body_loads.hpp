#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/state/stepper_memory.hpp"
#include "vibe_core/state/tool_displacement.hpp"

namespace vibe {

/// A list that is filled anew in every step. Removed elements keep their memory, so that nothing is allocated once the
/// list has grown to its largest size.
template <class T>
class RowList {
 public:
  RowList() = default;
  /// @param items  what it holds at first, in this order
  RowList(std::initializer_list<T> items) : items_(items), size_(items.size()) {}

  /// One more element, to be set completely: it may hold the values of an element that was removed.
  T& add() {
    if (size_ == items_.size()) items_.emplace_back();
    return items_[size_++];
  }
  void push_back(T item) { add() = std::move(item); }
  void clear() { size_ = 0; }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return items_[i]; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T& back() { return items_[size_ - 1]; }
  const T& back() const { return items_[size_ - 1]; }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }

 private:
  std::vector<T> items_;  // the first size_ of them
  std::size_t size_ = 0;
};

class EnergyTerm;

/// Motions of a tool that yields, in the order of ToolDisplacement, counted from where it is expected.
using YieldVector = Eigen::Matrix<double, kYieldDofs, 1>;
/// A compliance or a stiffness between these motions and their forces.
using YieldMatrix = Eigen::Matrix<double, kYieldDofs, kYieldDofs>;

/// How a tool yields to the forces of its constraints and contacts within the step:
///   displacement = free - compliance * sum over rows of (yield of the row * force of the row)
struct ToolYield {
  int dofs = 0;                                    ///< 0: a rigid tool
  YieldMatrix compliance = YieldMatrix::Zero();    ///< positive semidefinite [displacement / generalised force]
  YieldVector free = YieldVector::Zero();          ///< at the end of the step without forces of this step [m], [rad]
  YieldVector displacement = YieldVector::Zero();  ///< out: at the end of the step [m], [rad]
};

/// A point of the surface: the weighted mean of up to three nodes.
struct SurfacePoint {
  int count = 0;                        ///< number of nodes, 1 to 3; 0: no point
  std::array<int, 3> node{-1, -1, -1};  ///< their numbers, -1 behind the last one
  std::array<double, 3> weight{};       ///< sum 1

  /// The place of one node.
  static SurfacePoint ofNode(int node) { return {1, {node, -1, -1}, {1, 0, 0}}; }
};

/// A linear constraint on positions: sum over k of coefficient[k] . x[node[k]] = target - compliance * force.
/// Examples are held tissue and the weighted mean of a patch on a spring.
struct LinearConstraint {
  std::vector<int> node;                     ///< numbers of the nodes
  std::vector<Eigen::Vector3d> coefficient;  ///< ratio
  double target = 0;                         ///< [m]
  double compliance = 0;                     ///< 0: exact [m/N]
  YieldVector yield = YieldVector::Zero();   ///< motion of the target along the coefficients per ToolYield dof
  double force = 0;  ///< out: force of the constraint along its coefficients on the body, mean over the step [N]
  double work = 0;   ///< out: of this force on the body over the step [J]
};

/// A few nodes of which something outside feels the weighted mean.
struct AttachmentPoint {
  std::vector<int> node;       ///< numbers of the nodes
  std::vector<double> weight;  ///< ratio
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
  double friction = 0;          ///< Coulomb coefficient
  std::vector<double> tension;  ///< per segment, of the last step; out: of this step; 0: slack [N]
  double work = 0;              ///< out: of the thread on the body over the step [J]
};

/// A point of the surface that must not come nearer than its gap to a tool, with Coulomb friction against the tool's
/// motion.
struct ContactConstraint {
  SurfacePoint point;                                ///< that must keep its distance
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< out of the tool, unit
  double offset = 0;                                 ///< normal . x >= offset - compliance * normal force [m]
  double compliance = 0;                             ///< of the wall's thickness; 0: rigid [m/N]
  double friction = 0;                               ///< Coulomb coefficient
  double used_friction = 0;  ///< out: the coefficient that the step has used; 0 where there were too many contacts
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< where the point would be if it stuck to the tool [m]
  Eigen::Matrix<double, 3, kYieldDofs> yield =
      Eigen::Matrix<double, 3, kYieldDofs>::Zero();  ///< how far the anchor moves per coordinate in which the tool
                                                     ///< yields [m/rad], [m/m]
  Eigen::Vector3d driven = Eigen::Vector3d::Zero();  ///< how far the anchor moves per metre of needle_driver, if it
                                                     ///< is on a needle arm that is a body [m/m]
  /// Of the tool on the surface, mean over the step; in: where the solve begins. What begins with a force keeps its row
  /// and its friction where there are too many contacts [N]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double work = 0;  ///< out: of this force on the surface over the step [J]
};

constexpr double kAmbientPressure = 101325;  ///< of the surroundings, absolute: the standard atmosphere [Pa]
/// A smaller lumen counts as this, so that pressure and energy stay finite in any state [m^3].
constexpr double kSmallestVolume = 1e-9;

/// The gas inside a closed shell.
struct GasLoad {
  /// What is given: nothing (no gas), the pressure, the amount of a closed gas, the set point of an insufflator that
  /// keeps the pressure within its flow, or the volume.
  enum class Control { None, Pressure, Amount, Regulated, Volume };
  Control control = Control::None;  ///< which of the other members are given
  double pressure = 0;              ///< gauge; given for Pressure, otherwise out: where the forces of the step act [Pa]
  double amount = 0;        ///< absolute pressure times volume at the start of the step; for Amount, Regulated [J]
  double amount_min = 0;    ///< least amount at the end of the step, for Regulated [J]
  double amount_max = 0;    ///< largest amount at the end of the step, for Regulated [J]
  double set_pressure = 0;  ///< gauge, for Regulated [Pa]
  double ambient = kAmbientPressure;  ///< [Pa]
  double target_volume = 0;           ///< for Volume [m^3]
  double volume = 0;                  ///< at the start of the step; out: where the forces of the step act [m^3]
  double stiffness = 0;               ///< out: how fast the pressure falls with the volume there [Pa/m^3]
};

/// Everything that acts on the body during one step, beside its own elasticity, foundation and weight.
struct BodyLoads {
  RowList<LinearConstraint> constraints;  ///< what is held, exactly or by a spring
  RowList<ContactConstraint> contacts;    ///< of the wall with the tool
  RowList<AttachmentPoint> attachments;   ///< of the threads; those that stay from step to step keep their numbers
  RowList<ThreadLoad> threads;            ///< each runs through its own attachments
  GasLoad gas;                            ///< by default there is none
  ToolYield tool_yield;                   ///< by default the tool is rigid
  /// Contraction of the muscle of ElasticBody::shell during the step, per node (ratio); null: it is relaxed. It lives
  /// until the end of the step.
  const std::vector<float>* contraction = nullptr;
  /// A stress of ElasticBody::shell that stays as it is during the step, beside that of the law, see
  /// ShellElements::stress(); null: none. It lives until the end of the step [N/m]
  const std::vector<float>* stress = nullptr;
  double stress_work = 0;  ///< of `stress` from rest to the start of the step [J]
  /// What moves the body changes smoothly, as breath and muscle do: it goes on with its velocity, however small that
  /// is.
  bool driven = false;
  /// The hand holds the tool still: iterations go on until the motion that they leave is rest.
  bool held_still = false;
  const EnergyTerm* extra = nullptr;         ///< null: none
  std::vector<StiffnessCoupling> couplings;  ///< stiffness beside that of `extra`, for the factor of later steps

  /// Removes everything, the gas included.
  void clear();
  /// Nodes of the constraints and contacts, each once, ascending.
  void findNodes(std::vector<int>& nodes) const;
  /// Three constraints that hold the weighted mean of nodes at a target, exactly or by a spring.
  /// @param compliance  of the spring; 0: exact [m/N]
  /// @returns the index of the first of the three, for pointForce()
  std::size_t addPoint(const std::vector<int>& node, const std::vector<double>& weight, const Eigen::Vector3d& target,
                       double compliance);
  /// The force on the body of three constraints from addPoint(), mean over the step [N].
  Eigen::Vector3d pointForce(std::size_t first) const;
  /// The work of this force on the body over the step [J].
  double pointWork(std::size_t first) const;
};

}  // namespace vibe
