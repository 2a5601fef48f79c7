#include "solver/column_cache.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

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

namespace {

/// The product of two columns, row by row; all rows of a run but the last in vectors of four, of which the last is no
/// one's: it belongs to the next row.
struct GramSum {
  Eigen::Array4f sum[3] = {Eigen::Array4f::Zero(), Eigen::Array4f::Zero(), Eigen::Array4f::Zero()};  // by rows of b
  Eigen::Matrix3f last = Eigen::Matrix3f::Zero();

  void add(const float* a, const float* b) {
    for (int l = 0; l < 3; ++l) sum[l] += Eigen::Map<const Eigen::Array4f>(a) * b[l];
  }
  void addLast(const float* a, const float* b) {
    for (int l = 0; l < 3; ++l) last.col(l).array() += Eigen::Map<const Eigen::Array3f>(a) * b[l];
  }
  /// The first runs of both, as far as they have them in common.
  void addRuns(const HalfColumns& a, std::size_t a_runs, const HalfColumns& b, std::size_t b_runs) {
    const float *va = a.value.data(), *vb = b.value.data();
    std::size_t i = 0, j = 0;
    while (i < a_runs && j < b_runs) {
      if (a.begin[i] < b.begin[j]) {
        va += 3 * a.count[i++];
      } else if (a.begin[i] > b.begin[j]) {
        vb += 3 * b.count[j++];
      } else {
        for (int r = 0; r + 1 < a.count[i]; ++r, va += 3, vb += 3) add(va, vb);
        addLast(va, vb);
        va += 3, vb += 3;
        ++i, ++j;
      }
    }
  }
  Eigen::Matrix3f total() const {
    Eigen::Matrix3f all = last;
    for (int l = 0; l < 3; ++l) all.col(l).array() += sum[l].head<3>();
    return all;
  }
};

// @returns the number of runs at the end that all have in common with one
std::size_t commonRuns(const std::array<const HalfColumns*, kProducts>& columns, const HalfColumns& one) {
  std::size_t same = 0;
  for (;; ++same)
    for (const HalfColumns* other : columns) {
      const std::size_t runs = other->begin.size();
      if (same >= runs || same >= one.begin.size() ||
          other->begin[runs - 1 - same] != one.begin[one.begin.size() - 1 - same] ||
          other->count[runs - 1 - same] != one.count[one.begin.size() - 1 - same])
        return same;
    }
}

// Where the runs at the end begin.
const float* valueOfLast(std::size_t runs, const HalfColumns& a) {
  return a.value.data() + 3 * std::accumulate(a.count.begin(), a.count.end() - static_cast<std::ptrdiff_t>(runs), 0);
}

}  // namespace

Eigen::Matrix3f product(const HalfColumns& a, const HalfColumns& b) {
  GramSum sum;
  sum.addRuns(a, a.begin.size(), b, b.begin.size());
  return sum.total();
}

void productsOf(const std::array<const HalfColumns*, kProducts>& columns, const HalfColumns& b, Eigen::Matrix3f* out) {
  const std::size_t common = commonRuns(columns, b), before = b.begin.size() - common;
  std::array<GramSum, kProducts> sums{};
  std::array<const float*, kProducts> va;
  for (std::size_t c = 0; c < kProducts; ++c) {
    sums[c].addRuns(*columns[c], columns[c]->begin.size() - common, b, before);
    va[c] = valueOfLast(common, *columns[c]);
  }
  const float* vb = valueOfLast(common, b);
  for (std::size_t i = before; i < b.begin.size(); ++i, vb += 3) {
    for (const float* const last = vb + 3 * (b.count[i] - 1); vb != last; vb += 3)
      for (std::size_t c = 0; c < kProducts; ++c) {
        sums[c].add(va[c], vb);
        va[c] += 3;
      }
    for (std::size_t c = 0; c < kProducts; ++c) {
      sums[c].addLast(va[c], vb);
      va[c] += 3;
    }
  }
  for (std::size_t c = 0; c < kProducts; ++c) out[c] = sums[c].total();
}

namespace {

/// A sum over the runs of a column, in vectors of four, of which the last is no one's: it belongs to the next row.
struct ColumnSum {
  const float* value;
  Eigen::Array4f sum = Eigen::Array4f::Zero();

  void add(float y) {
    sum += Eigen::Map<const Eigen::Array4f>(value) * y;
    value += 3;
  }
  void addLast(float y) {  // of a run: nothing may follow
    sum.head<3>() += Eigen::Map<const Eigen::Array3f>(value) * y;
    value += 3;
  }
  void addRun(const float* y, int count) {
    for (int r = 0; r + 1 < count; ++r) add(y[r]);
    addLast(y[count - 1]);
  }
  Eigen::Vector3f total() const { return sum.head<3>().matrix(); }
};

}  // namespace

