#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/elastic_body.hpp"
#include "sparse/factor.hpp"

namespace vibe {

/// What the elimination needs of spots about one factor: each spot's columns, which are the weighted sum of those of
/// its nodes, and their products. Made beside the factor, in the background, so that many sutures cost a step little.
struct AttachmentColumns {
  std::vector<AttachmentPoint> attachments;
  std::vector<HalfColumns> columns;
  std::vector<Eigen::Matrix3f> gram;  ///< of spots a >= b, row after row

  static std::size_t at(std::size_t a, std::size_t b) { return a * (a + 1) / 2 + b; }
};

/// @param columns  changed in place; keeps what it knows of spots at the head of the list that are the same
void extendAttachmentColumns(const Factor& factor, const RowList<AttachmentPoint>& attachments,
                             AttachmentColumns& columns);

/// Product of two sparse vectors: both consist of whole runs; those on the common part of the paths are the same runs.
Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b);
/// Product with a dense vector.
Eigen::Vector3f product(const HalfColumns& a, const float* y);
/// Weighted sum of the columns of a spot's nodes.
HalfColumns attachmentColumns(const Factor& factor, const AttachmentPoint& attachment);

}  // namespace vibe
