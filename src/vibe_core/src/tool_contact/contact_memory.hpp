#pragma once

#include <vector>

#include "tool_contact/surface_contacts.hpp"
#include "vibe_core/state/hold_memory.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Lets a wall come to rest under a tool that the hand holds still.
///
/// Which points touch which shapes, along which normals, follows from where the wall is. Where it changes from step to
/// step, the wall may go to and fro for good between two sets of contacts, each of which is in equilibrium only where
/// the other holds. While the hand holds, a contact therefore stays as it was found, in the frame of its link, until
/// its point has left the ball of a small radius about where it was then. What is found beside these is added. Contacts
/// are of finitely many points, so that from some moment on none changes unless something moves the wall by more than
/// that radius: the tool is a set of fixed half-spaces then, and elastic tissue that loses energy between them rests.
class ContactMemory {
 public:
  /// @param tool  must outlive this
  explicit ContactMemory(const ToolModel& tool) : tool_(tool) {}

  /// The contacts of a step.
  /// @param found     those that follow from where the wall is, ordered by nodes
  /// @param poses     of the links
  /// @param state     at the start of the step; State::hold has what was kept
  /// @param radius    of the ball [m]
  /// @param excluded  per vertex: a contact is not kept there
  /// @returns the contacts as they count; valid until the next call
  const std::vector<SurfaceContact>& recall(const std::vector<SurfaceContact>& found, const ToolPoses& poses,
                                            const State& state, double radius, const std::vector<char>& excluded);
  /// What the next step is to keep of the contacts of the last recall(), with the forces of the step before.
  const std::vector<KeptContact>& kept() const { return next_; }

 private:
  int linkOf(int shape) const { return tool_.shapes()[static_cast<std::size_t>(shape)].link; }
  void findNear(const std::vector<KeptContact>& kept, const ToolPoses& poses, const State& state, double radius);
  int match(const std::vector<KeptContact>& kept, const SurfaceContact& contact) const;
  void keep(const KeptContact& contact, const ToolPoses& poses);
  void take(const SurfaceContact& contact, const ToolPoses& poses, const State& state, const Eigen::Vector3d& force);

  const ToolModel& tool_;
  std::vector<int> order_;         // of what was kept, by point and shape
  std::vector<char> near_, used_;  // of each: its point is within the ball; it was found
  std::vector<KeptContact> next_;
  std::vector<SurfaceContact> contacts_;
};

/// Where a point of the wall is [m].
Eigen::Vector3d positionOf(const SurfacePoint& point, const State& state);

}  // namespace vibe