void productsOf(const std::array<const HalfColumns*, kProducts>& columns, const float* y, Eigen::Vector3f* out) {
  const std::size_t common = commonRuns(columns, *columns[0]);
  std::array<ColumnSum, kProducts> sums{};
  for (std::size_t c = 0; c < kProducts; ++c) {
    const HalfColumns& a = *columns[c];
    sums[c].value = a.value.data();
    for (std::size_t i = 0; i + common < a.begin.size(); ++i) sums[c].addRun(y + a.begin[i], a.count[i]);
  }
  const HalfColumns& one = *columns[0];
  for (std::size_t i = one.begin.size() - common; i < one.begin.size(); ++i) {
    const float* const from = y + one.begin[i];
    const int last = one.count[i] - 1;
    for (int r = 0; r < last; ++r)
      for (ColumnSum& sum : sums) sum.add(from[r]);
    for (ColumnSum& sum : sums) sum.addLast(from[last]);
  }
  for (std::size_t c = 0; c < kProducts; ++c) out[c] = sums[c].total();
}

Eigen::Vector3f product(const HalfColumns& a, const float* y) {
  ColumnSum sum{a.value.data()};
  for (std::size_t i = 0; i < a.begin.size(); ++i) sum.addRun(y + a.begin[i], a.count[i]);
  return sum.total();
}

void addProduct(const HalfColumns& a, const Eigen::Vector3f& c, RowRange rows, float* y) {
  const float* value = a.value.data();
  for (std::size_t i = 0; i < a.begin.size(); value += 3 * a.count[i], ++i) {
    const int begin = a.begin[i], first = std::max(begin, rows.first), last = std::min(begin + a.count[i], rows.last);
    if (first >= last) continue;
    const float* from = value + 3 * (first - begin);
    float* const to = y + first;
    for (int r = 0; r < last - first; ++r, from += 3) to[r] += from[0] * c[0] + from[1] * c[1] + from[2] * c[2];
  }
}

// Runs of both in ascending order; the same run has the same rows for every node.
void addScaled(const HalfColumns& b, float weight, HalfColumns& a) {
  HalfColumns sum;
  sum.begin.reserve(a.begin.size() + b.begin.size());
  sum.count.reserve(a.count.size() + b.count.size());
  sum.value.resize(a.value.size() + b.value.size());
  std::size_t i = 0, j = 0;
  const float *va = a.value.data(), *vb = b.value.data();
  float* to = sum.value.data();
  while (i < a.begin.size() || j < b.begin.size()) {
    const bool from_a = j == b.begin.size() || (i < a.begin.size() && a.begin[i] <= b.begin[j]);
    const bool from_b = i == a.begin.size() || (j < b.begin.size() && b.begin[j] <= a.begin[i]);
    const std::int32_t count = 3 * (from_a ? a.count[i] : b.count[j]);
    sum.begin.push_back(from_a ? a.begin[i] : b.begin[j]);
    sum.count.push_back(count / 3);
    if (from_a && from_b)
      for (std::int32_t r = 0; r < count; ++r) to[r] = va[r] + weight * vb[r];
    else
      for (std::int32_t r = 0; r < count; ++r) to[r] = from_a ? va[r] + 0.0F : 0.0F + weight * vb[r];
    to += count;
    va += from_a ? count : 0, vb += from_b ? count : 0;
    i += from_a ? 1 : 0;
    j += from_b ? 1 : 0;
  }
  sum.value.resize(static_cast<std::size_t>(to - sum.value.data()));
  std::swap(a, sum);
}

void HalfRows::clear() {
  first_.clear();
  compliance_.clear();
  slot_.clear();
  coefficient_.clear();
}

void HalfRows::addRow(double compliance) {
  first_.push_back(terms());
  compliance_.push_back(compliance);
}

void HalfRows::addTerm(int slot, const Eigen::Vector3d& coefficient) {
  slot_.push_back(slot);
  coefficient_.push_back(coefficient);
}

// By key: the slots' numbers depend on what was touched before, and sums must not.
void HalfRows::finish(ColumnCache& cache) {
  used_ = slot_;
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  std::sort(used_.begin(), used_.end(), [&](int a, int b) { return cache.key(a) < cache.key(b); });
  int last = -1;
  for (const int slot : used_) last = std::max(last, slot);
  place_of_slot_.assign(static_cast<std::size_t>(last + 1), -1);
  for (std::size_t u = 0; u < used_.size(); ++u)
    place_of_slot_[static_cast<std::size_t>(used_[u])] = static_cast<int>(u);
  place_.clear();
  for (const int slot : slot_) place_.push_back(place_of_slot_[static_cast<std::size_t>(slot)]);
  share_.resize(used_.size());
  formGram(cache);
}

