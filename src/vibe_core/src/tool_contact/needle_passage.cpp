#include "tool_contact/needle_passage.hpp"

#include <algorithm>

namespace vibe {

NeedlePassage::NeedlePassage(const ToolModel& tool, const std::vector<double>& thickness) : tool_(tool) {
  if (!tool.needleLinkage()) return;
  thickness_ = thickness;
  open_.resize(thickness.size());
  for (const ToolShape& shape : tool.shapes())
    of_arm_.push_back(shape.link == tool.needleLinkage()->arm || shape.link == tool.needleLinkage()->hook ? 1 : 0);
}

// Share of its range that the needle's point has gone.
double NeedlePassage::driver(const std::vector<Eigen::Isometry3d>& poses) const {
  const NeedleLinkage& linkage = *tool_.needleLinkage();
  const ToolJoint& needle = tool_.joints()[static_cast<std::size_t>(tool_.joints()[linkage.hook - 1].parent_link) - 1];
  const Eigen::Isometry3d origin = poses[needle.parent_link] * needle.origin;
  const Eigen::Vector3d way = poses[needle.child_link].translation() - origin.translation();
  return (way.dot(origin.linear() * needle.axis) - linkage.lower) / (linkage.upper - linkage.lower);
}

void NeedlePassage::open(const std::vector<Eigen::Isometry3d>& poses, bool leads, const SweptTool& shapes,
                         const SurfacePath& path, const std::vector<std::array<int, 3>>& triangles,
                         std::vector<NearTriangles::Pair>& near) {
  if (of_arm_.empty()) return;
  const double gone = driver(poses);
  closed_ = gone >= kClosedShare;
  bites_ = leads && gone >= kFreeSwing;
  const NeedleLinkage& linkage = *tool_.needleLinkage();
  const int needle = tool_.joints()[linkage.hook - 1].parent_link;
  const ToolJoint& joint = tool_.joints()[static_cast<std::size_t>(needle) - 1];
  way_ = {poses[needle].translation(), poses[joint.parent_link] * (joint.origin * (linkage.upper * joint.axis))};
  const auto isOfArm = [this](const NearTriangles::Pair& pair) { return of_arm_[pair.shape] != 0; };
  std::fill(open_.begin(), open_.end(), 0);
  for (const NearTriangles::Pair& pair : near)
    if (!closed_ && isOfArm(pair) && isOpening(shapes, pair, path, triangles[pair.triangle]))
      for (const int vertex : triangles[pair.triangle]) open_[vertex] = 1;
  const auto passes = [&](const NearTriangles::Pair& pair) {
    const std::array<int, 3>& n = triangles[pair.triangle];
    return isOfArm(pair) && (closed_ || open_[n[0]] != 0 || open_[n[1]] != 0 || open_[n[2]] != 0);
  };
  near.erase(std::remove_if(near.begin(), near.end(), passes), near.end());
}

bool NeedlePassage::isOpening(const SweptTool& shapes, const NearTriangles::Pair& pair, const SurfacePath& path,
                              const std::array<int, 3>& triangle) const {
  const std::array<Eigen::Vector3d, 3> corners{path.start(triangle[0]), path.start(triangle[1]),
                                               path.start(triangle[2])};
  if (shapes.gap(pair.shape, 0, corners).distance == 0) return true;
  const double half = (thickness_[triangle[0]] + thickness_[triangle[1]] + thickness_[triangle[2]]) / 6;
  return bites_ && segmentTriangleGap(way_[0], way_[1], corners).distance < half;
}

}  // namespace vibe
