#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <tf2_ros/static_transform_broadcaster.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StepTiming.h>

#include "conversions/tissue_message.hpp"
#include "input/input_sample.hpp"
#include "publishing/message_sink.hpp"
#include "publishing/warning_gate.hpp"
#include "simulation/timed_simulation.hpp"

namespace vibe::sim {

/// What a robot of the CRTK convention says of itself, for the scope and the suturing device, and what a controller of
/// the tip needs. Belongs to the stepping thread.
class ArmPublishers {
 public:
  explicit ArmPublishers(SinkSource& sinks);

  /// The present place of a tool, of a scene with one.
  /// @param continues  the state follows by one step from that of the last call; false: velocities are 0
  void place(const TimedSimulation& simulation, bool continues, std::int64_t stamp);
  /// The operating states, where they have changed.
  void operatingState(const TimedSimulation& simulation, const RunStatus& status);

 private:
  MessageSink scope_, suturing_device_, wall_, scope_state_, suturing_device_state_;
  JointArray last_joints_{};
  std::string last_state_;  // of both, to see a change
  std::int64_t last_state_stamp_ = 0;
};

/// Publishes on one topic what a step has changed.
using StepTopic = std::function<void(const TimedSimulation&)>;

/// Every topic that the simulator sends. Only warn() and complain() may be called from any thread; the rest belongs to
/// the stepping thread.
class Publishers {
 public:
  /// @param sinks     a node handle, or the bag that takes the place of the graph
  /// @param with_clock  also publish /clock
  Publishers(SinkSource sinks, bool with_clock);

  /// A model begins to be simulated: scene, topology, static transforms.
  void announceModel(const TimedSimulation& simulation);
  /// A run begins: with the first step, after a reset, or with another state or model.
  void announceRun(const TimedSimulation& simulation);

  /// What the step about to be taken uses, with the hash of the state, and a snapshot where one is due; call before the
  /// step.
  void appliedInput(const TimedSimulation& simulation);
  /// What one step has changed, the clock last: who sees the clock at t can have everything up to t.
  void stepResult(const TimedSimulation& simulation, const RunStatus& status);
  /// What of the present state has not been sent yet, decimation aside: after a start, reset or load, and at the end.
  void wholeState(const TimedSimulation& simulation, const RunStatus& status);
  /// While time stands still, for nodes that have just started: the time again, and the particles if nobody listened to
  /// them when they were due.
  void heartbeat(const TimedSimulation& simulation);
  /// procedure/state and procedure/skill_metrics, and the operating states.
  void procedureState(const TimedSimulation& simulation, const RunStatus& status);

  bool hasTimingListener() const { return step_timing_.getNumSubscribers() > 0; }
  void stepTiming(const vibe_msgs::StepTiming& message) { step_timing_.publish(message); }

  void solverStatistics(const vibe_msgs::SolverStatistics& message) { solver_statistics_.publish(message); }

  /// A warning event at the present simulated time.
  void warn(const std::string& text);
  /// The same and a line in the log, unless one of its kind was a moment ago: for what somebody may send often.
  void complain(const std::string& sentence);
  /// Number of warnings since the last call.
  int takeWarnings() { return warnings_.exchange(0); }

  /// Whether any topic has a subscriber.
  bool hasListener() const { return sinks_.anyIsHeard(); }
  /// How much a recording keeps of the topics that it does not keep whole.
  const std::vector<RecordingRule>& recordingRules() const { return sinks_.recordingRules(); }
  bool hasRecorder() const { return applied_input_.getNumSubscribers() > 0; }

 private:
  SinkSource sinks_;
  MessageSink scope_pose_, scope_twist_, hand_pose_, helix_pose_, topology_, particles_, procedure_, skill_metrics_,
      events_, sutures_, applied_input_, solver_statistics_, scene_, haptic_, pull_, step_result_, session_info_,
      snapshot_, step_timing_, clock_;
  std::vector<StepTopic> tool_;  // one by one, of a scene with a tool
  StepTopic organ_motion_;       // of a scene that breathes
  ArmPublishers arms_;
  std::atomic<int> warnings_{0};
  std::mutex gate_mutex_;
  WarningGate gate_;
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> static_transforms_;  // null for a bag
  MessageSink fixed_frames_;                                                // in its place, in a bag
  std::unique_ptr<ParticleCloud> cloud_;
  std::vector<Eigen::Isometry3d> link_poses_;
  Eigen::Isometry3d last_tip_ = Eigen::Isometry3d::Identity();
  std::string last_kind_;            // of procedure/state: what must not change unnoticed
  std::int64_t last_procedure_ = 0;  // stamps [ns]
  std::uint64_t last_suture_kind_ = 0;
  std::int64_t last_sutures_ = 0;
  std::int64_t last_tool_ = -1;
  std::int64_t last_particles_ = -1;
  std::int64_t last_snapshot_ = -1;
  std::atomic<bool> snapshot_asked_{true};  // by a new run or a new listener
  bool particles_missed_ = false;           // due, but not sent, because nobody listened
  bool haptic_touching_ = false;            // as last sent
  bool pull_held_ = false;                  // as last sent
  std::atomic<std::int64_t> now_{0};        // of the last state

  void tool(const TimedSimulation& simulation, bool continues, std::int64_t stamp);
  void particles(const TimedSimulation& simulation, std::int64_t stamp);
  bool suturesAreDue(const TimedSimulation& simulation) const;
  void sutures(const TimedSimulation& simulation);
  void haptic(const TimedSimulation& simulation, std::int64_t stamp);
  void hapticRelease(std::int64_t stamp);
  void pull(const TimedSimulation& simulation, std::int64_t stamp);
  void snapshot(const TimedSimulation& simulation);
  void clock(std::int64_t stamp);
};

}  // namespace vibe::sim
