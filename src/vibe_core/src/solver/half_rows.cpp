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
  for (std::size_t u = 0; u < used_.size(); ++u)
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

void HalfRows::compliances(Eigen::MatrixXd& out) {
  out.resize(count(), count());
  const std::size_t size = 3 * used_.size();
  for (int i = 0; i < count(); ++i) {
    const bool empty = first_[static_cast<std::size_t>(i)] == end(i);
    if (!empty) given_.assign(size, 0.0);
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i); ++t)
      for (int k = 0; k < 3; ++k) {
        const double c = coefficient_[static_cast<std::size_t>(t)][k];
        if (c == 0) continue;
        const double* const from = &gram_[static_cast<std::size_t>(3 * place_[static_cast<std::size_t>(t)] + k) * size];
        for (std::size_t a = 0; a < size; ++a) given_[a] += c * from[a];
      }
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
void HalfRows::values(const ColumnCache& cache, const float* y, Eigen::VectorXd& out) {
  for (std::size_t u = 0; u < used_.size(); ++u) share_[u] = product(cache.columns(used_[u]), y);
  out.resize(count());
  for (int i = 0; i < count(); ++i) {
    double sum = 0;
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i); ++t)
      sum += coefficient_[static_cast<std::size_t>(t)].dot(
          share_[static_cast<std::size_t>(place_[static_cast<std::size_t>(t)])].cast<double>());
    out[i] = sum;
  }
}

void HalfRows::addForces(const ColumnCache& cache, const Eigen::VectorXd& force, float* y) {
  for (Eigen::Vector3f& share : share_) share.setZero();
  for (int i = 0; i < count(); ++i)
    for (int t = first_[static_cast<std::size_t>(i)]; t < end(i) && force[i] != 0; ++t)
      share_[static_cast<std::size_t>(place_[static_cast<std::size_t>(t)])] +=
          (force[i] * coefficient_[static_cast<std::size_t>(t)]).cast<float>();
  for (std::size_t u = 0; u < used_.size(); ++u)
    if (!share_[u].isZero(0)) addProduct(cache.columns(used_[u]), share_[u], y);
}

}  // namespace vibe