void HalfRows::formGram(ColumnCache& cache) {
  const std::size_t size = 3 * used_.size();
  gram_.resize(size * size);
  for (std::size_t u = 0; u < used_.size(); ++u) {
    cache.makeGrams(used_[u], used_, u + 1);
    for (std::size_t v = 0; v <= u; ++v) {
      const bool ordered = used_[u] >= used_[v];
      const Eigen::Matrix3f& g = ordered ? cache.gram(used_[u], used_[v]) : cache.gram(used_[v], used_[u]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
          const double value = static_cast<double>(ordered ? g(a, b) : g(b, a));
          gram_[(3 * u + i) * size + 3 * v + j] = gram_[(3 * v + j) * size + 3 * u + i] = value;
        }
    }
  }
}

void HalfRows::compliances(Eigen::MatrixXd& out) {
  out.resize(count(), count());
  const std::size_t size = 3 * used_.size();
  for (int i = 0; i < count(); ++i) {
    const bool empty = first_[static_cast<std::size_t>(i)] == end(i);
    if (!empty) given_.assign(size, 0.0);
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i); ++t)
      kernels_.subtractRows(given_.data(), static_cast<int>(size),
                            &gram_[3 * static_cast<std::size_t>(place_[static_cast<std::size_t>(t)]) * size],
                            Eigen::Vector3d(-coefficient_[static_cast<std::size_t>(t)]).data(), 3);
    for (int j = 0; j <= i; ++j) {
      double sum = 0;
      if (empty) {
        out(i, j) = out(j, i) = 0;
        continue;
      }
      for (int t = first_[static_cast<std::size_t>(j)]; t < end(j); ++t) {
        const Eigen::Vector3d& c = coefficient_[static_cast<std::size_t>(t)];
        const double* const at = &given_[3 * static_cast<std::size_t>(place_[static_cast<std::size_t>(t)])];
        sum += c[0] * at[0] + c[1] * at[1] + c[2] * at[2];
      }
      out(i, j) = out(j, i) = sum;
    }
    out(i, i) += compliance(i);
  }
}

// Each slot once, although several rows may share it.
void HalfRows::multiply(const ColumnCache& cache, int piece, const float* y) {
  std::size_t u = static_cast<std::size_t>(piece) * kPiece;
  const std::size_t last = std::min(u + kPiece, used_.size());
  for (; u + kProducts <= last; u += kProducts) {
    std::array<const HalfColumns*, kProducts> columns;
    for (std::size_t c = 0; c < kProducts; ++c) columns[c] = &cache.columns(used_[u + c]);
    productsOf(columns, y, &share_[u]);
  }
  for (; u < last; ++u) share_[u] = product(cache.columns(used_[u]), y);
}

void HalfRows::values(Eigen::VectorXd& out) const {
  out.resize(count());
  for (int i = 0; i < count(); ++i) {
    double sum = 0;
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i); ++t) {
      const Eigen::Vector3d& c = coefficient_[static_cast<std::size_t>(t)];
      const Eigen::Vector3f& share = share_[static_cast<std::size_t>(place_[static_cast<std::size_t>(t)])];
      sum += c[0] * share[0] + (c[1] * share[1] + c[2] * share[2]);  // not dot(): its order depends on Eigen's version
    }
    out[i] = sum;
  }
}

void HalfRows::setForces(const Eigen::VectorXd& force) {
  for (Eigen::Vector3f& share : share_) share.setZero();
  for (int i = 0; i < count(); ++i)
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i) && force[i] != 0; ++t)
      share_[static_cast<std::size_t>(place_[static_cast<std::size_t>(t)])] +=
          (force[i] * coefficient_[static_cast<std::size_t>(t)]).cast<float>();
}

void HalfRows::addForces(const ColumnCache& cache, RowRange rows, float* y) const {
  for (std::size_t u = 0; u < used_.size(); ++u)
    if (!share_[u].isZero(0)) addProduct(cache.columns(used_[u]), share_[u], rows, y);
}

// All columns end with the rows of the root, to which about half is added.
RowRange HalfRows::part(const ColumnCache& cache, int part, int rows) const {
  if (used_.empty()) return {rows * part / kParts, rows * (part + 1) / kParts};
  const HalfColumns& one = cache.columns(used_.front());
  const int ends[] = {0, one.begin.back(), one.begin.back() + one.count.back() / 2, rows};
  return {ends[part], ends[part + 1]};
}

}  // namespace vibe
