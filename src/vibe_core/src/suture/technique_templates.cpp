#include "suture/technique_templates.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "arithmetic/elementary.hpp"
#include "arithmetic/symmetric_eigen.hpp"
#include "arithmetic/turn.hpp"

namespace vibe {

namespace {

constexpr int kAxisSteps = 4;  // axes of candidate cylinders about 20 degrees apart
constexpr double kMaxWrap = 1.1 * kPi;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Least-squares circle (Kasa 1976, IEEE Trans Instrum Meas 25:8) through the columns x, y; false if they are
/// collinear.
bool fitCircle(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Eigen::Vector2d& centre, double& radius) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> a(x.size(), 3);
  a << 2 * x, 2 * y, Eigen::VectorXd::Ones(x.size());
  const Eigen::VectorXd b = x.array().square() + y.array().square();
  const Eigen::Matrix3d normal = a.transpose() * a;
  const auto solver = normal.ldlt();
  const Eigen::Vector3d found = solver.solve(a.transpose() * b);
  centre = found.head<2>();
  radius = std::sqrt(found.z() + centre.squaredNorm());
  const double size = std::sqrt(b.sum() / static_cast<double>(x.size()));
  return std::isfinite(radius) && radius < 20 * size;
}

void centreBites(FlatBites& flat) {
  std::complex<double> centre = 0;
  for (const auto& p : flat.bites) centre += p / static_cast<double>(flat.bites.size());
  for (auto& p : flat.bites) p -= centre;
}

/// Unrolls the cylinder with this axis (a unit vector); false if the bites do not lie on one side of a cylinder.
bool unroll(const Rows& bites, const Eigen::Vector3d& axis, FlatBites& flat) {
  const Eigen::Vector3d e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  const Eigen::VectorXd x = bites * e1, y = bites * e2, z = bites * axis;
  Eigen::Vector2d centre;
  double radius;
  if (!fitCircle(x, y, centre, radius)) return false;
  const double middle =
      math::atan2(-centre.y(), -centre.x());  // direction of the bites from the axis; bites are centred
  flat = {};
  double min = 0, max = 0;
  for (int k = 0; k < bites.rows(); ++k) {
    const double dx = x[k] - centre.x(), dy = y[k] - centre.y();
    const double angle = std::remainder(math::atan2(dy, dx) - middle, 2 * kPi);
    min = std::min(min, angle), max = std::max(max, angle);
    flat.bites.emplace_back(radius * angle, z[k]);
    const double off = math::hypot(dx, dy) - radius;
    flat.off_wall += off * off;
  }
  flat.wrap = max - min;
  centreBites(flat);
  return flat.wrap < kMaxWrap;
}

/// Directions over a hemisphere, symmetric with respect to each coordinate axis: a reflected set is laid flat on
/// reflected cylinders.
std::vector<Eigen::Vector3d> candidateAxes() {
  std::vector<Eigen::Vector3d> axes;
  for (int i = -kAxisSteps; i <= kAxisSteps; ++i)
    for (int j = -kAxisSteps; j <= kAxisSteps; ++j) {
      const int k = kAxisSteps - std::abs(i) - std::abs(j);
      if (k < 0) continue;
      const bool on_rim = k == 0 && (j < 0 || (j == 0 && i < 0));  // the opposite direction is already included
      if (!on_rim) axes.push_back(Eigen::Vector3d(i, j, k).normalized());
    }
  return axes;
}

}  // namespace

std::vector<FlatBites> layFlat(const std::vector<Eigen::Vector3d>& bites) {
  Rows rows(bites.size(), 3);
  for (std::size_t k = 0; k < bites.size(); ++k) rows.row(static_cast<Eigen::Index>(k)) = bites[k];
  rows.rowwise() -= rows.colwise().mean().eval();
  const SymmetricEigen3 spread(rows.transpose() * rows);
  const Rows own = rows * spread.vectors;  // smallest spread first

  FlatBites plane;
  plane.off_wall = own.col(0).squaredNorm();
  for (Eigen::Index k = 0; k < own.rows(); ++k) plane.bites.emplace_back(own(k, 2), own(k, 1));
  std::vector<FlatBites> result{plane};
  FlatBites rolled;
  for (const Eigen::Vector3d& axis : candidateAxes())
    if (unroll(own, axis, rolled)) result.push_back(rolled);
  return result;
}

