#include "vibe_graphics/geometry/surface_colours.hpp"

#include <cmath>

namespace vibe::graphics {
namespace {

constexpr PackedColour kWhite = 0x00ffffffU;  // without alpha
constexpr PackedColour kNeverDrawn = 0x01000001U;
constexpr int kGradeStep = 85;  // of alpha from grade to grade

PackedColour listed(const std::vector<PackedColour>& colours, const std::vector<std::uint8_t>& numbers, std::size_t i) {
  if (i >= numbers.size() || numbers[i] >= colours.size()) return kWhite;
  return colours[numbers[i]] & kWhite;
}

}  // namespace

const std::vector<PackedColour>& regionColours() {
  static const std::vector<PackedColour> colours{
      packed(0.80, 0.47, 0.65),  // cardia
      packed(0.34, 0.71, 0.91),  // fundus
      packed(0.90, 0.62, 0.00),  // body
      packed(0.00, 0.62, 0.45),  // antrum
      packed(0.84, 0.37, 0.00),  // pylorus
  };
  return colours;
}

const std::vector<PackedColour>& wallColours() {
  static const std::vector<PackedColour> colours{
      packed(0.34, 0.71, 0.91),  // anterior
      packed(0.90, 0.62, 0.00),  // greater curvature
      packed(0.00, 0.62, 0.45),  // posterior
      packed(0.80, 0.47, 0.65),  // lesser curvature
  };
  return colours;
}

const std::vector<PackedColour>& seenColours() {
  static const std::vector<PackedColour> colours{
      packed(0.84, 0.37, 0.00),  // not seen
      packed(0.34, 0.71, 0.91),  // seen
  };
  return colours;
}

SurfaceColours::SurfaceColours(const TissueMesh& mesh)
    : region_(mesh.region),
      wall_(mesh.wall),
      thickness_(mesh.thickness),
      render_offsets_(mesh.render_offsets),
      render_particles_(mesh.render_particles),
      render_weights_(mesh.render_weights) {
  if (mesh.subdivided()) vertices_of_particle_ = turnedAround(render_offsets_, render_particles_, mesh.particle_count);
  of_particle_.assign(mesh.particle_count, kNeverDrawn);
  colours_.assign(mesh.vertex_count, 0xffffffffU);
  mark_.assign(mesh.vertex_count, 0);
}

void SurfaceColours::choose(Colouring colouring, const ColourMap& map) {
  colouring_ = colouring;
  map_ = map;
}

PackedColour SurfaceColours::valueColour(const std::vector<float>& values, std::size_t particle) const {
  return (values.empty() ? kWhite : map_.at(static_cast<double>(values[particle]))) & kWhite;
}

PackedColour SurfaceColours::particleColour(std::size_t particle, const TissueFrame& frame) const {
  const int grade = frame.grade.empty() ? 0 : frame.grade[particle];
  const auto alpha = static_cast<PackedColour>(255 - kGradeStep * grade) << 24;
  switch (colouring_) {
    case Colouring::Region:
      return alpha | listed(regionColours(), region_, particle);
    case Colouring::Wall:
      return alpha | listed(wallColours(), wall_, particle);
    case Colouring::Strain:
      return alpha | valueColour(frame.strain, particle);
    case Colouring::Heat:
      return alpha | valueColour(frame.dose, particle);
    case Colouring::Thickness:
      return alpha | valueColour(thickness_, particle);
    case Colouring::Seen:
      if (frame.first_seen.empty()) break;
      return alpha | (seenColours()[std::isnan(frame.first_seen[particle]) ? 0 : 1] & kWhite);
    case Colouring::Tissue:
      break;
  }
  return alpha | kWhite;
}

PackedColour SurfaceColours::blended(std::size_t vertex) const {
  if (render_offsets_.empty()) return of_particle_[vertex];
  float channel[4] = {0, 0, 0, 0};
  for (std::uint32_t k = render_offsets_[vertex]; k < render_offsets_[vertex + 1]; ++k) {
    const PackedColour colour = of_particle_[render_particles_[k]];
    for (int c = 0; c < 4; ++c) channel[c] += render_weights_[k] * static_cast<float>((colour >> (8 * c)) & 255U);
  }
  PackedColour result = 0;
  for (int c = 0; c < 4; ++c)
    result |= static_cast<PackedColour>(std::clamp(channel[c], 0.0F, 255.0F) + 0.5F) << (8 * c);
  return result;
}

VertexSpan SurfaceColours::update(const TissueFrame& frame) {
  touched_.clear();
  const auto touch = [this](std::uint32_t v) {
    if (mark_[v] == 0) mark_[v] = 1, touched_.push_back(v);
  };
  for (std::size_t i = 0; i < of_particle_.size(); ++i) {
    const PackedColour colour = particleColour(i, frame);
    if (colour == of_particle_[i]) continue;
    of_particle_[i] = colour;
    if (render_offsets_.empty())
      touch(static_cast<std::uint32_t>(i));
    else
      std::for_each(vertices_of_particle_.begin(i), vertices_of_particle_.end(i), touch);
  }
  VertexSpan span;
  for (const std::uint32_t v : touched_) colours_[v] = blended(v), span.add(v), mark_[v] = 0;
  return span;
}

}  // namespace vibe::graphics
