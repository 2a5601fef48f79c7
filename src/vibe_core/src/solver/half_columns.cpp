#include "solver/half_columns.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace vibe {

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
  // as large as both together: runs that both have make it shorter
  HalfColumns sum;
  sum.begin.reserve(a.begin.size() + b.begin.size());
  sum.count.reserve(a.count.size() + b.count.size());
  sum.value.resize(a.value.size() + b.value.size());
  std::size_t i = 0, j = 0;
  const float *va = a.value.data(), *vb = b.value.data();
  float* to = sum.value.data();
  while (i < a.begin.size() || j < b.begin.size()) {
    // the run that begins first, from either or from both
    const bool from_a = j == b.begin.size() || (i < a.begin.size() && a.begin[i] <= b.begin[j]);
    const bool from_b = i == a.begin.size() || (j < b.begin.size() && b.begin[j] <= a.begin[i]);
    const std::int32_t count = 3 * (from_a ? a.count[i] : b.count[j]);
    sum.begin.push_back(from_a ? a.begin[i] : b.begin[j]);
    sum.count.push_back(count / 3);
    // adding a zero gives minus zero the bits of zero, as a sum of both would
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

}  // namespace vibe
