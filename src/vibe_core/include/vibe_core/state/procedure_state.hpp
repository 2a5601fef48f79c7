#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/suture/suture.hpp"

namespace vibe {

/// What the trainee is about. Follows from what is done; no phase forbids another's commands for good.
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
  bool overdue = false;  ///< brisk, and the suture was not completed in time: reported
};

/// Where the procedure stands: everything of the state that is not tissue or tool.
struct ProcedureState {
  Phase phase = Phase::Inspect;
  std::array<std::uint8_t, kButtonCount> pressed{};  ///< buttons of the last step, for edges

  // marking; per particle (particle count) in a scene with marking, else empty
  std::vector<float> heat;          ///< see thermal_dose.hpp
  std::vector<float> dose;          ///< see thermal_dose.hpp
  std::vector<std::uint8_t> grade;  ///< BurnGrade reached
  double beam_energy = 0;           ///< given to the tissue so far [J]
  /// The wall before the pedal went down, while it gives way in the gradient domain; as the solver takes it over, the
  /// wall before the last step; else empty. (particle count) [m]
  std::vector<double> base_x, base_y, base_z;

  // helix
  double grip_rotation = 0;  ///< helix_rotation when it took hold [rad]
  double grip_turns = 0;     ///< most turns into the tissue since then [1]

  // needle
  bool arm_closed = false;    ///< the needle arm has come to its closed end and not yet back to its open one
  bool needle_on_arm = true;  ///< else in the anchor exchange (or, after the T-tag was dropped, gone with it)
  bool needle_loaded = true;  ///< there is a needle with a thread: false between T-tag and cinch
  /// The arm went through tissue as it closed and has not opened since. While the needle is on it, `pending` becomes a
  /// bite when the exchange takes the needle; once it is taken, the arm must open before the needle can come back.
  bool pierced = false;
  Bite pending;

  std::vector<Suture> sutures;  ///< in the order of their first bites; the last may be open
  double thread_used = 0;       ///< of the present thread [m]
  std::vector<Bleeding> bleedings;
  double blood_lost = 0;  ///< [m^3]
};

}  // namespace vibe