namespace {

using Complex = std::complex<double>;
using Points = std::vector<Complex>;

// Angles, proportions and weights of all drawings are design choices (docs/technique.md): no published measurement of
// how sets are drawn was found. An affine map fits a drawing to the bites, so that a few angles cover those between
// them, and proportions along the legs count, not their scale. A drawing that a technique has rarely has less weight.
constexpr int kMaxUneven = 6;         // largest ratio of the numbers of bite vectors on two sides of a polygon
constexpr double kAlongShare = 0.25;  // share of drawings with evenly spaced bites and corners anywhere

/// A leg of a drawing: direction [rad], length, number of bite vectors.
struct Leg {
  double direction;
  double length;
  int vectors;
};

Complex polar(double length, double direction) {
  return {length * math::cos(direction), length * math::sin(direction)};
}

Points bitesAtCorners(const std::vector<Leg>& legs) {
  Points points{0};
  for (const Leg& leg : legs) {
    const Complex step = polar(leg.length / leg.vectors, leg.direction);
    for (int k = 0; k < leg.vectors; ++k) points.push_back(points.back() + step);
  }
  return points;
}

Points bitesAlong(const std::vector<Leg>& legs, int count, double used) {
  double total = 0;
  for (const Leg& leg : legs) total += leg.length;
  Points points;
  for (int k = 0; k < count; ++k) {
    double left = used * total * k / (count - 1);
    Complex at = 0;
    for (const Leg& leg : legs) {
      at += polar(std::clamp(left, 0.0, leg.length), leg.direction);
      left -= leg.length;
    }
    points.push_back(at);
  }
  return points;
}

/// Collects drawings and normalises them to unit size.
class Album {
 public:
  explicit Album(int bite_count) : count_(bite_count) {}

  /// Weight of a drawing such that the `count` drawings of its kind have this share of the current total of the
  /// technique.
  double share(Technique technique, double part, int count) const {
    double sum = 0;
    for (const TechniqueTemplate& t : templates_) sum += t.technique == technique ? t.weight / 2 : 0;
    return part * sum / count;
  }

  void add(Technique technique, Points points, std::array<int, 2> corners = {-1, -1}, double weight = 1) {
    Complex centre = 0;
    for (const Complex& p : points) centre += p / static_cast<double>(count_);
    double square = 0;
    for (Complex& p : points) square += std::norm(p -= centre);
    for (Complex& p : points) p /= std::sqrt(square);
    Complex own = 0;
    for (const Complex& p : points) own += std::conj(p * p);
    TechniqueTemplate made{technique, std::move(points), corners, own, weight};
    templates_.push_back(made);
    std::reverse(made.bites.begin(), made.bites.end());
    if (corners[0] >= 0) made.corners = {count_ - 1 - corners[1], count_ - 1 - corners[0]};
    templates_.push_back(std::move(made));
  }

  std::vector<TechniqueTemplate> take() {
    std::array<double, kTechniqueCount> sum{};
    for (const TechniqueTemplate& t : templates_) sum[static_cast<int>(t.technique)] += t.weight;
    for (TechniqueTemplate& t : templates_) t.weight /= sum[static_cast<int>(t.technique)];
    return std::move(templates_);
  }

  int count() const { return count_; }

