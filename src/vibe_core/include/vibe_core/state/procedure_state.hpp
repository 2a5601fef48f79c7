#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/suture/suture.hpp"

namespace vibe {

/// Phase of the procedure. It follows from what the trainee does; every command is possible in every phase.
enum class Phase : std::uint8_t { Inspect = 0, Mark = 1, Suture = 2, Pull = 3, Done = 4 };
const char* toString(Phase phase);

/// A bite that bleeds.
struct Bleeding {
  int suture = -1, bite = -1;  ///< where; bite -1: it tore out
  int particle = -1;
  bool brisk = false;
  double begin = 0;      ///< [s]
  double rate = 0;       ///< [m^3/s]; 0: it has stopped
  double amount = 0;     ///< lost so far [m^3]
  bool overdue = false;  ///< brisk, and reported because the suture was not completed in time
};

/// State of the procedure: everything that is not tissue, tool or solver.
struct ProcedureState {
  Phase phase = Phase::Inspect;
  std::array<std::uint8_t, kButtonCount> pressed{};  ///< buttons of the last step, for edges

  // marking; per particle (particle count) in a scene with marking, else empty
  std::vector<float> heat;          ///< see thermal_dose.hpp
  std::vector<float> dose;          ///< see thermal_dose.hpp
  std::vector<std::uint8_t> grade;  ///< BurnGrade reached
  double beam_energy = 0;           ///< delivered to the tissue so far [J]
  /// While the argon beam deforms the wall in the gradient domain, the wall before the pedal was pressed; while the
  /// solver takes it over, the wall before the last step; else empty. (particle count) [m]
  std::vector<double> base_x, base_y, base_z;

  // helix
  double grip_rotation = 0;  ///< helix_rotation when the grip began [rad]
  double grip_turns = 0;     ///< maximum of turns into the tissue since then [1]

  // needle
  bool arm_closed = false;    ///< the needle arm has reached its closed end and has not been fully open since
  bool needle_on_arm = true;  ///< else in the anchor exchange or, after the T-tag was dropped, gone with it
  bool needle_loaded = true;  ///< there is a needle with a thread: false between T-tag and cinch
  /// The arm went through tissue when it closed and has not opened since. While the needle is on the arm, `pending`
  /// becomes a bite when the exchange takes the needle. Then the arm must open before it can take the needle back.
  bool pierced = false;
  Bite pending;

  std::vector<Suture> sutures;  ///< in the order of their first bites; the last may be open
  double thread_used = 0;       ///< of the current thread [m]
  std::vector<Bleeding> bleedings;
  double blood_lost = 0;  ///< [m^3]
};

}  // namespace vibe
