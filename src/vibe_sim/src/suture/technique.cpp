#include "vibe_sim/suture/technique.hpp"

#include <algorithm>
#include <cmath>

#include "technique_templates.hpp"
#include "technique_wall.hpp"

namespace vibe {
namespace {

// What a hand may do to a drawing before it stops being one. Lengths are in mean distances of successive bites.
constexpr double kScatter = 0.15;    // standard deviation of a bite per direction
constexpr double kDistortion = 0.2;  // ... of (a - b) / (a + b), a and b the principal stretches of the drawing
constexpr double kWrap = 0.9;        // ... of the angle around a cylindrical wall [rad]
constexpr double kMostMisfit = 4.5;  // misfit per free coordinate at which a set is no technique any more

using Complex = std::complex<double>;

bool usable(const std::vector<Eigen::Vector3d>& bites) {
  const int count = static_cast<int>(std::min<std::size_t>(bites.size(), kTechniqueMostBites + 1));
  if (count < kTechniqueLeastBites || count > kTechniqueMostBites) return false;
  return std::all_of(bites.begin(), bites.end(), [](const Eigen::Vector3d& b) { return b.allFinite(); });
}

/// Bites about their centre in mean distances of successive ones; empty: they coincide all.
std::vector<Eigen::Vector3d> normalised(const std::vector<Eigen::Vector3d>& bites) {
  double largest = 0;
  for (const auto& bite : bites) largest = std::max(largest, (bite - bites[0]).cwiseAbs().maxCoeff());
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  std::vector<Eigen::Vector3d> result;
  for (const auto& bite : bites) result.push_back((bite - bites[0]) / largest);  // so that squares stay in range
  double path = 0;
  for (std::size_t k = 1; k < result.size(); ++k) path += (result[k] - result[k - 1]).norm();
  const double mean = path / static_cast<double>(result.size() - 1);
  for (auto& bite : result) bite /= mean;
  return result;
}

/// How badly a drawing fits bites laid flat, least over position, size, orientation, reflection and distortion.
/// In complex coordinates every affine map of the drawing z is a z + b conj(z) + c, and |b| / |a| is the distortion
/// (a - b) / (a + b) of its principal stretches; so the least is the solution of two complex linear equations, with a
/// penalty on b (or on a, of the reflected drawing).
double misfit(const TechniqueTemplate& drawing, const FlatBites& flat, double square) {
  const double size = std::sqrt(square);  // the drawing is brought to the size of the bites, so that |a| is near 1
  Complex along = 0, against = 0, own = 0;
  for (std::size_t k = 0; k < flat.bites.size(); ++k) {
    along += std::conj(drawing.bites[k]) * flat.bites[k];
    against += drawing.bites[k] * flat.bites[k];
    own += std::conj(drawing.bites[k] * drawing.bites[k]);
  }
  along *= size, against *= size, own *= square;
  const double stiff = square + std::pow(kScatter / kDistortion, 2);
  const double determinant = square * stiff - std::norm(own);
  const auto gain = [&](Complex p, Complex q, Complex mixed) {  // p with the free factor, q with the penalised one
    const Complex a = (stiff * p - mixed * q) / determinant, b = (square * q - std::conj(mixed) * p) / determinant;
    return (std::conj(a) * p + std::conj(b) * q).real();
  };
  const double explained = std::max(gain(along, against, own), gain(against, along, std::conj(own)));
  return std::max(0.0, square - explained) / (kScatter * kScatter);
}

struct Misfits {
  std::array<double, kTechniqueCount> of{};                    // per technique, over all its drawings and walls
  std::array<const TechniqueTemplate*, kTechniqueCount> best;  // the drawing that fits best
};

/// A technique's misfit is -2 log of the mean over its drawings of exp(-misfit / 2): many drawings of one technique
/// then give it no advantage over a technique with few.
Misfits compare(const std::vector<TechniqueTemplate>& drawings, const std::vector<FlatBites>& walls) {
  std::array<double, kTechniqueCount> sum{}, least;
  Misfits result;
  result.best.fill(nullptr);
  least.fill(1e300);
  for (int pass = 0; pass < 2; ++pass)  // the least first: exp() of what lies far above it would be zero
    for (const FlatBites& wall : walls) {
      double square = 0;
      for (const Complex& p : wall.bites) square += std::norm(p);
      if (!(square > 1e-12)) continue;
      const double fixed = wall.off_wall / (kScatter * kScatter) + std::pow(wall.wrap / kWrap, 2);
      for (const TechniqueTemplate& drawing : drawings) {
        const int t = static_cast<int>(drawing.technique);
        const double value = fixed + misfit(drawing, wall, square);
        if (pass == 1)
          sum[t] += drawing.weight / static_cast<double>(walls.size()) * std::exp((least[t] - value) / 2);
        else if (value < least[t])
          least[t] = value, result.best[t] = &drawing;
      }
    }
  for (int t = 0; t < kTechniqueCount; ++t) result.of[t] = sum[t] > 0 ? least[t] - 2 * std::log(sum[t]) : 1e300;
  return result;
}

TechniqueResult nearestDrawing(const std::vector<Eigen::Vector3d>& bites) {
  const std::vector<Eigen::Vector3d> scaled = normalised(bites);
  if (scaled.empty()) return {};
  const int count = static_cast<int>(scaled.size());
  const std::vector<TechniqueTemplate> drawings = techniqueTemplates(count);
  const Misfits misfits = compare(drawings, layFlat(scaled));
  std::array<int, kTechniqueCount - 1> order{1, 2, 3, 4, 5, 6};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return misfits.of[a] < misfits.of[b]; });
  const double least = misfits.of[order[0]], next = misfits.of[order[1]];
  const double limit = kMostMisfit * (3 * count - 6);  // free coordinates: all but position, orientation and size ...
  TechniqueResult result;
  if (!(least <= limit)) {
    result.margin = (least - limit) / (least + limit);
    return result;
  }
  result.technique = static_cast<Technique>(order[0]);
  result.margin = (std::min(next, limit + (limit - least)) - least) / (next + least);
  for (int k = 0; k < 2; ++k) result.transitions[k] = std::max(-1, misfits.best[order[0]]->corners[k] - 1);
  return result;
}

/// Equations 1 to 4. A vector without length has no direction: every comparison with it fails, as with the NaN that
/// the division would give.
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
  static constexpr const char* kNames[kTechniqueCount] = {"other", "u", "z", "triangular", "square", "running", "c"};
  const int index = static_cast<int>(technique);
  return index < kTechniqueCount ? kNames[index] : "unknown";
}

TechniqueResult recogniseTechnique(const std::vector<Eigen::Vector3d>& bites, TechniqueRule rule) {
  if (!usable(bites)) return {};
  return rule == TechniqueRule::Printed ? printedRule(bites) : nearestDrawing(bites);
}

}  // namespace vibe
