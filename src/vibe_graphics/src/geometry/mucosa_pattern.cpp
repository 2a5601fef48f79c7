#include "vibe_graphics/geometry/mucosa_pattern.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace vibe::graphics {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr int kVesselCells = 4;         // meshes of the net along an edge of the pattern
constexpr float kGroove = 0.30F;        // width of the slope beside a groove, in cells
constexpr float kLine = 0.075F;         // half width of a line of the net, in its cells
constexpr float kBend = 0.22F;          // how far lines are bent, in cells
constexpr int kSmooth = 4, kFine = 32;  // waves along an edge of the pattern

// Edges of the pattern where it is read as broad, and as net as in media/mucosa.frag [m]; the frame is that of the net.
constexpr float kBroadEdge = 0.17F, kNetEdge = 0.06F;
constexpr float kBroadBend = 16, kNetBend = 2;  // [rad]

/// Pseudo-random value from 0 to 1 (the finaliser of MurmurHash3).
float randomAt(const Vector3i& cell, std::uint32_t which) {
  std::uint32_t h = static_cast<std::uint32_t>(cell.x()) * 0x8da6b343U ^
                    static_cast<std::uint32_t>(cell.y()) * 0xd8163841U ^
                    static_cast<std::uint32_t>(cell.z()) * 0xcb1ab31fU ^ which * 0x9e3779b9U;
  h = (h ^ (h >> 16)) * 0x85ebca6bU;
  h = (h ^ (h >> 13)) * 0xc2b2ae35U;
  return static_cast<float>((h ^ (h >> 16)) >> 8) / 16777216.0F;
}

Vector3i wrapped(const Vector3i& cell, int period) {
  return cell.unaryExpr([period](int c) { return ((c % period) + period) % period; });
}

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// Value noise from 0 to 1 with `period` waves in the unit cube.
float noiseAt(const Vector3f& unit, int period, std::uint32_t which) {
  const Vector3f place = unit * static_cast<float>(period);
  const Vector3i cell = place.array().floor().cast<int>();
  Vector3f f = place - cell.cast<float>();
  f = f.unaryExpr([](float t) { return t * t * t * (t * (6 * t - 15) + 10); });
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const Vector3i corner(k & 1, (k >> 1) & 1, k >> 2);
    float weight = 1;
    for (int c = 0; c < 3; ++c) weight *= corner[c] == 1 ? f[c] : 1 - f[c];
    sum += weight * randomAt(wrapped(cell + corner, period), which);
  }
  return sum;
}

/// How much farther the second nearest seed is than the nearest, in cells: 0 on the border of two cells.
float borderAt(const Vector3f& unit, int period, std::uint32_t which) {
  const Vector3f place = unit * static_cast<float>(period);
  const Vector3i cell = place.array().floor().cast<int>();
  float nearest = 9, second = 9;
  for (int k = 0; k < 27; ++k) {
    const Vector3i other = cell + Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1), home = wrapped(other, period);
    const Vector3f seed(randomAt(home, which), randomAt(home, which + 1), randomAt(home, which + 2));
    const float distance = (other.cast<float>() + 0.1F * Vector3f::Ones() + 0.8F * seed - place).norm();
    if (distance < nearest)
      second = nearest, nearest = distance;
    else
      second = std::min(second, distance);
  }
  return second - nearest;
}

/// Smooth noise of three octaves about 0.5.
float cloudAt(const Vector3f& unit) {
  return 0.57F * noiseAt(unit, kSmooth, 21) + 0.28F * noiseAt(unit, 2 * kSmooth, 22) +
         0.15F * noiseAt(unit, 4 * kSmooth, 23);
}

/// Lines between the cells of a bent net.
float netAt(const Vector3f& unit) {
  Vector3f bend;
  for (int c = 0; c < 3; ++c) bend[c] = noiseAt(unit, 2 * kVesselCells, 31 + static_cast<std::uint32_t>(c)) - 0.5F;
  const float border = borderAt(unit + 2 * kBend / kVesselCells * bend, kVesselCells, 41);
  return 1 - smoothStep(0.3F * kLine, kLine, border);
}

std::array<float, 4> patternAt(const Vector3f& unit) {
  return {smoothStep(0, kGroove, borderAt(unit, kPatternCells, 11)), cloudAt(unit), netAt(unit),
          0.7F * noiseAt(unit, kFine, 51) + 0.3F * noiseAt(unit, kFine / 2, 52)};
}

Vector3f turnedFrame(const Vector3f& rest) {
  Eigen::Matrix3f turn;  // columns as in the shader
  turn << 0.36F, -0.8F, 0.48F, 0.48F, 0.6F, 0.64F, -0.8F, 0.0F, 0.6F;
  return turn * rest;
}

}  // namespace

float broadPattern(const Vector3f& rest) {
  return cloudAt(turnedFrame(rest) / kBroadEdge);
}

float foldBend(const Vector3f& rest) {
  const Vector3f turned = turnedFrame(rest), rolled(turned.z(), turned.x(), turned.y());
  return kBroadBend * (broadPattern(rest) - 0.5F) + kNetBend * (cloudAt(rolled / kNetEdge) - 0.5F);
}

MucosaPattern makeMucosaPattern() {
  MucosaPattern pattern;
  pattern.size = kPatternSize;
  pattern.voxels.reserve(std::size_t{4} * kPatternSize * kPatternSize * kPatternSize);
  for (int z = 0; z < kPatternSize; ++z)
    for (int y = 0; y < kPatternSize; ++y)
      for (int x = 0; x < kPatternSize; ++x)
        for (const float value : patternAt(Vector3i(x, y, z).cast<float>() / kPatternSize))
          pattern.voxels.push_back(static_cast<std::uint8_t>(255 * std::clamp(value, 0.0F, 1.0F) + 0.5F));
  return pattern;
}

MucosaPattern halved(const MucosaPattern& pattern) {
  MucosaPattern half;
  half.size = pattern.size / 2;
  const auto at = [&](int x, int y, int z, int c) {
    return int{pattern.voxels[static_cast<std::size_t>(4 * ((z * pattern.size + y) * pattern.size + x) + c)]};
  };
  for (int z = 0; z < half.size; ++z)
    for (int y = 0; y < half.size; ++y)
      for (int x = 0; x < half.size; ++x)
        for (int c = 0; c < 4; ++c) {
          int sum = 4;  // rounds
          for (int k = 0; k < 8; ++k) sum += at(2 * x + (k & 1), 2 * y + ((k >> 1) & 1), 2 * z + (k >> 2), c);
          half.voxels.push_back(static_cast<std::uint8_t>(sum / 8));
        }
  return half;
}

}  // namespace vibe::graphics
