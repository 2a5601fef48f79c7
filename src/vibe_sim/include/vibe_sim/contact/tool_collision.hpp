#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_sim/contact/tool_model.hpp"

namespace vibe {

/// A particle that is nearer than the asked distance to a tool shape.
struct Contact {
  int particle = -1;
  int shape = -1;          ///< index into ToolModel::shapes()
  double distance = 0;     ///< signed distance of the particle's centre from the shape's surface, negative inside [m]
  Eigen::Vector3d normal;  ///< unit, from the shape towards the particle, in the frame of the link poses
};

/// Signed distances between particles and the tool's shapes, by Bullet (GJK / EPA on convex shapes).
/// Deterministic: contacts come in order of particle, then shape. No allocation once the buffers have grown.
class ToolCollision {
 public:
  explicit ToolCollision(const ToolModel& model) : model_(&model) {}

  /// Particles inside the shapes' bounding boxes grown by `reach`: candidates for a whole step in which neither tool
  /// nor tissue moves further than `reach` minus the contact distance. x, y, z: particle coordinates [m], (count).
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
  const ToolModel* model_;
  std::vector<Candidate> candidates_;
  std::vector<Contact> contacts_;
};

}  // namespace vibe
