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

/// What an evaluation of the energy has found at one point.
struct Evaluation {
  std::vector<float> displacement;      // of the point [m]
  std::vector<float> elastic_gradient;  // of elements and foundation [N]
  std::vector<float> extra_gradient;    // of BodyLoads::extra [N]
  std::vector<float> volume_gradient;   // [m^2]
  double elastic_value = 0;             // energy of elements and foundation [J]
  double volume = 0, pressure = 0;      // [m^3], [Pa]
};

/// All memory of an ImplicitStepper. Node vectors are 4 numbers per node.
class StepperWorkspace {
 public:
  StepperWorkspace(const std::vector<Eigen::Vector3d>& rest, std::shared_ptr<const FactorPlan> elements_plan,
                   FactorStorage storage, std::shared_ptr<const BlockPattern> pattern);
  ~StepperWorkspace();

  static constexpr int kHistory = RowUnknowns::kHistory;

  std::shared_ptr<const FactorPlan> plan;  // of the elements alone
  std::unique_ptr<Factor> factor, next_factor;
  BlockMatrix matrix;                        // of the factor that is being made
  std::uint64_t factor_id = 0, next_id = 0;  // what they are about; 0: nothing
  FactorTask task;                           // of next_factor
  std::unique_ptr<BackgroundWorker> making;  // of next_factor; null: none was ever made
  ColumnCache columns, next_columns;         // of `factor`, of `next_factor`
  ConstraintSchur schur;
  std::vector<double> rest;                      // positions [m]
  std::vector<double> z, z_hat;                  // unknown, where inertia wants it [m]
  std::vector<double> trial;                     // [m]
  std::vector<float> gradient, trial_gradient;   // [N]
  Evaluation last, first, kept;                  // of a step; `kept`: at z, while a trial is evaluated
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
  double gas_stiffness = 0;   // at the end of a step [Pa/m^3]
};

}  // namespace vibe
