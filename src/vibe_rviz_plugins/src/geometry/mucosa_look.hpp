#pragma once
#include <Eigen/Core>

namespace vibe::rviz_plugins {

/// What differs between the mucosa of two stomachs of the same shape, under the light of an endoscope. The defaults are
/// the look of the live view.
struct MucosaLook {
  Eigen::Vector3f shift{0, 0, 0};  ///< of all patterns in the organ at rest; folds meander and fork elsewhere [m]
  double areae_size = 2.5e-3;      ///< of an area gastrica [m]
  double paleness = 1;             ///< factor of green and blue of the gastric mucosa: less is redder
  double yellowness = 1;           ///< factor of green against blue
  double vessels = 1;              ///< factor of the strength of the net of vessels, 0 to 3
  double wetness = 1;              ///< factor of the strength of highlights
  double mucus = 0;  ///< added to the noise that lays a film of mucus where it is above 0.58 to 0.72: more of it

  /// Whether it is the default, for which shaders may use constants.
  bool isUsual() const {
    const MucosaLook usual;
    return shift == usual.shift && areae_size == usual.areae_size && paleness == usual.paleness &&
           yellowness == usual.yellowness && vessels == usual.vessels && wetness == usual.wetness &&
           mucus == usual.mucus;
  }
};

}  // namespace vibe::rviz_plugins
