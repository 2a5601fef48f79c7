#pragma once
#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

class SelfContact;

/// Two points of the wall that press on each other.
struct WallContact {
  std::array<int, 4> node;  ///< of both points together; -1: fewer
  std::array<double, 4>
      weight;              ///< above 0 at the nodes of the first point, below 0 at those of the second; sums 1, -1
  Eigen::Vector3d point;   ///< half way between the two, world [m]
  Eigen::Vector3d normal;  ///< unit, from the second point to the first, world
  double distance;         ///< of the two on the mid-surface [m]
  double force;            ///< with which they press on each other along the normal, without friction [N]
};

/// Where the wall of an organ touches itself, as the contact of the simulation sees it.
class WallContacts {
 public:
  /// @throws Error as the contact itself, for a wall without thickness or stiffness
  explicit WallContacts(const Model& model);
  ~WallContacts();

  /// The pairs of points of the wall that are in contact, from the state alone; none in a scene without self-contact.
  /// @returns valid until the next call
  const std::vector<WallContact>& find(const State& state);

 private:
  std::unique_ptr<SelfContact> contact_;  // null: without
  std::vector<WallContact> found_;
};

}  // namespace vibe
