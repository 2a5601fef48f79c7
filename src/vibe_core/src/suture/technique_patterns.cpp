#include "vibe_core/suture/technique_patterns.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {
namespace {

using Flat = std::vector<Eigen::Vector2d>;  // x around the organ, y along it

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  double uniform() { return nextUniform(state_); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int below(int count) { return static_cast<int>(nextInteger(state_) % static_cast<std::uint64_t>(count)); }
  double normal() {  // Box & Muller 1958
    const double size = std::sqrt(-2 * math::log(1 - uniform()));
    return size * math::cos(2 * kPi * uniform());
  }
  Eigen::Vector3d normal3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

 private:
  std::uint64_t state_;
};

/// Turtle graphics: bites a unit apart, `vectors` of them per leg, legs scaled to the given lengths.
void walk(Flat& bites, double direction, double length, int vectors) {
  const Eigen::Vector2d step = length / vectors * Eigen::Vector2d(math::cos(direction), math::sin(direction));
  for (int k = 0; k < vectors; ++k) bites.push_back(bites.back() + step);
}

/// Distributes bite vectors among legs as evenly as possible; random legs get the remainder.
std::vector<int> share(Random& random, int vectors, int legs) {
  std::vector<int> shared(legs, vectors / legs);
  const int start = random.below(legs);
  for (int k = 0; k < vectors % legs; ++k) ++shared[(start + k) % legs];
  return shared;
}

/// Two legs of equal length and a bar of one to a third of all vectors. A remaining odd vector goes to one of the three
/// at random.
Flat drawTwoCorners(Random& random, int vectors, double turn, double back, double bar_length) {
  int bar = 1 + random.below(std::max(1, vectors / 3));
  int first = (vectors - bar) / 2, last = first;
  int* const lucky[] = {&first, &bar, &last};
  if (first + bar + last < vectors) ++*lucky[random.below(3)];
  const double leg = (first + last) / 2.0;
  Flat bites{Eigen::Vector2d::Zero()};
  walk(bites, 0, leg, first);
  walk(bites, turn, bar * bar_length, bar);
  walk(bites, turn + back, leg, last);
  return bites;
}

Flat drawU(Random& random, int vectors) {
  return drawTwoCorners(random, vectors, kPi / 2, kPi / 2, random.uniform(0.8, 1.2));
}

Flat drawZ(Random& random, int vectors) {
  const double turn = random.uniform(110, 145) * kDegree;
  return drawTwoCorners(random, vectors, turn, -turn, random.uniform(1.0, 1.4));
}

/// Two legs that form a corner, or (half of the time) all three sides.
Flat drawTriangular(Random& random, int vectors) {
  Flat bites{Eigen::Vector2d::Zero()};
  const bool closed = random.below(2) == 0;
  const double corner = random.uniform(45, 75) * kDegree;
  const std::vector<int> shared = share(random, vectors, closed ? 3 : 2);
  for (std::size_t k = 0; k < shared.size(); ++k)
    walk(bites, static_cast<double>(k) * (closed ? 120 * kDegree : kPi - corner),
         vectors / static_cast<double>(shared.size()), shared[k]);
  return bites;
}

/// Four sides; where a side is made of several vectors, the last bite may be left out.
Flat drawSquare(Random& random, int vectors) {
  const bool open = vectors >= 7 && random.below(2) == 0;
  std::vector<int> shared = share(random, vectors + (open ? 1 : 0), 4);
  Flat bites{Eigen::Vector2d::Zero()};
  for (int k = 0; k < 4; ++k) walk(bites, k * kPi / 2, vectors / 4.0, shared[k]);
  if (open) bites.pop_back();
  return bites;
}

/// An arc of half to three quarters of a circle. With four bites it spans at most 210 degrees, because three chords of
/// three quarters of a circle are three sides of a square, a U.
Flat drawC(Random& random, int vectors) {
  const double sweep = random.uniform(180, vectors == 3 ? 210 : 270) * kDegree;
  Flat bites;
  for (int k = 0; k <= vectors; ++k) {
    const double angle = sweep * k / vectors;
    bites.push_back(vectors / sweep * Eigen::Vector2d(math::cos(angle), math::sin(angle)));
  }
  return bites;
}

/// A line along the organ: straight, curved, or a slight zigzag.
Flat drawRunning(Random& random, int vectors) {
  const double bend = random.uniform(-40, 40) * kDegree / vectors, zigzag = random.uniform(0, 0.2);
  double direction = random.uniform(70, 110) * kDegree - bend * vectors / 2;
  Flat bites{Eigen::Vector2d::Zero()};
  for (int k = 0; k < vectors; ++k) walk(bites, direction += bend, 1, 1);
  for (int k = 0; k <= vectors; k += 2) bites[k].x() += zigzag;
  return bites;
}

Flat draw(Random& random, Technique technique, int vectors) {
  constexpr std::array kDrawings{drawU, drawZ, drawTriangular, drawSquare, drawRunning, drawC};
  return kDrawings[static_cast<std::size_t>(technique) - 1](random, vectors);
}

/// Skews, stretches, rotates (except a running suture, which has a direction on the organ), reflects and centres.
void distort(Random& random, const PatternRanges& ranges, bool turn, Flat& bites) {
  Eigen::Matrix2d map;
  map << 1, math::tan(random.uniform(-ranges.skew, ranges.skew)), 0,
      math::exp(random.uniform(math::log(ranges.min_stretch), math::log(ranges.max_stretch)));
  if (random.below(2) == 0) map.col(1) *= -1;
  const double angle = turn ? random.uniform(0, 2 * kPi) : 0;
  map = (Eigen::Matrix2d() << math::cos(angle), -math::sin(angle), math::sin(angle), math::cos(angle)).finished() * map;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (auto& bite : bites) centre += (bite = map * bite) / static_cast<double>(bites.size());
  for (auto& bite : bites) bite -= centre;
}

/// Point of an ellipsoid of revolution about z that lies y [m] along a meridian from the equator and x around.
Eigen::Vector3d onEllipsoid(const Eigen::Vector2d& bite, double radius, double half_length) {
  constexpr int kSteps = 64;
  double latitude = 0;
  for (int k = 0; k < kSteps; ++k)
    latitude += bite.y() / kSteps / math::hypot(radius * math::sin(latitude), half_length * math::cos(latitude));
  const double around = radius * math::cos(latitude), angle = bite.x() / around;
  return {around * math::cos(angle), around * math::sin(angle), half_length * math::sin(latitude)};
}

Eigen::Vector3d onCylinder(const Eigen::Vector2d& bite, double radius) {
  const double angle = bite.x() / radius;
  return {radius * math::cos(angle), radius * math::sin(angle), bite.y()};
}

void checkRequest(Technique technique, int bite_count, double noise) {
  if (technique == Technique::Other) throw Error("A pattern of technique 'other' cannot be drawn; name another.");
  if (bite_count < fewestBites(technique) || bite_count > kTechniqueMaxBites)
    throw Error("A pattern '" + std::string(toString(technique)) + "' cannot have " + std::to_string(bite_count) +
                " bites; ask for " + std::to_string(fewestBites(technique)) + " to " +
                std::to_string(kTechniqueMaxBites) + ".");
  if (!(noise >= 0) || !std::isfinite(noise)) throw Error("The noise of a pattern must be a number of 0 or more.");
}

double pathLength(const Flat& bites) {
  double path = 0;
  for (std::size_t k = 1; k < bites.size(); ++k) path += (bites[k] - bites[k - 1]).norm();
  return path;
}

}  // namespace

