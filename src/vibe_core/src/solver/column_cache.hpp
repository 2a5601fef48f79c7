#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "solver/dense_row_kernel.hpp"
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

/// Product of two sparse vectors: both consist of whole runs; those on the common part of the paths are the same runs.
Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b);
constexpr int kProducts = 4;
/// The same of several at once, with the same bits. Alone, each is a sum in which every term waits for the one before;
/// together they share what their paths have in common.
/// @param out  kProducts of them
void productsOf(const std::array<const HalfColumns*, kProducts>& columns, const HalfColumns& b, Eigen::Matrix3f* out);
/// Product with a dense vector.
Eigen::Vector3f product(const HalfColumns& a, const float* y);
/// Several at once, likewise.
void productsOf(const std::array<const HalfColumns*, kProducts>& columns, const float* y, Eigen::Vector3f* out);
/// Rows of a dense vector, past the last.
struct RowRange {
  int first, last;
};
/// Adds the columns times c to some rows of a dense vector.
void addProduct(const HalfColumns& a, const Eigen::Vector3f& c, RowRange rows, float* y);
/// Adds weight times the columns b to a.
void addScaled(const HalfColumns& b, float weight, HalfColumns& a);

/// Rows of constraints in half-solved space: linear functions of the nodes and attachment points in a column cache.
/// Keeps its memory.
class HalfRows {
 public:
  void clear();
  /// Begins another row. One that gets no term has no effect.
  void addRow(double compliance);
  /// Adds coefficient . x at a slot of the cache to the last row.
  void addTerm(int slot, const Eigen::Vector3d& coefficient);
  /// The rows are complete.
  void finish(ColumnCache& cache);

  int count() const { return static_cast<int>(first_.size()); }
  double compliance(int row) const { return compliance_[static_cast<std::size_t>(row)]; }
  /// Values of the rows of a half-solved vector: multiply() for every piece, in any order or at the same time.
  int pieces() const { return (static_cast<int>(used_.size()) + kPiece - 1) / kPiece; }
  void multiply(const ColumnCache& cache, int piece, const float* y);
  void values(Eigen::VectorXd& out) const;
  /// The rows' forces on a half-solved vector, then what they add to some of its rows.
  void setForces(const Eigen::VectorXd& force);
  void addForces(const ColumnCache& cache, RowRange rows, float* y) const;
  /// Ranges of a half-solved vector to which about as much is added; they do not depend on threads.
  static constexpr int kParts = 3;
  RowRange part(const ColumnCache& cache, int part, int rows) const;
  /// Compliance between the rows, with their own (rows x rows) [m/N].
  void compliances(Eigen::MatrixXd& out);

 private:
  int end(int row) const { return row + 1 < count() ? first_[static_cast<std::size_t>(row) + 1] : terms(); }
  int terms() const { return static_cast<int>(slot_.size()); }
  void formGram(ColumnCache& cache);

  static constexpr int kPiece = 2 * kProducts;  // slots that one thread multiplies by in a row
  DenseRowKernels kernels_ = denseRowKernels();
  std::vector<int> first_;  // term of each row
  std::vector<double> compliance_;
  std::vector<int> slot_;                     // of each term
  std::vector<int> place_;                    // of each term: index into used_
  std::vector<Eigen::Vector3d> coefficient_;  // of each term
  std::vector<int> used_;                     // slots, by key
  std::vector<int> place_of_slot_;
  std::vector<double> gram_;            // between used slots (3 used x 3 used)
  std::vector<double> given_;           // gram times a row
  std::vector<Eigen::Vector3f> share_;  // per used slot: of a vector or of the forces
};

}  // namespace vibe
