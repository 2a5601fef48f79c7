#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tool_contact/shape_distance.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe {

/// A particle within the requested distance of a tool shape.
struct Contact {
  int particle = -1;
  int shape = -1;          ///< index into ToolModel::shapes()
  double distance = 0;     ///< signed distance of the particle centre from the shape surface, negative inside [m]
  Eigen::Vector3d normal;  ///< unit, from the shape towards the particle, in the frame of the link poses
};

/// Signed distances between particles and the Bullet shapes of the tool (see PointDistance). Deterministic: contacts
/// are ordered by particle, then shape. No allocation once the buffers have grown. A particle whose position is not
/// finite has no contacts.
class ToolCollision {
 public:
  /// @param model  must outlive this object
  explicit ToolCollision(const ToolModel& model);

  /// Finds the pairs of particle and shape that are nearer than `reach`. These candidates are valid as long as no
  /// particle moves farther relative to the surface of a shape than `reach` minus the contact distance. x, y, z:
  /// particle coordinates [m], (count).
  /// @param link_poses  pose of every link in the frame of the particles
  void findCandidates(const std::vector<Eigen::Isometry3d>& link_poses, const double* x, const double* y,
                      const double* z, int count, double reach);

  /// Contacts among the candidates with distance < `threshold` (particle radius) at the given poses.
  const std::vector<Contact>& findContacts(const std::vector<Eigen::Isometry3d>& link_poses, const double* x,
                                           const double* y, const double* z, double threshold);

  int candidateCount() const { return static_cast<int>(candidates_.size()); }

 private:
  struct Candidate {
    int particle;
    int shape;
  };
  struct Box {
    Eigen::Vector3d lower, upper;
  };
  struct PlacedShape {
    Eigen::Matrix3d rotation;     // from the shape's frame to the particles'
    Eigen::Vector3d translation;  // of the shape's frame
    Box box;                      // around the shape, grown by the reach; only findCandidates sets it
  };
  void place(const std::vector<Eigen::Isometry3d>& link_poses);
  Box placeBoxes(double reach);
  Eigen::Vector3d toShape(int shape, const Eigen::Vector3d& p) const;

  const ToolModel* model_;
  std::vector<PointDistance> distances_;  // per shape
  std::vector<PlacedShape> placed_;       // per shape
  std::vector<Candidate> candidates_;
  std::vector<Contact> contacts_;
};

/// Calls `use` once per touched particle, with its deepest contact. Where shapes overlap, this contact leads out of
/// both.
/// @param contacts  in the order of their particles
template <class Use>
void forEachDeepest(const std::vector<Contact>& contacts, Use use) {
  for (std::size_t first = 0, next; first < contacts.size(); first = next) {
    std::size_t deepest = first;
    for (next = first + 1; next < contacts.size() && contacts[next].particle == contacts[first].particle; ++next)
      if (contacts[next].distance < contacts[deepest].distance) deepest = next;
    use(contacts[deepest]);
  }
}

}  // namespace vibe
