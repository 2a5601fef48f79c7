#include "vibe_graphics/geometry/mucosa_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "geometry/surface_graph.hpp"
#include "vibe_graphics/geometry/mucosa_pattern.hpp"

namespace vibe::graphics {

namespace {

// numbers of vibe_msgs/TissueTopology
enum Region : std::uint8_t { Cardia, Fundus, Body, Antrum, Pylorus };
enum End : std::uint8_t { Oesophagus = 1, Duodenum = 2 };

constexpr double kTurn = 30e-3;  // blurs the walls: about the radius of the body, which leaves the first harmonic [m]
constexpr double kRegionBlur = 8e-3;   // blurs borders of regions [m]
constexpr double kCardia = 20e-3;      // reach of the region cardia beyond the junction, as the simulator labels it [m]
constexpr double kRing = 3e-3;         // length of the sections of which the narrowest is the pylorus [m]
constexpr double kWellDefined = 0.12;  // length of the blurred direction from which on the angle is fully used
// Where 30 folds around would be less than 4.5 mm wide the angle is used less, below 2.6 mm not at all [rad/m].
constexpr double kDense = 47, kCrowded = 80;

// Share of the folds and of the look of the antrum: cardia, fundus, body, antrum, pylorus. The rugae are those of body
// and fundus; the antrum is nearly smooth (Standring, Gray's Anatomy, 41st edition, chapter 64).
constexpr std::array<double, 5> kFolded{0, 0.85, 1, 0.15, 0}, kAntral{0, 0, 0, 1, 1};

// Stretch around the organ that uses up the folds. Body, fundus and antrum: what 95 % of the region exceed at 10 mmHg
// in the default scene (docs/endoscope_look.md), so that the pressure of endoscopy makes them smooth. Others: design
// choice.
constexpr std::array<double, 5> kSmoothStretch{1.10, 1.071, 1.111, 1.060, 1.05};

enum Column { Cosine, Sine, FoldShare, AntrumShare, Smooth, BeyondZ, BeyondRing, kColumns };

std::vector<std::uint32_t> withNumber(const std::vector<std::uint8_t>& numbers, std::uint8_t wanted) {
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i] == wanted) found.push_back(static_cast<std::uint32_t>(i));
  return found;
}

/// Walls are quarters: anterior, greater curvature, posterior, lesser curvature.
Eigen::MatrixXd wallDirections(const TissueMesh& mesh) {
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.particle_count), 2);
  for (std::size_t i = 0; i < mesh.wall.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const int wall = mesh.wall[i] % 4;
    directions(row, 0) = wall == 0 ? 1 : wall == 2 ? -1 : 0;
    directions(row, 1) = wall == 1 ? 1 : wall == 3 ? -1 : 0;
  }
  return directions;
}

Eigen::MatrixXd regionShares(const TissueMesh& mesh) {
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.particle_count), 3);
  shares.col(2).setConstant(kSmoothStretch[Body]);
  for (std::size_t i = 0; i < mesh.region.size(); ++i) {
    const std::size_t region = std::min<std::size_t>(mesh.region[i], Pylorus);
    shares.row(static_cast<Eigen::Index>(i)) << kFolded[region], kAntral[region], kSmoothStretch[region];
  }
  return shares;
}

/// Where the oesophagus ends: the region cardia reaches a fixed way beyond it.
Eigen::VectorXd beyondZLine(const TissueMesh& mesh, const SurfaceGraph& graph) {
  const auto count = static_cast<Eigen::Index>(mesh.particle_count);
  const std::vector<std::uint32_t> gullet = withNumber(mesh.end, Oesophagus);
  if (gullet.empty()) return Eigen::VectorXd::Ones(count);
  const std::vector<double> distance = graph.distanceTo(gullet);
  double reach = 0;
  for (const std::uint32_t i : withNumber(mesh.region, Cardia))
    if (std::isfinite(distance[i])) reach = std::max(reach, distance[i]);
  Eigen::VectorXd beyond(count);
  for (Eigen::Index i = 0; i < count; ++i)
    beyond[i] = std::min(distance[static_cast<std::size_t>(i)], 1.0) - std::max(0.0, reach - kCardia);
  return beyond;
}

/// Distance from the duodenal end to the narrowest section of the region pylorus.
double narrowestSection(const TissueMesh& mesh, const std::vector<double>& distance, const Eigen::Matrix3Xf& place) {
  std::vector<std::vector<std::uint32_t>> sections;
  for (const std::uint32_t i : withNumber(mesh.region, Pylorus)) {
    if (!std::isfinite(distance[i]) || distance[i] > 1) continue;
    const auto section = static_cast<std::size_t>(distance[i] / kRing);
    if (sections.size() <= section) sections.resize(section + 1);
    sections[section].push_back(i);
  }
  double narrowest = 0, least = 1;
  for (std::size_t s = 1; s + 1 < sections.size(); ++s) {  // the end itself is a cap
    if (sections[s].size() < 4) continue;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const std::uint32_t i : sections[s]) middle += place.col(i) / static_cast<float>(sections[s].size());
    double radius = 0;
    for (const std::uint32_t i : sections[s])
      radius += static_cast<double>((place.col(i) - middle).norm()) / static_cast<double>(sections[s].size());
    if (radius < least) least = radius, narrowest = (static_cast<double>(s) + 0.5) * kRing;
  }
  return narrowest;
}

