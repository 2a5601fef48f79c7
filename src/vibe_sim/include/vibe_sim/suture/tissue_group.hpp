#pragma once
#include <Eigen/Core>
#include <vector>

namespace vibe {

struct Model;
struct State;
struct Suture;

/// The particles that a set draws to the middle of its bites, as the ViBE prototype pulls tissue (section 2.1.3 of its
/// paper), made a force: a spring from each of them to its place, and the reaction on the bites, so that a set pushes
/// the organ nowhere. The middle is the mean of the bites as they were when the cinch began, and moves with them.
struct TissueGroup {
  std::vector<int> particle;            ///< rising
  std::vector<Eigen::Vector3d> offset;  ///< from the middle when the cinch began, turned with the set since [m]
  std::vector<int> middle;              ///< particles whose weighted mean is the middle
  std::vector<double> weight;           ///< of them, sum 1
  double drawn = 0;                     ///< part of the way to the middle that is done, 0 to 1

  bool empty() const { return particle.empty(); }
};

/// Finds the group of a set whose technique is recognised: all of indexGroups(), with the whole legs of a U.
/// @throws vibe::Error  as indexGroups() does
void findGroup(const Model& model, const State& state, Suture& suture);

/// Greatest change of length, lengthening or shortening, of the sides of triangles at the group's particles, over their
/// length at rest [1]. Compared with scene.suture->strain_limit it stands for the elastic limit.
double groupStrain(const Model& model, const State& state, const TissueGroup& group);

/// Draws the farthest particle of a set's group `amount` nearer to the middle, the others by the same part [m].
/// @return what was drawn, less where they have arrived [m]
double drawGroup(double amount, Suture& suture);

/// Where a group's middle is [m].
Eigen::Vector3d middleOf(const TissueGroup& group, const State& state);

/// The springs become as long as they are: for tissue that was put back to rest.
void slackenGroup(const State& state, TissueGroup& group);

}  // namespace vibe