int fewestBites(Technique technique) {
  return technique == Technique::Square ? 5 : kTechniqueMinBites;
}

TechniquePattern drawTechniquePattern(Technique technique, int bite_count, double noise, std::uint64_t seed,
                                      const PatternRanges& ranges) {
  checkRequest(technique, bite_count, noise);
  Random random(seed);
  Flat flat = draw(random, technique, bite_count - 1);
  distort(random, ranges, technique != Technique::Running, flat);
  const double wanted = random.uniform(ranges.min_spacing, ranges.max_spacing);
  const double spacing = std::min(wanted, ranges.longest / (bite_count - 1));
  const double scale = spacing * (bite_count - 1) / pathLength(flat);
  const double radius = random.uniform(ranges.min_radius, ranges.max_radius);
  const bool ellipsoid = random.below(2) == 0;
  const Eigen::Vector3d x = random.normal3(), y = random.normal3();
  const Eigen::Matrix3d pose = Eigen::Quaterniond(x.x(), x.y(), x.z(), y.x()).normalized().toRotationMatrix();
  TechniquePattern pattern{technique, {}};
  for (const Eigen::Vector2d& bite : flat) {
    const Eigen::Vector3d on_wall =
        ellipsoid ? onEllipsoid(bite * scale, radius, ranges.half_length) : onCylinder(bite * scale, radius);
    pattern.bites.push_back(pose * (on_wall + noise * spacing * random.normal3()) + 0.1 * y);
  }
  return pattern;
}

std::vector<Eigen::Vector3d> shuffled(std::vector<Eigen::Vector3d> bites, std::uint64_t seed) {
  Random random(seed);
  for (int k = static_cast<int>(bites.size()) - 1; k > 0; --k) std::swap(bites[k], bites[random.below(k + 1)]);
  return bites;
}

}  // namespace vibe