 private:
  int count_;
  std::vector<TechniqueTemplate> templates_;
};

/// Relative frequency of a distribution of bites among sides: even ones are more frequent.
double evenness(int min, int max) {
  return static_cast<double>(min) / max;
}

/// U and Z: two legs joined by a bar that turns by `turn` [rad] from the first and by `back` into the second.
void addTwoCorners(Album& album, Technique technique, double turn, double back, double weight) {
  const int vectors = album.count() - 1;
  for (int first = 1; first <= vectors - 2; ++first)
    for (int bar = 1; bar <= vectors - 1 - first; ++bar) {
      const int last = vectors - first - bar, max = std::max(first, last);
      const std::array<int, 2> corners{first, first + bar};
      const double even = evenness(std::min(first, last), max) * evenness(std::min(bar, max), bar) * weight;
      // equal spacing of all bites, or legs of equal length for any number of bites
      if (max <= 2 * std::min(first, last) && bar <= 2 * max)
        album.add(technique,
                  bitesAtCorners({{0, 1.0 * first, first}, {turn, 1.0 * bar, bar}, {turn + back, 1.0 * last, last}}),
                  corners, even);
      for (const double length : {0.5, 1.0})
        album.add(technique, bitesAtCorners({{0, 1, first}, {turn, length, bar}, {turn + back, 1, last}}), corners,
                  even / 2);
    }
}

/// A U or Z whose corners need not coincide with a bite, for operators who space bites evenly along a visible line.
void addAlong(Album& album, Technique technique, double turn, double back, const std::vector<double>& bars) {
  const int last = album.count() - 1;
  const double weight = album.share(technique, kAlongShare, static_cast<int>(bars.size()));
  for (const double bar : bars) {
    const auto corner = [&](double at) { return static_cast<int>(std::lround(last * at / (2 + bar))); };
    const std::array<int, 2> corners{std::max(1, corner(1) - (corner(1) == corner(1 + bar))), corner(1 + bar)};
    album.add(technique, bitesAlong({{0, 1, 1}, {turn, bar, 1}, {turn + back, 1, 1}}, album.count(), 1), corners,
              weight);
  }
}

/// Legs of opposite directions: the corners turn by 180 degrees in all. Half as often both lean to the same side, as a
/// parallelogram without its fourth side.
void addU(Album& album) {
  for (const double lean : {-20, 0, 20})
    addTwoCorners(album, Technique::U, (90 + lean) * kDegree, (90 - lean) * kDegree, lean == 0 ? 1 : 0.5);
  if (album.count() >= 5) addAlong(album, Technique::U, 90 * kDegree, 90 * kDegree, {0.25, 0.5, 0.8});
}

/// Legs of the same direction, joined by a bar that runs straight across (95 degrees, which is rare) or back, up to the
/// sharp corners of a written Z (150 degrees).
void addZ(Album& album) {
  for (const double turn : {95, 120, 135, 150})
    addTwoCorners(album, Technique::Z, turn * kDegree, -turn * kDegree, turn < 100 ? 0.5 : 1);
  if (album.count() >= 5) addAlong(album, Technique::Z, 130 * kDegree, -130 * kDegree, {1, 1.4});
}

/// Two legs that meet in one sharp corner: that of an equilateral triangle (120 degrees), or 20 degrees more or less.
void addCorner(Album& album) {
  const int vectors = album.count() - 1;
  for (int first = 1; first <= vectors - 1; ++first) {
    const int last = vectors - first;
    const auto [min, max] = std::minmax({first, last});
    for (const double turn : {100, 120, 140}) {
      if (max <= 2 * min)
        album.add(Technique::Triangular, bitesAtCorners({{0, 1.0 * first, first}, {turn * kDegree, 1.0 * last, last}}));
      album.add(Technique::Triangular, bitesAtCorners({{0, 1, first}, {turn * kDegree, 1, last}}), {-1, -1},
                evenness(min, max));
    }
  }
  if (vectors < 5) return;  // with four or five bites, a corner without a bite is reduced to a bend
  const double along = album.share(Technique::Triangular, kAlongShare, 2);
  for (const double turn : {110, 130})
    album.add(Technique::Triangular, bitesAlong({{0, 1, 1}, {turn * kDegree, 1, 1}}, album.count(), 1), {-1, -1},
              along);
}

/// A polygon whose last side may end short of the first bite.
/// @param shortest  length of such a side, which is half as frequent, over that of the others
void addPolygon(Album& album, Technique technique, int sides, double shortest, double weight) {
  const double turn = 360 * kDegree / sides;
  const int vectors = album.count() - 1;
  std::vector<int> shared(sides, 1);
  const auto add = [&] {
    const auto [min, max] = std::minmax_element(shared.begin(), shared.end());
    if (*max > kMaxUneven * *min) return;
    for (const double last : {1.0, shortest}) {
      std::vector<Leg> legs;
      for (int k = 0; k < sides; ++k) legs.push_back({k * turn, k == sides - 1 ? last : 1, shared[k]});
      album.add(technique, bitesAtCorners(legs), {-1, -1}, weight * evenness(*min, *max) * (last < 1 ? 0.5 : 1));
    }
  };
  // all distributions of the bite vectors among the sides
  const auto fill = [&](auto&& self, int side, int left) -> void {
    if (side == sides - 1) {
      shared[side] = left;
      return add();
    }
    for (shared[side] = 1; left - shared[side] >= sides - 1 - side; ++shared[side])
      self(self, side + 1, left - shared[side]);
  };
  if (vectors >= sides) fill(fill, 0, vectors);
  if (vectors <= sides) return;
  std::vector<Leg> legs;
  for (int k = 0; k < sides; ++k) legs.push_back({k * turn, 1, 1});
  const double along = album.share(technique, kAlongShare, 2);
  for (const double used : {1.0, 1.0 - 1.0 / album.count()})
    album.add(technique, bitesAlong(legs, album.count(), used), {-1, -1}, along);
}

Points arc(int count, double sweep) {
  Points points;
  for (int k = 0; k < count; ++k) points.push_back(polar(1.0, sweep * k / (count - 1)));
  return points;
}

/// Arcs from half to three quarters of a circle, 10 degrees beyond either end.
void addC(Album& album) {
  // with four bites the chords of three quarters of a circle are three sides of a square, which is a U
  const int max = album.count() == 4 ? 210 : 280;
  for (int sweep = 170; sweep <= max; sweep += 20) album.add(Technique::C, arc(album.count(), sweep * kDegree));
}

/// A straight line, a zigzag with bites beside it by up to 0.3 of their spacing along it, or an arc that is much less
/// than that of a C.
void addRunning(Album& album) {
  for (const double zigzag : {0.0, 0.15, 0.3}) {
    Points points;
    for (int k = 0; k < album.count(); ++k) points.emplace_back(k, k % 2 == 0 ? zigzag : -zigzag);
    album.add(Technique::Running, points, {-1, -1}, zigzag > 0 ? 0.5 : 2);
  }
  for (const double sweep : {30, 60}) album.add(Technique::Running, arc(album.count(), sweep * kDegree));
}

}  // namespace

std::vector<TechniqueTemplate> techniqueTemplates(int bite_count) {
  Album album(bite_count);
  addU(album);
  addZ(album);
  addCorner(album);
  addPolygon(album, Technique::Triangular, 3, 0.67, 2);  // three sides are more frequent than one corner
  addPolygon(album, Technique::Square, 4, 0.6, 1);
  addC(album);
  addRunning(album);
  return album.take();
}

}  // namespace vibe
