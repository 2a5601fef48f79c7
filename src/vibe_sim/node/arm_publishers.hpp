#pragma once
#include <cstdint>
#include <string>

#include "joint_move.hpp"
#include "outlet.hpp"
#include "run_status.hpp"
#include "session.hpp"

namespace vibe::sim {

/// What a robot of the CRTK convention says of itself, for the scope and the suturing device, and what a controller of
/// the tip needs. Belongs to the stepping thread.
class ArmPublishers {
 public:
  explicit ArmPublishers(OutletSource& outlets);

  /// The present place of a tool, of a scene with one.
  /// @param continues  the state follows by one step from that of the last call; false: velocities are 0
  void place(const Session& session, bool continues, std::int64_t stamp);
  /// The operating states, where they have changed.
  void operatingState(const Session& session, const RunStatus& status);
  bool hasListener() const;

 private:
  Outlet scope_, overstitch_, jacobian_, wall_, scope_state_, overstitch_state_;
  JointArray last_joints_{};
  std::string last_state_;  // of both, to see a change
};

}  // namespace vibe::sim
