#pragma once
#include <cstdint>

namespace vibe::vision {

/// Makes one sequence without wraps or restarts from the frame numbers of a camera. GigE Vision 1.x counts from 1 to
/// 65535 and then from 1 again; 2.x and USB3 Vision have 64 bits.
class SequenceCounter {
 public:
  struct Step {
    std::uint64_t sequence = 0;
    std::uint64_t skipped = 0;  ///< frames between the last one and this one
  };
  /// @param id  of a complete frame
  Step advance(std::uint64_t id);
  /// The camera counts anew, e.g. after a reconnection: the next frame follows the last one without a gap.
  void restart() { is_known_ = false; }

 private:
  std::uint64_t last_id_ = 0, sequence_ = 0;
  bool is_known_ = false, has_begun_ = false;

  std::uint64_t distance(std::uint64_t id) const;
};

}  // namespace vibe::vision
