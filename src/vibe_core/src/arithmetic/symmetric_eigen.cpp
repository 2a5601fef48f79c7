#include "arithmetic/symmetric_eigen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe {

namespace {

constexpr int kMaxIterations = 90;  // 30 for each eigenvalue; two or three are usual

struct Rotation {
  double c, s;

  /// The rotation that takes (p, q) to (r, 0).
  Rotation(double p, double q) {
    if (q == 0) {
      c = p < 0 ? -1 : 1, s = 0;
    } else if (p == 0) {
      c = 0, s = q < 0 ? 1 : -1;
    } else if (std::abs(p) > std::abs(q)) {
      const double t = q / p, u = std::copysign(std::sqrt(1 + t * t), p);
      c = 1 / u, s = -t * c;
    } else {
      const double t = p / q, u = std::copysign(std::sqrt(1 + t * t), q);
      s = -1 / u, c = -t * s;
    }
  }
};

/// Square root of x^2 + y^2, without overflow.
double hypotenuse(double x, double y) {
  const double larger = std::max(std::abs(x), std::abs(y)), smaller = std::min(std::abs(x), std::abs(y));
  if (larger == 0) return 0;
  const double ratio = smaller / larger;
  return larger * std::sqrt(1 + ratio * ratio);
}

/// The tridiagonal matrix Q^T A Q.
struct Tridiagonal {
  Eigen::Vector3d diagonal;
  Eigen::Vector2d below;
  Eigen::Matrix3d q = Eigen::Matrix3d::Identity();

  /// @param a  its lower triangle counts
  explicit Tridiagonal(const Eigen::Matrix3d& a) {
    diagonal = a.diagonal();
    below << a(1, 0), a(2, 1);
    const double corner2 = a(2, 0) * a(2, 0);
    if (corner2 <= std::numeric_limits<double>::min()) return;
    const double length = std::sqrt(a(1, 0) * a(1, 0) + corner2), inverse = 1 / length;
    const double u = a(1, 0) * inverse, v = a(2, 0) * inverse;
    const double turned = 2 * u * a(2, 1) + v * (a(2, 2) - a(1, 1));
    diagonal[1] = a(1, 1) + v * turned;
    diagonal[2] = a(2, 2) - v * turned;
    below << length, a(2, 1) - u * turned;
    q << 1, 0, 0, 0, u, v, 0, v, -u;
  }

  void dropSmall(int start, int end) {
    for (int i = start; i < end; ++i) {
      const double scaled = below[i] / std::numeric_limits<double>::epsilon();
      if (std::abs(below[i]) < std::numeric_limits<double>::min() ||
          scaled * scaled <= std::abs(diagonal[i]) + std::abs(diagonal[i + 1]))
        below[i] = 0;
    }
  }

  double shift(int end) const {
    const double half = (diagonal[end - 1] - diagonal[end]) * 0.5, e = below[end - 1], e2 = e * e;
    if (half == 0) return diagonal[end] - std::abs(e);
    if (e == 0) return diagonal[end];
    const double h = hypotenuse(half, e), sum = half + (half > 0 ? h : -h);
    return diagonal[end] - (e2 == 0 ? e / (sum / e) : e2 / sum);
  }

  /// One step on the rows from `start` to `end`.
  void step(int start, int end) {
    double x = diagonal[start] - shift(end), z = below[start];
    for (int k = start; k < end && z != 0; ++k) {
      const Rotation r(x, z);
      const double side = r.s * diagonal[k] + r.c * below[k], next = r.s * below[k] + r.c * diagonal[k + 1];
      diagonal[k] = r.c * (r.c * diagonal[k] - r.s * below[k]) - r.s * (r.c * below[k] - r.s * diagonal[k + 1]);
      diagonal[k + 1] = r.s * side + r.c * next;
      below[k] = r.c * side - r.s * next;
      if (k > start) below[k - 1] = r.c * below[k - 1] - r.s * z;
      x = below[k];
      if (k < end - 1) {
        z = -r.s * below[k + 1];
        below[k + 1] = r.c * below[k + 1];
      }
      for (int i = 0; i < 3; ++i) {
        const double a = q(i, k), b = q(i, k + 1);
        q(i, k) = r.c * a - r.s * b;
        q(i, k + 1) = r.s * a + r.c * b;
      }
    }
  }

  void diagonalise() {
    int start = 0, end = 2;
    for (int iteration = 0; iteration <= kMaxIterations; ++iteration) {
      dropSmall(start, end);
      while (end > 0 && below[end - 1] == 0) --end;
      if (end == 0) return;
      start = end - 1;
      while (start > 0 && below[start - 1] != 0) --start;
      step(start, end);
    }
  }
};

}  // namespace

SymmetricEigen3::SymmetricEigen3(const Eigen::Matrix3d& symmetric) {
  const Eigen::Matrix3d lower = symmetric.triangularView<Eigen::Lower>();
  const double largest = lower.cwiseAbs().maxCoeff(), scale = largest == 0 ? 1 : largest;
  Tridiagonal work(lower / scale);
  work.diagonalise();
  for (int i = 0; i < 2; ++i) {
    int least = i;
    for (int k = i + 1; k < 3; ++k)
      if (work.diagonal[k] < work.diagonal[least]) least = k;
    if (least == i) continue;
    std::swap(work.diagonal[i], work.diagonal[least]);
    work.q.col(i).swap(work.q.col(least));
  }
  values = work.diagonal * scale;
  vectors = work.q;
}

}  // namespace vibe
