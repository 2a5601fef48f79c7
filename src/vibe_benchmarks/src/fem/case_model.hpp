#pragma once
#include <utility>
#include <vector>

#include "fem/fem_case.hpp"
#include "vibe_core/solver/elastic_body.hpp"

namespace vibe::benchmarks {

/// A weighted mean over nodes; the weights sum to 1.
struct NodeMean {
  std::vector<int> node;
  std::vector<double> weight;
};

/// How a case prescribes the motion of nodes.
enum class Hold {
  AsFixed,      ///< fixed nodes that the caller moves: exact, for statics
  AsConditions  ///< three conditions per node: for transient runs
};

/// The elastic body of a case on its refined mesh, and its loads at any level.
class CaseModel {
 public:
  CaseModel(const FemCase& bench_case, Hold hold);

  const FemCase& benchCase() const { return case_; }
  const BenchMesh& mesh() const { return mesh_; }
  int nodeCount() const { return static_cast<int>(mesh_.nodes.size()); }
  const std::vector<int>& set(const std::string& name) const { return mesh_.sets.at(name); }
  const NodeMean& spot(const std::string& name) const { return spots_.at(name); }

  /// Gravity and dead loads are part of the body, so it depends on the level.
  ElasticBody body(double level) const;
  bool bodyDependsOnLevel() const { return case_.gravity.norm() > 0 || !case_.forces.empty(); }
  /// Conditions (the cinch, then three per pull, then held directions of sets) and gas.
  BodyLoads loads(double level) const;
  /// Positions of the prescribed fixed nodes at a level; (node, position).
  std::vector<std::pair<int, Eigen::Vector3d>> prescribed(double level) const;
  /// Interpolates in the rest element that contains the point, or in the nearest one.
  NodeMean at(const Eigen::Vector3d& point) const;
  double restVolume() const;  ///< enclosed by the triangles [m^3]

 private:
  void build();
  /// Per node: the integral over the body of the weight of the spot and the node's shape function, lumped for
  /// tetrahedra; up to a factor.
  std::vector<double> spotWeights(const SpotRule& rule) const;
  NodeMean makeSpot(const SpotRule& rule) const;
  NodeMean atTriangle(const Eigen::Vector3d& point) const;
  NodeMean atTet(const Eigen::Vector3d& point) const;
  Eigen::Vector3d moved(const SetMotion& motion, const Eigen::Vector3d& rest, double level) const;
  bool isFixedMotion(const SetMotion& motion) const;
  void addPullConstraints(double level, BodyLoads& loads) const;
  void addMotionConstraints(double level, BodyLoads& loads) const;

  const FemCase& case_;
  Hold hold_;
  BenchMesh mesh_;
  std::vector<std::array<int, 10>> quadratic_;
  ElasticBody body_;
  std::map<std::string, NodeMean> spots_;
};

/// Builds the shell of a case with its elements, masses and gas.
void buildShell(const FemCase& bench_case, const BenchMesh& mesh, ElasticBody& body);

}  // namespace vibe::benchmarks
