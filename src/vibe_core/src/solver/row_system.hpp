#pragma once

#include <utility>
#include <vector>

#include "solver/constraint_rows.hpp"
#include "solver/constraint_schur.hpp"

namespace vibe {

/// The rows of a solve: constraints, contacts and threads, with their unknowns. Built by buildRows(), eliminated by
/// `schur`, advanced by QuasiNewton; valid until the next solve.
struct RowSystem {
  ConstraintRows rows;
  ConstraintSchur schur;
  RowUnknowns unknowns;
  Eigen::VectorXd target;     // value that each row is to have at z [m]
  Eigen::VectorXd rhs;        // how far each is from it [m]
  Eigen::VectorXd row_moves;  // of the last direction, beyond what rows give way, to the scale of the rows [m]
  Eigen::VectorXd work;       // of each row over the step [J]
  std::vector<std::pair<double, std::size_t>> contact_order;  // see limitContacts()
};

}  // namespace vibe
