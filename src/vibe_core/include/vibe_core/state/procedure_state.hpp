#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/suture/tissue_group.hpp"

namespace vibe {

/// A point where the needle passed through the wall. The thread acts on the weighted mean of the surrounding particles.
struct Bite {
  std::vector<int> particle;     ///< numbers of these particles
  std::vector<double> weight;    ///< per particle, sum 1
  double time = 0;               ///< time of the bite [s]
  double depth = 0;              ///< greatest depth below the mucosa [m]
  double thickness = 0;          ///< of the wall at the bite, at rest [m]
  Region region = Region::Body;  ///< of the particle with the largest weight
  Wall wall = Wall::Anterior;    ///< of the particle with the largest weight
  double along = 0;              ///< position along the organ's axis at rest, 0: apex of the fundus, 1: pylorus

  bool fullThickness() const { return depth >= thickness; }  ///< the needle went through the whole wall
};

/// One thread and its bites. The T-tag fixes the thread at the last bite, the cinch at the first.
struct Suture {
  /// In this order. Broken: the thread broke or tore out of all bites but one, and no longer pulls.
  enum class Stage : std::uint8_t { Open = 0, Tagged = 1, Cinching = 2, Cinched = 3, Broken = 4 };
  Stage stage = Stage::Open;  ///< how far the set is; Open: bites are being taken
  std::vector<Bite> bites;    ///< that hold, in the order in which they were taken

  // per segment between consecutive bites (bites - 1)
  std::vector<double> length;   ///< thread length between the bites, unstretched [m]
  std::vector<double> tension;  ///< in the last step; 0: slack [N]

  std::vector<Eigen::Vector3d> taken;  ///< the bites of which the technique was recognised, on the wall at rest [m]
  std::uint8_t technique = 0;          ///< Technique, recognised when the T-tag was dropped
  double technique_margin = 0;         ///< see recogniseTechnique(), a ratio
  std::array<int, 2> transitions{{-1, -1}};  ///< see TechniqueResult
  std::uint8_t corrected_technique = 0;      ///< Technique by TechniqueRule::Corrected, whichever rule the scene uses
  std::uint8_t printed_technique = 0;        ///< by TechniqueRule::Printed
  double pulled = 0;                         ///< thread drawn out by the cinch [m]
  double cinch_tension = 0;                  ///< tension of the first segment when the cinch was released [N]
  double begin = 0, end = 0;                 ///< times of the first bite and of the cinch; end 0: not cinched yet [s]
  int tear_outs = 0;                         ///< number of bites torn out
  TissueGroup group;  ///< particles drawn by the set if suture.cinch_model is `groups`; else empty

  /// Whether the thread, or its tissue group, pulls on the tissue.
  bool pulls() const { return (stage == Stage::Cinching || stage == Stage::Cinched) && bites.size() > 1; }
  /// The set is cinched or broken: no command changes it any more.
  bool permanent() const { return stage == Stage::Cinched || stage == Stage::Broken; }
};

const char* toString(Suture::Stage stage);

/// Where a bite is on the wall at rest [m].
/// @param vertices  of the organ at rest
Eigen::Vector3d restPosition(const Bite& bite, const std::vector<Eigen::Vector3d>& vertices);

/// Current position of a bite [m]. x, y, z: particle positions.
Eigen::Vector3d bitePosition(const Bite& bite, const std::vector<double>& x, const std::vector<double>& y,
                             const std::vector<double>& z);

/// Phase of the procedure. It follows from what the trainee does; every command is possible in every phase.
enum class Phase : std::uint8_t { Inspect = 0, Mark = 1, Suture = 2, Pull = 3, Done = 4 };
const char* toString(Phase phase);

/// A bite that bleeds.
struct Bleeding {
  int suture = -1, bite = -1;  ///< where; bite -1: it tore out
  int particle = -1;           ///< nearest to the bite
  bool brisk = false;          ///< else mild
  double begin = 0;            ///< [s]
  double rate = 0;             ///< [m^3/s]; 0: it has stopped
  double amount = 0;           ///< lost so far [m^3]
  bool overdue = false;        ///< brisk, and reported because the suture was not completed in time
};

/// State of the procedure: everything that is not tissue, tool or solver.
struct ProcedureState {
  Phase phase = Phase::Inspect;                      ///< at the end of the last step
  std::array<std::uint8_t, kButtonCount> pressed{};  ///< buttons of the last step, for edges

  // marking; per particle (particle count) in a scene with marking, else empty
  std::vector<float> heat;          ///< energy that the tissue has kept, see thermal_dose.hpp [J]
  std::vector<float> dose;          ///< largest heat so far, see thermal_dose.hpp [J]
  std::vector<std::uint8_t> grade;  ///< BurnGrade reached
  double beam_energy = 0;           ///< delivered to the tissue so far [J]
  /// While the argon beam deforms the wall in the gradient domain, the wall before the pedal was pressed; while the
  /// solver takes it over, the wall before the last step; else empty. (particle count) [m]
  std::vector<double> base_x, base_y, base_z;

  // helix
  double grip_rotation = 0;  ///< helix_rotation when the grip began [rad]
  double grip_turns = 0;     ///< maximum of turns into the tissue since then

  // needle
  bool arm_closed = false;    ///< the needle arm has reached its closed end and has not been fully open since
  bool needle_on_arm = true;  ///< else in the anchor exchange or, after the T-tag was dropped, gone with it
  bool needle_loaded = true;  ///< there is a needle with a thread: false between T-tag and cinch
  /// The arm went through tissue when it closed and has not opened since. While the needle is on the arm, `pending`
  /// becomes a bite when the exchange takes the needle. Then the arm must open before it can take the needle back.
  bool pierced = false;
  Bite pending;  ///< what the needle is in, see `pierced`; without particles: nothing

  std::vector<Suture> sutures;      ///< in the order of their first bites; the last may be open
  double thread_used = 0;           ///< of the current thread [m]
  std::vector<Bleeding> bleedings;  ///< in the order in which they began, those that have stopped included
  double blood_lost = 0;            ///< [m^3]
};

}  // namespace vibe
