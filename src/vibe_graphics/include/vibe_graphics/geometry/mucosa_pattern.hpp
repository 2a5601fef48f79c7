#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace vibe::graphics {

/// What differs between the mucosa of two stomachs of the same shape, under the light of an endoscope. The defaults are
/// the look of the live view.
struct MucosaLook {
  Eigen::Vector3f shift{0, 0, 0};  ///< of all patterns in the organ at rest; folds meander and fork elsewhere [m]
  double areae_size = 2.5e-3;      ///< of an area gastrica [m]
  double paleness = 1;             ///< factor of green and blue of the gastric mucosa: less is redder
  double yellowness = 1;           ///< factor of green against blue
  double vessels = 1;              ///< factor of the strength of the net of vessels, 0 to 3
  double wetness = 1;              ///< factor of the strength of highlights
  double mucus = 0;  ///< added to the noise (ratio) that lays a film of mucus where it is above 0.58 to 0.72

  /// Whether it is the default, for which shaders may use constants.
  bool isUsual() const {
    const MucosaLook usual;
    return shift == usual.shift && areae_size == usual.areae_size && paleness == usual.paleness &&
           yellowness == usual.yellowness && vessels == usual.vessels && wetness == usual.wetness &&
           mucus == usual.mucus;
  }
};

/// A solid texture of four patterns that the shader of the mucosa cuts with the surface at rest. It repeats without a
/// seam in x, y and z; the shader reads it at several scales in turned frames, so that no period is seen.
struct MucosaPattern {
  int size = 0;  ///< voxels along each edge
  /// Four bytes per voxel, x fastest: height of polygonal areas between grooves (Worley 1996); smooth noise;
  /// a net of thin lines with branches; fine noise.
  std::vector<std::uint8_t> voxels;
};

constexpr int kPatternSize = 64;  ///< [voxels]
constexpr int kPatternCells = 8;  ///< polygonal areas along an edge of the pattern

/// The same for every process. Takes about 0.1 s.
MucosaPattern makeMucosaPattern();

/// Smooth noise at a place of the wall at rest [m], 0 to 1, with waves of 42, 21 and 11 mm: wide enough to be
/// interpolated between vertices.
float broadPattern(const Eigen::Vector3f& rest);

/// How far the phase of the rugae wanders at a place of the wall at rest, so that folds meander [rad]. It is smooth
/// over 15 mm and is computed at the vertices: from the bytes of the texture, the steps of their slopes would be seen.
float foldBend(const Eigen::Vector3f& rest);

/// The next coarser level: means of 2 x 2 x 2 voxels, which a surface far away shows instead of an alias.
MucosaPattern halved(const MucosaPattern& pattern);

}  // namespace vibe::graphics
