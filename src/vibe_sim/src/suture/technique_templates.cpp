#include "technique_templates.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

using Complex = std::complex<double>;
using Points = std::vector<Complex>;

constexpr double kDegree = 3.14159265358979323846 / 180;

/// A leg of a drawing: where it points [rad], how long it is, how many bite vectors it is made of.
struct Leg {
  double direction;
  double length;
  int vectors;
};

Points bitesAtCorners(const std::vector<Leg>& legs) {
  Points points{0};
  for (const Leg& leg : legs) {
    const Complex step = std::polar(leg.length / leg.vectors, leg.direction);
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
      at += std::polar(std::clamp(left, 0.0, leg.length), leg.direction);
      left -= leg.length;
    }
    points.push_back(at);
  }
  return points;
}

/// Collects drawings and brings them to unit size.
class Album {
 public:
  explicit Album(int bite_count) : count_(bite_count) {}

  void add(Technique technique, Points points, std::array<int, 2> corners = {-1, -1}, double weight = 1) {
    Complex centre = 0;
    for (const Complex& p : points) centre += p / static_cast<double>(count_);
    double square = 0;
    for (Complex& p : points) square += std::norm(p -= centre);
    for (Complex& p : points) p /= std::sqrt(square);
    TechniqueTemplate made{technique, std::move(points), corners, weight};
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

/// Two legs of like length: neither has more than twice, or one more than, the bite vectors of the other.
bool alike(int a, int b) {
  return std::max(a, b) <= std::max(2 * std::min(a, b), std::min(a, b) + 1);
}

/// U and Z: two legs joined by a bar that turns by `turn` [rad] from the first and by `back` into the second.
void addTwoCorners(Album& album, Technique technique, double turn, double back, double weight) {
  const int vectors = album.count() - 1;
  for (int first = 1; first <= vectors - 2; ++first)
    for (int bar = 1; bar <= vectors - 1 - first; ++bar) {
      const int last = vectors - first - bar;
      if (!alike(first, last) || bar > 2 * std::max(first, last)) continue;
      const std::array<int, 2> corners{first, first + bar};
      // bites spaced equally everywhere, or legs of equal length whatever the number of their bites
      album.add(technique,
                bitesAtCorners({{0, 1.0 * first, first}, {turn, 1.0 * bar, bar}, {turn + back, 1.0 * last, last}}),
                corners, weight);
      if (first != last)
        album.add(technique,
                  bitesAtCorners({{0, 1, first}, {turn, 2.0 * bar / (first + last), bar}, {turn + back, 1, last}}),
                  corners, weight);
    }
}

/// A U or Z whose corners no bite needs to hit, for those who space bites evenly along a line they see.
void addTwoCornersAlong(Album& album, Technique technique, double turn, double back, double bar, double weight) {
  const int last = album.count() - 1;
  const auto corner = [&](double at) { return static_cast<int>(std::lround(last * at / (2 + bar))); };
  const std::array<int, 2> corners{std::max(1, corner(1)), std::min(last - 1, corner(1 + bar))};
  if (corners[0] >= corners[1]) return;
  album.add(technique, bitesAlong({{0, 1, 1}, {turn, bar, 1}, {turn + back, 1, 1}}, album.count(), 1), corners, weight);
}

void addU(Album& album) {
  for (const double lean : {-20, 0, 20})
    addTwoCorners(album, Technique::U, (90 + lean) * kDegree, (90 - lean) * kDegree, lean == 0 ? 1 : 0.5);
  if (album.count() >= 6)
    for (const double bar : {0.5, 0.8}) addTwoCornersAlong(album, Technique::U, 90 * kDegree, 90 * kDegree, bar, 0.5);
}

void addZ(Album& album) {
  for (const double turn : {95, 120, 135, 150}) addTwoCorners(album, Technique::Z, turn * kDegree, -turn * kDegree, 1);
  if (album.count() >= 6)
    for (const double bar : {1.0, 1.4})
      addTwoCornersAlong(album, Technique::Z, 130 * kDegree, -130 * kDegree, bar, 0.5);
}

void addTriangular(Album& album) {
  const int vectors = album.count() - 1;
  for (int first = 1; first <= vectors - 1; ++first) {
    const int last = vectors - first;
    if (!alike(first, last)) continue;
    for (const double turn : {100, 120, 140}) {
      album.add(Technique::Triangular, bitesAtCorners({{0, 1.0 * first, first}, {turn * kDegree, 1.0 * last, last}}));
      if (first != last) album.add(Technique::Triangular, bitesAtCorners({{0, 1, first}, {turn * kDegree, 1, last}}));
    }
  }
  for (int first = 1; first <= vectors - 2; ++first)
    for (int second = 1; second <= vectors - 1 - first; ++second) {
      const int last = vectors - first - second;
      if (!alike(first, second) || !alike(second, last) || !alike(first, last)) continue;
      album.add(Technique::Triangular,
                bitesAtCorners({{0, 1, first}, {120 * kDegree, 1, second}, {240 * kDegree, 1, last}}), {-1, -1}, 2);
      if (last >= 2 || vectors >= 5)
        album.add(Technique::Triangular,
                  bitesAtCorners({{0, 1, first}, {120 * kDegree, 1, second}, {240 * kDegree, 0.67, last}}));
    }
  for (const double used : {1.0, 1.0 - 1.0 / album.count()})
    if (album.count() >= 6)
      album.add(Technique::Triangular,
                bitesAlong({{0, 1, 1}, {120 * kDegree, 1, 1}, {240 * kDegree, 1, 1}}, album.count(), used));
}

void addSquare(Album& album) {
  const int vectors = album.count() - 1;
  const double turn = 90 * kDegree;
  for (int a = 1; a <= vectors - 3; ++a)
    for (int b = 1; b <= vectors - 2 - a; ++b)
      for (int c = 1; c <= vectors - 1 - a - b; ++c) {
        const int d = vectors - a - b - c;
        const auto [least, most] = std::minmax({a, b, c, d});
        if (!alike(least, most)) continue;
        album.add(Technique::Square, bitesAtCorners({{0, 1, a}, {turn, 1, b}, {2 * turn, 1, c}, {3 * turn, 1, d}}));
        album.add(Technique::Square, bitesAtCorners({{0, 1, a}, {turn, 1, b}, {2 * turn, 1, c}, {3 * turn, 0.6, d}}),
                  {-1, -1}, 0.5);
      }
  for (const double used : {1.0, 1.0 - 1.0 / album.count()})
    if (album.count() >= 6)
      album.add(Technique::Square,
                bitesAlong({{0, 1, 1}, {turn, 1, 1}, {2 * turn, 1, 1}, {3 * turn, 1, 1}}, album.count(), used));
}

Points arc(int count, double sweep) {
  Points points;
  for (int k = 0; k < count; ++k) points.push_back(std::polar(1.0, sweep * k / (count - 1)));
  return points;
}

void addC(Album& album) {
  // with four bites the chords of three quarters of a circle are three sides of a square, which is a U
  const int most = album.count() == 4 ? 210 : 280;
  for (int sweep = 170; sweep <= most; sweep += 20) album.add(Technique::C, arc(album.count(), sweep * kDegree));
}

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
  addTriangular(album);
  addSquare(album);
  addC(album);
  addRunning(album);
  return album.take();
}

}  // namespace vibe
