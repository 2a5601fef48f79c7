#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/tissue/elastic_elements.hpp"

namespace vibe {

class ShellElements;

/// A soft body as an implicit solver sees it. Constant.
struct ElasticBody {
  std::shared_ptr<const ElasticElements> elements;    ///< its stored energy as a function of displacements from `rest`
  const ShellElements* shell = nullptr;               ///< the same elements where they enclose gas; null: no gas
  std::vector<Eigen::Vector3d> rest;                  ///< of the nodes [m]
  std::vector<double> mass;                           ///< lumped, per node [kg]
  std::vector<char> fixed;                            ///< per node: it never moves
  std::vector<double> foundation;                     ///< spring from each node to its rest position [N/m]; empty: none
  std::vector<Eigen::Vector3d> load;                  ///< dead load per node [N]; empty: none
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double mass_damping = 0;                            ///< force -rate m v [1/s]
  double stiffness_damping = 0;                       ///< force -time K v: the time constant of the tissue [s]

  int nodeCount() const { return static_cast<int>(rest.size()); }  ///< fixed ones included
};

/// The motion of the nodes, structure of arrays (nodeCount) [m], [m/s], [m/s^2]; views into a State or a BodyMotion.
struct MotionView {
  std::array<double*, 3> x, v, a;  ///< positions, velocities, accelerations: an array per axis, not owned
};

/// The same with its own memory.
struct BodyMotion {
  explicit BodyMotion(const ElasticBody& body);  ///< at rest
  MotionView view();                             ///< of the vectors below, as long as they live and keep their size
  std::array<std::vector<double>, 3> x, v, a;    ///< per axis and node [m], [m/s], [m/s^2]
};

}  // namespace vibe