Eigen::VectorXd beyondPylorus(const TissueMesh& mesh, const SurfaceGraph& graph, const Eigen::Matrix3Xf& place) {
  const auto count = static_cast<Eigen::Index>(mesh.particle_count);
  const std::vector<std::uint32_t> duodenum = withNumber(mesh.end, Duodenum);
  if (duodenum.empty()) return -Eigen::VectorXd::Ones(count);
  const std::vector<double> distance = graph.distanceTo(duodenum);
  const double ring = narrowestSection(mesh, distance, place);
  Eigen::VectorXd beyond(count);
  for (Eigen::Index i = 0; i < count; ++i) beyond[i] = ring - std::min(distance[static_cast<std::size_t>(i)], 1.0);
  return beyond;
}

/// How many radians the angle turns per metre, at most, along the edges from each particle.
std::vector<double> turnRate(const TissueMesh& mesh, const Eigen::MatrixXd& values, const Eigen::Matrix3Xf& place) {
  std::vector<double> rate(mesh.particle_count, 0);
  for (std::size_t k = 0; k < mesh.particle_triangles.size(); ++k) {
    const std::size_t next = k % 3 == 2 ? k - 2 : k + 1;
    const std::uint32_t a = mesh.particle_triangles[k], b = mesh.particle_triangles[next];
    const double length = static_cast<double>((place.col(a) - place.col(b)).norm());
    const double sine = values(a, Cosine) * values(b, Sine) - values(a, Sine) * values(b, Cosine);
    const double cosine = values(a, Cosine) * values(b, Cosine) + values(a, Sine) * values(b, Sine);
    const double turned = length > 0 ? std::abs(std::atan2(sine, cosine)) / length : 0;
    rate[a] = std::max(rate[a], turned), rate[b] = std::max(rate[b], turned);
  }
  return rate;
}

/// Shortens directions, so that the length says how well they are defined.
void normaliseDirections(const std::vector<double>& rate, Eigen::MatrixXd& values) {
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const double length = std::hypot(values(i, Cosine), values(i, Sine));
    const double crowded = (kCrowded - rate[static_cast<std::size_t>(i)]) / (kCrowded - kDense);
    const double share = std::min(1.0, length / kWellDefined) * std::clamp(crowded, 0.0, 1.0);
    if (length > 0) values(i, Cosine) *= share / length, values(i, Sine) *= share / length;
  }
}

/// @param rest  x y z [m]
MucosaVertex entryOf(const Eigen::RowVectorXd& values, const float* rest, const Eigen::Vector3f& shift) {
  const Eigen::RowVectorXf row = values.cast<float>();
  const Eigen::Vector3f place = Eigen::Map<const Eigen::Vector3f>(rest) + shift;
  const float bend = foldBend(place), broad = broadPattern(place);
  return {{row[Cosine], row[Sine]}, bend, broad, row[FoldShare], row[AntrumShare], row[BeyondZ], row[BeyondRing]};
}

MucosaMap entriesOf(const TissueMesh& mesh, const Eigen::MatrixXd& values, const Eigen::Vector3f& shift) {
  MucosaMap map;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    map.of_particle.push_back(entryOf(values.row(i), &mesh.particle_rest[3 * static_cast<std::size_t>(i)], shift));
    map.smooth_stretch.push_back(static_cast<float>(values(i, Smooth)));
  }
  if (!mesh.subdivided()) map.of_vertex = map.of_particle;
  for (std::size_t v = 0; v + 1 < mesh.render_offsets.size(); ++v) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(kColumns);
    for (std::uint32_t k = mesh.render_offsets[v]; k < mesh.render_offsets[v + 1]; ++k)
      row += static_cast<double>(mesh.render_weights[k]) * values.row(mesh.render_particles[k]);
    map.of_vertex.push_back(entryOf(row, &mesh.rest[3 * v], shift));
  }
  return map;
}

}  // namespace

MucosaMap mapMucosa(const TissueMesh& mesh, const Eigen::Vector3f& shift) {
  const Eigen::Map<const Eigen::Matrix3Xf> place(mesh.particle_rest.data(), 3,
                                                 static_cast<Eigen::Index>(mesh.particle_count));
  const SurfaceGraph graph(mesh.particle_triangles, mesh.particle_rest);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(mesh.particle_count), kColumns);
  values.leftCols(2) = graph.blurred(wallDirections(mesh), kTurn);
  normaliseDirections(turnRate(mesh, values, place), values);
  values.middleCols(FoldShare, 3) = graph.blurred(regionShares(mesh), kRegionBlur);
  values.col(BeyondZ) = beyondZLine(mesh, graph);
  values.col(BeyondRing) = beyondPylorus(mesh, graph, place);
  // the oesophagus and the duodenum have no rugae
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    values(i, FoldShare) *= std::clamp(values(i, BeyondZ) / 10e-3, 0.0, 1.0);
  return entriesOf(mesh, values, shift);
}

