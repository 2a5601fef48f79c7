#include "solver/attachment_columns.hpp"

#include <algorithm>
#include <map>

namespace vibe {

Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b) {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  std::size_t i = 0, j = 0, at_a = 0, at_b = 0;
  while (i < a.begin.size() && j < b.begin.size()) {
    const auto size_a = static_cast<std::size_t>(a.count[i]), size_b = static_cast<std::size_t>(b.count[j]);
    if (a.begin[i] == b.begin[j]) {
      using Rows = Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>;
      sum += Rows(&a.value[3 * at_a], 3, a.count[i]) * Rows(&b.value[3 * at_b], 3, b.count[j]).transpose();
      at_a += size_a, at_b += size_b, ++i, ++j;
    } else if (a.begin[i] < b.begin[j]) {
      at_a += size_a, ++i;
    } else {
      at_b += size_b, ++j;
    }
  }
  return sum;
}

Eigen::Vector3f product(const HalfColumns& a, const float* y) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  const float* value = a.value.data();
  for (std::size_t i = 0; i < a.begin.size(); ++i)
    for (int k = 0; k < a.count[i]; ++k, value += 3) {
      const float factor = y[a.begin[i] + k];
      sum += factor * Eigen::Vector3f(value[0], value[1], value[2]);
    }
  return sum;
}

HalfColumns attachmentColumns(const Factor& factor, const AttachmentPoint& attachment) {
  HalfColumns one, sum;
  std::map<std::int32_t, std::vector<float>> runs;  // by first row: the same run has the same rows for every node
  for (std::size_t k = 0; k < attachment.node.size(); ++k) {
    factor.halfColumns(attachment.node[k], one);
    const auto weight = static_cast<float>(attachment.weight[k]);
    const float* value = one.value.data();
    for (std::size_t r = 0; r < one.begin.size(); ++r) {
      const std::size_t size = 3 * static_cast<std::size_t>(one.count[r]);
      std::vector<float>& run = runs[one.begin[r]];
      run.resize(size, 0.0F);
      for (std::size_t i = 0; i < size; ++i) run[i] += weight * value[i];
      value += size;
    }
  }
  for (const auto& [begin, run] : runs) {
    sum.begin.push_back(begin);
    sum.count.push_back(static_cast<std::int32_t>(run.size() / 3));
    sum.value.insert(sum.value.end(), run.begin(), run.end());
  }
  return sum;
}

void extendAttachmentColumns(const Factor& factor, const RowList<AttachmentPoint>& attachments,
                             AttachmentColumns& columns) {
  std::size_t same = 0;
  while (same < attachments.size() && same < columns.attachments.size() &&
         attachments[same] == columns.attachments[same])
    ++same;
  if (same == attachments.size() && same == columns.attachments.size()) return;
  columns.attachments.resize(same);
  columns.columns.resize(same);
  columns.gram.resize(AttachmentColumns::at(same, 0));
  for (std::size_t a = same; a < attachments.size(); ++a) {
    columns.attachments.push_back(attachments[a]);
    columns.columns.push_back(attachmentColumns(factor, attachments[a]));
    for (std::size_t b = 0; b <= a; ++b) columns.gram.push_back(product(columns.columns[a], columns.columns[b]));
  }
}

}  // namespace vibe
