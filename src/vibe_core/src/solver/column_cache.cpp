#include "solver/column_cache.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "solver/half_columns.hpp"

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

bool ColumnCache::hasSlot(int node) const {
  return static_cast<std::size_t>(node) < node_slot_.size() && node_slot_[static_cast<std::size_t>(node)] >= 0;
}

void ColumnCache::makeRoom(const std::vector<int>& nodes) {
  const auto known = std::count_if(nodes.begin(), nodes.end(), [this](int node) { return hasSlot(node); });
  if (nodes_.size() + nodes.size() - static_cast<std::size_t>(known) <= kMaxNodes) return;
  const auto forget = [&](int node) {
    if (std::binary_search(nodes.begin(), nodes.end(), node)) return false;
    freeSlot(node_slot_[static_cast<std::size_t>(node)]);
    node_slot_[static_cast<std::size_t>(node)] = -1;
    return true;
  };
  nodes_.erase(std::remove_if(nodes_.begin(), nodes_.end(), forget), nodes_.end());
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
  std::vector<int> slots(static_cast<std::size_t>(slot_count_));
  std::iota(slots.begin(), slots.end(), 0);
  for (std::size_t a = 0; a < slots.size(); ++a) makeGrams(slots[a], slots, a + 1);
}

void ColumnCache::makeGrams(int one, const std::vector<int>& slots, std::size_t count) {
  const auto make = [this, one](int slot, const Eigen::Matrix3f& product) {
    const std::size_t i = at(std::max(one, slot), std::min(one, slot));
    gram_[i] = slot < one ? Eigen::Matrix3f(product.transpose()) : product;
    gram_known_[i] = 1;
  };
  std::array<int, kProducts> slot;
  std::array<const HalfColumns*, kProducts> column;
  std::array<Eigen::Matrix3f, kProducts> product;
  std::size_t waiting = 0;
  for (std::size_t s = 0; s < count; ++s) {
    if (gram_known_[at(std::max(one, slots[s]), std::min(one, slots[s]))] != 0) continue;
    slot[waiting] = slots[s], column[waiting] = &columns(slots[s]);
    if (++waiting < kProducts) continue;
    productsOf(column, columns(one), product.data());
    for (std::size_t c = 0; c < kProducts; ++c) make(slot[c], product[c]);
    waiting = 0;
  }
  for (std::size_t c = 0; c < waiting; ++c) make(slot[c], vibe::product(*column[c], columns(one)));
}

}  // namespace vibe
