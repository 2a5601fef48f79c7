#include "vibe_core/suture/technique.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "suture/technique_templates.hpp"
#include "vibe_core/program/word_of.hpp"

namespace vibe {
namespace {

// Tolerances for hand-placed patterns. Lengths are in mean distances of consecutive bites.
constexpr double kScatter = 0.15;     // standard deviation of a bite per direction
constexpr double kDistortion = 0.16;  // ... of (a - b) / (a + b), a and b the principal stretches of the drawing
constexpr double kWrap = 0.9;         // ... of the angle around a cylindrical wall [rad]
constexpr double kMaxMisfit = 2;      // misfit per free coordinate above which a set is no technique ...
constexpr double kSpareMisfit = 10;   // ... plus this constant
constexpr double kUsual =
    1.386;  // subtracted from the misfit of a U, the most common technique: it counts twice (2 log 2)
constexpr double kHopeless = 30;  // a wall that fits worse than the best by this much is skipped

using Complex = std::complex<double>;

bool usable(const std::vector<Eigen::Vector3d>& bites) {
  const int count = static_cast<int>(std::min<std::size_t>(bites.size(), kTechniqueMaxBites + 1));
  if (count < kTechniqueMinBites || count > kTechniqueMaxBites) return false;
  return std::all_of(bites.begin(), bites.end(), [](const Eigen::Vector3d& b) { return b.allFinite(); });
}

/// Bites relative to their centre in mean distances of consecutive bites; empty if they all coincide.
std::vector<Eigen::Vector3d> normalised(const std::vector<Eigen::Vector3d>& bites) {
  double largest = 0;
  for (const auto& bite : bites) largest = std::max(largest, (bite - bites[0]).cwiseAbs().maxCoeff());
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  std::vector<Eigen::Vector3d> result;
  for (const auto& bite : bites)
    result.push_back((bite - bites[0]) / largest);  // so that squares do not overflow or underflow
  double path = 0;
  for (std::size_t k = 1; k < result.size(); ++k) path += (result[k] - result[k - 1]).norm();
  const double mean = path / static_cast<double>(result.size() - 1);
  for (auto& bite : result) bite /= mean;
  return result;
}

/// Misfit between a pattern and bites laid flat, minimised over position, size, orientation, reflection and distortion.
/// In complex coordinates every affine map of the pattern z is a z + b conj(z) + c, and |b| / |a| is the distortion (a
/// - b) / (a + b) of its principal stretches. The minimum is therefore the solution of two complex linear equations,
/// with a penalty on b (or on a, for the reflected pattern).
/// @param square  sum of squares of the bites; the pattern is scaled to their size, so that |a| is near 1
double misfit(const TechniqueTemplate& drawing, const std::vector<Complex>& bites, double square) {
  double rr = 0, ii = 0, ri = 0, ir = 0;  // products of real and imaginary parts, from which both sums are computed
  for (std::size_t k = 0; k < bites.size(); ++k) {
    rr += drawing.bites[k].real() * bites[k].real();
    ii += drawing.bites[k].imag() * bites[k].imag();
    ri += drawing.bites[k].real() * bites[k].imag();
    ir += drawing.bites[k].imag() * bites[k].real();
  }
  Complex along(rr + ii, ri - ir), against(rr - ii, ri + ir);  // of conj(drawing) and of drawing with the bites
  const double size = std::sqrt(square);
  along *= size, against *= size;
  const Complex own = square * drawing.own;
  const double stiff = square + kScatter * kScatter / (kDistortion * kDistortion);
  const double determinant = square * stiff - std::norm(own);
  const auto explained = [&](Complex free, Complex penalised, Complex mixed) {
    const Complex a = stiff * free - mixed * penalised, b = square * penalised - std::conj(mixed) * free;
    return (std::conj(a) * free + std::conj(b) * penalised).real() / determinant;
  };
  const double max = std::max(explained(along, against, own), explained(against, along, std::conj(own)));
  return std::max(0.0, square - max) / (kScatter * kScatter);
}

/// Accumulates -2 log of the weighted mean of exp(-misfit / 2), which is the misfit of a technique with many patterns.
/// A technique then gains no advantage from its number of patterns.
struct MeanMisfit {
  double min = std::numeric_limits<double>::infinity();
  double sum = 0;  // of weight * exp((least - misfit) / 2), which does not underflow for large misfits
  const TechniqueTemplate* best = nullptr;

