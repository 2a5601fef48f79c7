#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/sparse/factor.hpp"

namespace vibe {

/// What the elimination of constraints needs of single nodes and of attachment points about one factor: their columns
/// (an attachment point has the weighted sum of those of its nodes) and the products of columns. Each is computed once;
/// what a step needs that begins with a new factor is prepared beside the factor, in the background. The values do not
/// depend on when, or in which order, they were computed.
class ColumnCache {
 public:
  /// Forgets everything about the old factor; keeps its memory.
  void reset();
  /// Columns of the nodes and attachment points, and all products between them.
  void prepare(const Factor& factor, const std::vector<int>& nodes, const RowList<AttachmentPoint>& attachments);
  /// The list of attachment points. What is known of those at the head that are the same is kept.
  void setAttachments(const Factor& factor, const RowList<AttachmentPoint>& attachments);
  /// Forgets other nodes where these would be more than it keeps.
  /// @param nodes  that are needed next, in ascending order
  void makeRoom(const std::vector<int>& nodes);

  /// Slots are numbers of columns, valid until reset(), makeRoom() or another list of attachment points.
  int nodeSlot(const Factor& factor, int node);
  int attachmentSlot(int attachment) const { return attachment_slot_[static_cast<std::size_t>(attachment)]; }
  const HalfColumns& columns(int slot) const { return columns_[static_cast<std::size_t>(slot)]; }
  /// Orders slots by node, then by attachment point, whatever was first.
  int key(int slot) const { return key_[static_cast<std::size_t>(slot)]; }
  /// Product of the columns of two slots, a >= b: compliance of the point of `a` by a force on that of `b` [m/N].
  /// makeGrams() has made it.
  const Eigen::Matrix3f& gram(int a, int b) const { return gram_[at(a, b)]; }
  /// Those of a slot with the first ones of a list, as far as they are not known.
  void makeGrams(int one, const std::vector<int>& slots, std::size_t count);

 private:
  // Design choice: more than the 384 nodes that 128 contacts have at most; the products of so many take 4.7 MB.
  static constexpr int kMaxNodes = 512;
  static constexpr int kFirstAttachment = 1 << 28;  // keys from here on
  int newSlot(int key);
  void freeSlot(int slot);
  bool hasSlot(int node) const;
  static std::size_t at(int a, int b) {
    return static_cast<std::size_t>(a) * (static_cast<std::size_t>(a) + 1) / 2 + static_cast<std::size_t>(b);
  }

  std::vector<int> node_slot_;  // of nodes seen; -1: none
  std::vector<int> nodes_;      // with a slot
  std::vector<AttachmentPoint> attachments_;
  std::vector<int> attachment_slot_;
  std::vector<HalfColumns> columns_;  // per slot
  std::vector<int> key_;              // per slot; -1: free
  std::vector<int> free_;             // slots
  int slot_count_ = 0;                // of columns_, which keep their memory
  std::vector<Eigen::Matrix3f> gram_;
  std::vector<char> gram_known_;
  HalfColumns one_;
};

}  // namespace vibe
