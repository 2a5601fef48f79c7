#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/geometry/anatomy.hpp"
#include "vibe_core/suture/tissue_group.hpp"

namespace vibe {

/// Where the needle went through the wall: the thread pulls on the particles around it as a weighted mean.
struct Bite {
  std::vector<int> particle;
  std::vector<double> weight;  ///< per particle, sum 1
  double time = 0;             ///< when it was taken [s]
  double depth = 0;            ///< below the mucosa, at its deepest [m]
  double thickness = 0;        ///< of the wall there, at rest [m]
  Region region = Region::Body;
  Wall wall = Wall::Anterior;
  double along = 0;  ///< place along the organ's axis at rest, 0: apex of the fundus, 1: pylorus

  bool fullThickness() const { return depth >= thickness; }
};

/// One thread and its bites. The T-tag holds the thread's end at the last bite, the cinch at the first.
struct Suture {
  /// In this order. Broken: the thread broke or was torn out of all bites but one, it does not pull any more.
  enum class Stage : std::uint8_t { Open = 0, Tagged = 1, Cinching = 2, Cinched = 3, Broken = 4 };
  Stage stage = Stage::Open;
  std::vector<Bite> bites;

  // per segment between consecutive bites, (bites - 1)
  std::vector<double> length;   ///< of thread between the bites, without stretch [m]
  std::vector<double> tension;  ///< in the last step; 0: slack [N]

  std::vector<Eigen::Vector3d> taken;  ///< where the bites were when the T-tag was dropped, in world [m]
  std::uint8_t technique = 0;          ///< Technique, recognised when the T-tag was dropped
  double technique_margin = 0;         ///< see recogniseTechnique()
  std::array<int, 2> transitions{{-1, -1}};
  double pulled = 0;          ///< thread drawn out by the cinch [m]
  double cinch_tension = 0;   ///< in the first segment when the cinch was released [N]
  double begin = 0, end = 0;  ///< time of the first bite and of the cinch; end 0: not yet [s]
  int tear_outs = 0;          ///< bites that tore out
  TissueGroup group;          ///< what a set draws where suture.cinch_model is `groups`; else empty

  /// The thread pulls on the tissue, or the group does.
  bool pulls() const { return (stage == Stage::Cinching || stage == Stage::Cinched) && bites.size() > 1; }
  bool permanent() const { return stage == Stage::Cinched || stage == Stage::Broken; }
};

const char* toString(Suture::Stage stage);

/// Where a bite is now [m]. x, y, z: of the particles.
Eigen::Vector3d bitePosition(const Bite& bite, const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& z);

}  // namespace vibe