  void add(double misfit, double weight, const TechniqueTemplate& drawing) {
    if (misfit < min) {
      sum *= math::exp((misfit - min) / 2);
      min = misfit;
      best = &drawing;
    }
    sum += weight * math::exp((min - misfit) / 2);
  }
  double value() const {
    if (best == nullptr) return min;
    return min - 2 * math::log(sum) - (best->technique == Technique::U ? kUsual : 0);
  }
};

using Comparison = std::array<MeanMisfit, kTechniqueCount>;

Comparison compare(const std::vector<TechniqueTemplate>& drawings, std::vector<FlatBites> walls) {
  const auto fixed = [](const FlatBites& wall) {
    return wall.off_wall / (kScatter * kScatter) + wall.wrap * wall.wrap / (kWrap * kWrap);
  };
  std::stable_sort(walls.begin(), walls.end(),
                   [&](const FlatBites& a, const FlatBites& b) { return fixed(a) < fixed(b); });
  Comparison result;
  for (const FlatBites& wall : walls) {
    if (fixed(wall) > fixed(walls.front()) + kHopeless) break;
    double square = 0;
    for (const Complex& p : wall.bites) square += std::norm(p);
    if (!(square > 1e-12)) continue;
    for (const TechniqueTemplate& drawing : drawings)
      result[static_cast<int>(drawing.technique)].add(fixed(wall) + misfit(drawing, wall.bites, square),
                                                      drawing.weight / static_cast<double>(walls.size()), drawing);
  }
  return result;
}

TechniqueResult nearestDrawing(const std::vector<Eigen::Vector3d>& scaled) {
  const int count = static_cast<int>(scaled.size());
  const std::vector<TechniqueTemplate> drawings = techniqueTemplates(count);
  const Comparison misfits = compare(drawings, layFlat(scaled));
  std::array<int, kTechniqueCount - 1> order{1, 2, 3, 4, 5, 6};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return misfits[a].value() < misfits[b].value(); });
  const double min = misfits[order[0]].value();
  const double limit =
      kSpareMisfit + kMaxMisfit * (3 * count - 6);  // degrees of freedom without position and orientation
  TechniqueResult result;
  if (min < limit) {
    result.technique = static_cast<Technique>(order[0]);
    for (int k = 0; k < 2; ++k) result.transitions[k] = std::max(-1, misfits[order[0]].best->corners[k] - 1);
  }
  const double rival = min < limit ? std::min(limit, misfits[order[1]].value()) : limit;
  result.margin = std::isfinite(min) ? math::tanh(std::abs(rival - min) / 4) : 0;
  return result;
}

/// Equations 1 to 4. A zero vector has no direction: every comparison with it fails, as with the NaN that the division
/// would give.
TechniqueResult printedRule(const std::vector<Eigen::Vector3d>& bites) {
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t k = 1; k < bites.size(); ++k) directions.push_back((bites[k] - bites[k - 1]).stableNormalized());
  TechniqueResult result;
  double margin = 1;
  int found = 0;
  for (std::size_t k = 1; k < directions.size(); ++k) {
    const double dot = directions[k - 1].dot(directions[k]);
    margin = std::min(margin, std::abs(dot + 0.5));
    if (!(dot <= -0.5)) continue;
    if (found < 2) result.transitions[found] = static_cast<int>(k) - 1;
    ++found;
  }
  const double ends = directions.front().dot(directions.back());
  if (found == 2) margin = std::min(margin, std::min(std::abs(ends - 0.7), std::abs(ends + 0.7)));
  if (found == 2 && ends > 0.7) result.technique = Technique::Z;
  if (found == 2 && ends < -0.7) result.technique = Technique::U;
  if (result.technique == Technique::Other) result.transitions = {-1, -1};
  result.margin = margin;
  return result;
}

}  // namespace

const char* toString(Technique technique) {
  return wordOf(technique, {"other", "u", "z", "triangular", "square", "running", "c"});
}

TechniqueResult recogniseTechnique(const std::vector<Eigen::Vector3d>& bites, TechniqueRule rule) {
  if (!usable(bites)) return {};
  const std::vector<Eigen::Vector3d> scaled = normalised(bites);
  if (scaled.empty()) return {};
  return rule == TechniqueRule::Printed ? printedRule(scaled) : nearestDrawing(scaled);
}

}  // namespace vibe
