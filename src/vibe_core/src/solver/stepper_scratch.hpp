#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/background_worker.hpp"
#include "solver/constraint_schur.hpp"
#include "solver/row_unknowns.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

struct FactorSchedule;

/// What the factor that is made in the background is to be about.
struct FactorTask {
  const FactorSchedule* schedule = nullptr;
  const ElasticBody* body = nullptr;
  std::vector<float> positions;  // (3 * nodes) [m]
  std::vector<StiffnessCoupling> couplings;
  std::vector<int> nodes;  // whose columns are prepared too
  RowList<AttachmentPoint> attachments;
};

/// All memory of an ImplicitStepper. Node vectors are 4 numbers per node.
class StepperScratch {
 public:
  StepperScratch(const std::vector<Eigen::Vector3d>& rest, std::shared_ptr<const FactorPlan> elements_plan,
                 FactorStorage storage, std::shared_ptr<const BlockPattern> pattern);
  ~StepperScratch();

  static constexpr int kHistory = RowUnknowns::kHistory;

  std::shared_ptr<const FactorPlan> plan;  // of the elements alone
  std::unique_ptr<Factor> factor, next_factor;
  BlockMatrix matrix;                        // of the factor that is being made
  std::uint64_t factor_id = 0, next_id = 0;  // what they are about; 0: nothing
  FactorTask task;                           // of next_factor
  std::unique_ptr<BackgroundWorker> making;  // of next_factor; null: none was ever made
  ColumnCache columns, next_columns;         // of `factor`, of `next_factor`
  ConstraintSchur schur;
  std::vector<double> rest;                     // positions [m]
  std::vector<double> z, z_hat;                 // unknown, where inertia wants it [m]
  std::vector<double> trial;                    // [m]
  std::vector<float> displacement;              // of the point under evaluation [m]
  std::vector<float> gradient, trial_gradient;  // [N]
  std::vector<float> elastic_gradient;          // its part from elements and foundation [N]
  std::vector<float> extra_gradient;            // its part from BodyLoads::extra [N]
  std::vector<float> first_displacement;        // the same of the first point of a step
  std::vector<float> first_elastic_gradient, first_extra_gradient;
  std::vector<float> volume_gradient;            // [m^2]
  std::vector<float> direction, work;            // [m]
  std::vector<float> half;                       // in elimination order
  std::vector<std::vector<float>> move, change;  // L-BFGS pairs
  std::vector<double> curvature;                 // 1 / (move . change)
  int pairs = 0;
  ConstraintRows rows;
  std::vector<std::pair<double, std::size_t>> contact_order;  // see limitContacts()
  Eigen::VectorXd target, rhs, force;
  RowUnknowns unknowns;
  Eigen::VectorXd row_moves;  // of the last direction, beyond what rows give way, to the scale of the rows [m]
  Eigen::VectorXd slid;       // thread that slid out of a row in this step, to the scale of the rows [m]
  /// Keeps what the first evaluation of a step has found.
  void keepFirst() {
    first_displacement = displacement;
    first_elastic_gradient.swap(elastic_gradient);
    first_extra_gradient.swap(extra_gradient);
    first_elastic_value = elastic_value;
    only_first = true;
  }
  /// The first evaluation was the last one too.
  void repeatFirst() {
    elastic_gradient = first_elastic_gradient;
    extra_gradient = first_extra_gradient;
  }
  /// Exchanges what the last evaluation has found with what is kept: before a trial, and again where it is rejected.
  void exchangeEvaluations();
  double elastic_value = 0, first_elastic_value = 0;  // energy of elements and foundation [J]
  bool only_first = true;                             // nothing was evaluated since
  double volume = 0, pressure = 0;                    // of the point under evaluation
  double gas_stiffness = 0;                           // there, after a step [Pa/m^3]

 private:
  std::vector<float> kept_displacement_, kept_elastic_gradient_, kept_extra_gradient_, kept_volume_gradient_;
  double kept_elastic_value_ = 0, kept_volume_ = 0, kept_pressure_ = 0;
  bool kept_only_first_ = true;
};

}  // namespace vibe
