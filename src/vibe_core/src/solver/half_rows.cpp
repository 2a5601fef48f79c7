#include "solver/half_rows.hpp"

#include <algorithm>

namespace vibe {

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
  index_of_slot_.assign(static_cast<std::size_t>(last + 1), -1);
  for (std::size_t u = 0; u < used_.size(); ++u)
    index_of_slot_[static_cast<std::size_t>(used_[u])] = static_cast<int>(u);
  index_.clear();
  for (const int slot : slot_) index_.push_back(index_of_slot_[static_cast<std::size_t>(slot)]);
  slot_value_.resize(used_.size());
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
    // the row's products with all slots, once for all rows before it
    if (!empty) row_gram_.assign(size, 0.0);
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i); ++t)
      kernels_.subtractRows(row_gram_.data(), static_cast<int>(size),
                            &gram_[3 * static_cast<std::size_t>(index_[static_cast<std::size_t>(t)]) * size],
                            Eigen::Vector3d(-coefficient_[static_cast<std::size_t>(t)]).data(), 3);
    for (int j = 0; j <= i; ++j) {
      double sum = 0;
      // a row without terms has its own compliance only
      if (empty) {
        out(i, j) = out(j, i) = 0;
        continue;
      }
      for (int t = first_[static_cast<std::size_t>(j)]; t < end(j); ++t) {
        const Eigen::Vector3d& c = coefficient_[static_cast<std::size_t>(t)];
        const double* const at = &row_gram_[3 * static_cast<std::size_t>(index_[static_cast<std::size_t>(t)])];
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
    productsOf(columns, y, &slot_value_[u]);
  }
  for (; u < last; ++u) slot_value_[u] = product(cache.columns(used_[u]), y);
}

void HalfRows::values(Eigen::VectorXd& out) const {
  out.resize(count());
  for (int i = 0; i < count(); ++i) {
    double sum = 0;
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i); ++t) {
      const Eigen::Vector3d& c = coefficient_[static_cast<std::size_t>(t)];
      const Eigen::Vector3f& share = slot_value_[static_cast<std::size_t>(index_[static_cast<std::size_t>(t)])];
      sum += c[0] * share[0] + (c[1] * share[1] + c[2] * share[2]);  // not dot(): its order depends on Eigen's version
    }
    out[i] = sum;
  }
}

void HalfRows::setForces(const Eigen::VectorXd& force) {
  for (Eigen::Vector3f& share : slot_value_) share.setZero();
  for (int i = 0; i < count(); ++i)
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i) && force[i] != 0; ++t)
      slot_value_[static_cast<std::size_t>(index_[static_cast<std::size_t>(t)])] +=
          (force[i] * coefficient_[static_cast<std::size_t>(t)]).cast<float>();
}

void HalfRows::addForces(const ColumnCache& cache, RowRange rows, float* y) const {
  for (std::size_t u = 0; u < used_.size(); ++u)
    if (!slot_value_[u].isZero(0)) addProduct(cache.columns(used_[u]), slot_value_[u], rows, y);
}

// All columns end with the rows of the root, to which about half is added.
RowRange HalfRows::part(const ColumnCache& cache, int part, int rows) const {
  if (used_.empty()) return {rows * part / kParts, rows * (part + 1) / kParts};
  const HalfColumns& one = cache.columns(used_.front());
  const int ends[] = {0, one.begin.back(), one.begin.back() + one.count.back() / 2, rows};
  return {ends[part], ends[part + 1]};
}

}  // namespace vibe
