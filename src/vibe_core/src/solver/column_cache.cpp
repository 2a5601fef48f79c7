#include "solver/column_cache.hpp"

#include <algorithm>

namespace vibe {

void ColumnCache::reset() {
  for (const int node : nodes_) node_slot_[static_cast<std::size_t>(node)] = -1;
  nodes_.clear();
  attachments_.clear();
  attachment_slot_.clear();
  free_.clear();
  slot_count_ = 0;
}

int ColumnCache::newSlot(int key) {
  int slot = slot_count_;
  if (!free_.empty()) {
    slot = free_.back();
    free_.pop_back();
  } else {
    ++slot_count_;
  }
  const auto size = static_cast<std::size_t>(slot_count_);
  if (columns_.size() < size) {
    columns_.resize(size);
    key_.resize(size);
    gram_.resize(at(slot_count_, 0));
    gram_known_.resize(at(slot_count_, 0));
  }
  key_[static_cast<std::size_t>(slot)] = key;
  for (int other = 0; other < slot_count_; ++other) gram_known_[at(std::max(slot, other), std::min(slot, other))] = 0;
  return slot;
}

void ColumnCache::freeSlot(int slot) {
  key_[static_cast<std::size_t>(slot)] = -1;
  free_.push_back(slot);
}

int ColumnCache::nodeSlot(const Factor& factor, int node) {
  const auto n = static_cast<std::size_t>(node);
  if (node_slot_.size() <= n) node_slot_.resize(static_cast<std::size_t>(factor.rows()) / 3, -1);
  if (node_slot_[n] < 0) {
    node_slot_[n] = newSlot(node);
    nodes_.push_back(node);
    factor.halfColumns(node, columns_[static_cast<std::size_t>(node_slot_[n])]);
  }
  return node_slot_[n];
}

void ColumnCache::makeRoom(std::size_t more) {
  if (nodes_.size() + more <= kMaxNodes) return;
  for (const int node : nodes_) {
    freeSlot(node_slot_[static_cast<std::size_t>(node)]);
    node_slot_[static_cast<std::size_t>(node)] = -1;
  }
  nodes_.clear();
}

void ColumnCache::setAttachments(const Factor& factor, const RowList<AttachmentPoint>& attachments) {
  std::size_t same = 0;
  while (same < attachments.size() && same < attachments_.size() && attachments[same] == attachments_[same]) ++same;
  for (std::size_t a = same; a < attachments_.size(); ++a) freeSlot(attachment_slot_[a]);
  attachments_.resize(same);
  attachment_slot_.resize(same);
  for (std::size_t a = same; a < attachments.size(); ++a) {
    const int slot = newSlot(kFirstAttachment + static_cast<int>(a));
    HalfColumns& sum = columns_[static_cast<std::size_t>(slot)];
    sum.begin.clear(), sum.count.clear(), sum.value.clear();
    for (std::size_t k = 0; k < attachments[a].node.size(); ++k) {
      factor.halfColumns(attachments[a].node[k], one_);
      addScaled(one_, static_cast<float>(attachments[a].weight[k]), sum);
    }
    attachments_.push_back(attachments[a]);
    attachment_slot_.push_back(slot);
  }
}

void ColumnCache::prepare(const Factor& factor, const std::vector<int>& nodes,
                          const RowList<AttachmentPoint>& attachments) {
  setAttachments(factor, attachments);
  for (const int node : nodes)
    if (nodes_.size() < kMaxNodes) nodeSlot(factor, node);
  for (int a = 0; a < slot_count_; ++a)
    for (int b = 0; b <= a; ++b) gram(a, b);
}

const Eigen::Matrix3f& ColumnCache::gram(int a, int b) {
  const std::size_t i = at(a, b);
  if (gram_known_[i] == 0) {
    gram_[i] = product(columns(a), columns(b));
    gram_known_[i] = 1;
  }
  return gram_[i];
}

// Sums in vectors of four, of which the last is no one's: it belongs to the next row.
Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b) {
  alignas(16) float sum[3][4] = {};
  Eigen::Matrix3f last = Eigen::Matrix3f::Zero();
  std::size_t i = 0, j = 0;
  const float *va = a.value.data(), *vb = b.value.data();
  while (i < a.begin.size() && j < b.begin.size()) {
    if (a.begin[i] < b.begin[j]) {
      va += 3 * a.count[i++];
    } else if (a.begin[i] > b.begin[j]) {
      vb += 3 * b.count[j++];
    } else {
      for (int r = 0; r + 1 < a.count[i]; ++r, va += 3, vb += 3)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 4; ++l) sum[k][l] += va[k] * vb[l];
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) last(k, l) += va[k] * vb[l];
      va += 3, vb += 3;
      ++i, ++j;
    }
  }
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) last(k, l) += sum[k][l];
  return last;
}

Eigen::Vector3f product(const HalfColumns& a, const float* y) {
  float sum[3] = {0, 0, 0};
  const float* value = a.value.data();
  for (std::size_t i = 0; i < a.begin.size(); ++i) {
    const float* const from = y + a.begin[i];
    for (int r = 0; r < a.count[i]; ++r, value += 3)
      for (int k = 0; k < 3; ++k) sum[k] += value[k] * from[r];
  }
  return {sum[0], sum[1], sum[2]};
}

void addProduct(const HalfColumns& a, const Eigen::Vector3f& c, float* y) {
  const float* value = a.value.data();
  for (std::size_t i = 0; i < a.begin.size(); ++i) {
    float* const to = y + a.begin[i];
    for (int r = 0; r < a.count[i]; ++r, value += 3) to[r] += value[0] * c[0] + value[1] * c[1] + value[2] * c[2];
  }
}

// Runs of both in ascending order; the same run has the same rows for every node.
void addScaled(const HalfColumns& b, float weight, HalfColumns& a) {
  HalfColumns sum;
  std::size_t i = 0, j = 0;
  const float *va = a.value.data(), *vb = b.value.data();
  while (i < a.begin.size() || j < b.begin.size()) {
    const bool from_a = j == b.begin.size() || (i < a.begin.size() && a.begin[i] <= b.begin[j]);
    const bool from_b = i == a.begin.size() || (j < b.begin.size() && b.begin[j] <= a.begin[i]);
    const std::int32_t count = from_a ? a.count[i] : b.count[j];
    sum.begin.push_back(from_a ? a.begin[i] : b.begin[j]);
    sum.count.push_back(count);
    for (std::int32_t r = 0; r < 3 * count; ++r)
      sum.value.push_back((from_a ? *va++ : 0.0F) + (from_b ? weight * *vb++ : 0.0F));
    i += from_a ? 1 : 0;
    j += from_b ? 1 : 0;
  }
  std::swap(a, sum);
}

}  // namespace vibe
