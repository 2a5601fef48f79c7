#pragma once
#include <limits>
#include <string>
#include <vector>

#include "vibe_hardware/driver/calibration.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware {

/// Where a joint can be [m], [rad].
struct JointRange {
  /// Ends of the range, both allowed.
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
};
using HandLimits = std::array<JointRange, kJointCount>;  ///< by vibe::Joint

/// The limits of the joints of a calibration; infinite for those it does not have.
HandLimits handLimits(const Calibration& calibration);

/// Plays a recorded motion from a CSV file. The first line names the columns, in any order: `time` [s] and the joints
/// `insertion` [m], `rotation`, `tip_up_down`, `tip_left_right` [rad]; then, as far as they are wanted,
/// `helix_advance` [m], `helix_rotation` [rad], `needle_driver` [m] and the buttons (`apc_pedal`, `helix_grab`,
/// `needle`, `t_tag`, `cinch`, `insufflate`), 0 or 1. Empty lines and lines that begin with # do not count. Times
/// ascend. A hand may push beyond the limits of a joint, but by no more than their distance: positions in millimetres
/// or degrees are further off, and refused. Positions are interpolated; a button has the value of the last row. Before
/// the first row and after the last one nothing changes.
class RecordedHand : public Hand {
 public:
  static constexpr std::size_t kMaxRows = 10'000'000;  ///< of a recording; a longer one is refused

  /// @throws Error "file:line: what is wrong; remedy"
  static RecordedHand load(const std::string& file, const HandLimits& limits);
  /// @param place  of the text, for errors
  static RecordedHand parse(const std::string& text, const std::string& place, const HandLimits& limits = {});

  HandSample at(double time) const override;
  double duration() const override { return rows_.back().time; }

 private:
  friend class RecordingReader;
  struct Row {
    double time = 0;
    HandSample sample;
  };
  std::vector<Row> rows_;  // at least one
};

}  // namespace vibe::hardware