namespace {

/// The unit direction in which the angle around the organ grows, in a triangle at rest; zero where it is not defined.
Eigen::Vector3f directionAround(const MucosaVertex* const corner[3], const Eigen::Vector3f& ab,
                                const Eigen::Vector3f& ac) {
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  for (int k = 0; k < 3; ++k) mean += Eigen::Vector2f(corner[k]->around[0], corner[k]->around[1]) / 3;
  if (mean.norm() < 0.5F) return Eigen::Vector3f::Zero();
  const auto turned = [&](int k) { return mean[0] * corner[k]->around[1] - mean[1] * corner[k]->around[0]; };
  const Eigen::Vector3f normal = ab.cross(ac);
  // gradient of a linear function on a triangle, times the square of its doubled area
  const Eigen::Vector3f gradient =
      (turned(1) - turned(0)) * ac.cross(normal) + (turned(2) - turned(0)) * normal.cross(ab);
  const float length = gradient.norm();
  return length > 0 ? Eigen::Vector3f(gradient / length) : Eigen::Vector3f::Zero();
}

}  // namespace

float foldHeight(float stretch, float smooth) {
  const float spare = (smooth - stretch) / (smooth - 1);
  return spare > 0 ? std::min(kTallestFold, kRestingFold * std::sqrt(spare)) : 0;
}

FoldHeight::FoldHeight(const TissueMesh& mesh, const MucosaMap& map)
    : smooth_(map.smooth_stretch),
      render_offsets_(mesh.render_offsets),
      render_particles_(mesh.render_particles),
      render_weights_(mesh.render_weights) {
  area_.assign(mesh.particle_count, 0);
  stretch_.assign(mesh.particle_count, 1);
  of_particle_.assign(mesh.particle_count, 0);
  heights_.assign(mesh.vertex_count, 0);
  for (const MucosaVertex& particle : map.of_particle) folded_.push_back(std::max(0.0F, particle.folded));
  const std::vector<float>& rest = mesh.particle_rest;
  for (std::size_t t = 0; t + 2 < mesh.particle_triangles.size(); t += 3) {
    const std::uint32_t* corner = &mesh.particle_triangles[t];
    const auto place = [&](int k) { return Eigen::Vector3f(&rest[3 * corner[k]]); };
    const MucosaVertex* const entries[3] = {&map.of_particle[corner[0]], &map.of_particle[corner[1]],
                                            &map.of_particle[corner[2]]};
    const Eigen::Vector3f ab = place(1) - place(0), ac = place(2) - place(0);
    const Eigen::Vector3f around = directionAround(entries, ab, ac);
    Eigen::Matrix2f gram;
    gram << ab.dot(ab), ab.dot(ac), ab.dot(ac), ac.dot(ac);
    const Eigen::Vector2f parts = gram.inverse() * Eigen::Vector2f(ab.dot(around), ac.dot(around));
    const float area = 0.5F * ab.cross(ac).norm();
    if (!(area > 0) || !parts.allFinite()) continue;  // a triangle without area has no stretch
    const bool directed = around.squaredNorm() > 0.5F;
    strips_.push_back({{corner[0], corner[1], corner[2]}, parts[0], parts[1], directed ? 1.0F : 0.0F, area});
    for (int k = 0; k < 3; ++k) area_[corner[k]] += area;
  }
}

const std::vector<float>& FoldHeight::update(const std::vector<float>& positions) {
  std::fill(stretch_.begin(), stretch_.end(), 0.0F);
  for (const Strip& strip : strips_) {
    const Eigen::Vector3f a(&positions[3 * strip.corner[0]]);
    const Eigen::Vector3f ab = Eigen::Vector3f(&positions[3 * strip.corner[1]]) - a;
    const Eigen::Vector3f ac = Eigen::Vector3f(&positions[3 * strip.corner[2]]) - a;
    const float stretch = strip.directed > 0 ? (strip.along_first * ab + strip.along_second * ac).norm()
                                             : std::sqrt(0.5F * ab.cross(ac).norm() / strip.area);
    for (const std::uint32_t corner : strip.corner) stretch_[corner] += strip.area * stretch;
  }
  for (std::size_t i = 0; i < stretch_.size(); ++i) {
    stretch_[i] = area_[i] > 0 ? stretch_[i] / area_[i] : 1;
    of_particle_[i] = folded_[i] * foldHeight(stretch_[i], smooth_[i]);
  }
  if (render_offsets_.empty()) return of_particle_;
  for (std::size_t v = 0; v < heights_.size(); ++v) {
    float height = 0;
    for (std::uint32_t k = render_offsets_[v]; k < render_offsets_[v + 1]; ++k)
      height += render_weights_[k] * of_particle_[render_particles_[k]];
    heights_[v] = std::max(height, 0.0F);
  }
  return heights_;
}

}  // namespace vibe::graphics
