#include "publishing/publishers.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

#include <ros/console.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/SkillMetrics.h>
#include <vibe_msgs/StepResult.h>

#include "conversions/conversions.hpp"
#include "conversions/input_message.hpp"
#include "conversions/procedure_message.hpp"
#include "conversions/session_message.hpp"
#include "conversions/suture_message.hpp"
#include "conversions/tissue_message.hpp"
#include "conversions/tool_message.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/procedure/helix_grip.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe::sim {
namespace {

constexpr double kHapticRate = 100;                       // of haptic/parameters at most, in simulated time [Hz]
constexpr std::int64_t kSnapshotPeriod = 10'000'000'000;  // of simulated time [ns]
constexpr std::int64_t kProcedurePeriod = 1'000'000'000;  // of procedure and sutures when nothing happens [ns]

constexpr std::int64_t kSameTime = 1000;  // stamps that count as equal [ns]

constexpr std::uint32_t kCloudQueue = 600;  // of large clouds, as many as fit into some 60 MB

int hapticInterval(double step_period) {
  return static_cast<int>(std::ceil(1 / (kHapticRate * step_period) - 1e-6));
}

// A topic whose message is formed of the simulation after every step, if somebody listens.
template <class Make>
StepTopic stepTopic(SinkSource& sinks, const char* topic, Kept kept, Make make) {
  using Message = std::invoke_result_t<Make, const TimedSimulation&>;
  const MessageSink sink = sinks.advertise<Message>(topic, kSmallQueue, kept);
  return [sink, make](const TimedSimulation& simulation) {
    if (sink.getNumSubscribers() > 0) sink.publish(make(simulation));
  };
}

using Now = const TimedSimulation&;

// What the tool is and feels. Another topic of this kind is a row here, and nothing else in this file.
std::vector<StepTopic> toolTopics(SinkSource& sinks) {
  return {
      stepTopic(sinks, "scope/measured_cf", thinnedTo(0.1), [](Now s) { return makeWrench(s.state(), s.now()); }),
      stepTopic(sinks, "scope/contacts", kLeftToReplay, makeToolContacts),
      stepTopic(sinks, "scope/jacobian", kLeftToReplay,
                [](Now s) { return makeJacobian(tipJacobian(s.model(), s.state())); }),
      stepTopic(sinks, "scope/setpoint_js", kLeftToReplay, [](Now s) { return makeHandJoints(s.state(), s.now()); }),
      stepTopic(sinks, "joint_states", thinnedTo(0.1),
                [](Now s) { return makeJointState(s.model(), s.state(), s.now()); }),
  };
}

}  // namespace

ArmPublishers::ArmPublishers(SinkSource& sinks)
    : scope_(sinks.advertise<sensor_msgs::JointState>("scope/measured_js", kSmallQueue, kLeftToReplay)),
      suturing_device_(
          sinks.advertise<sensor_msgs::JointState>("suturing_device/measured_js", kSmallQueue, kLeftToReplay)),
      wall_(sinks.advertise<geometry_msgs::PoseStamped>("wall/measured_cp", kSmallQueue, kLeftToReplay)),
      scope_state_(sinks.advertise<vibe_msgs::OperatingState>("scope/operating_state", kSmallQueue, kKeptWhole, true)),
      suturing_device_state_(sinks.advertise<vibe_msgs::OperatingState>("suturing_device/operating_state", kSmallQueue,
                                                                        kKeptWhole, true)) {}

void ArmPublishers::place(const TimedSimulation& simulation, bool continues, std::int64_t stamp) {
  const JointArray joints = toolJoints(simulation.state());
  JointArray velocity{};
  for (int j = 0; continues && j < kJointCount; ++j)
    velocity[j] = (joints[j] - last_joints_[j]) / simulation.time().period();
  last_joints_ = joints;
  scope_.publish(makeMeasuredScope(simulation.state(), velocity, stamp));
  suturing_device_.publish(makeMeasuredSuturingDevice(simulation.state(), velocity, stamp));
  if (wall_.getNumSubscribers() == 0) return;
  if (const auto sight = lookAhead(simulation.model(), simulation.state())) wall_.publish(makeWallPose(*sight, stamp));
}

void ArmPublishers::operatingState(const TimedSimulation& simulation, const RunStatus& status) {
  const bool present = simulation.model().tool != nullptr;
  // CRTK clients take a state only if its stamp is later than the last one, also of a simulation that stands still
  const std::int64_t since = simulation.now() - last_state_stamp_;
  const std::int64_t stamp = since <= 0 && since > -kSameTime ? last_state_stamp_ + 1 : simulation.now();
  const auto scope = makeOperatingState(present, status.paused, status.scope_moves, stamp);
  const auto suturing_device = makeOperatingState(present, status.paused, status.suturing_device_moves, stamp);
  const std::string state =
      scope.state + (scope.is_busy ? " scope" : "") + (suturing_device.is_busy ? " suturing_device" : "");
  if (state == last_state_) return;
  last_state_ = state;
  last_state_stamp_ = stamp;
  scope_state_.publish(scope);
  suturing_device_state_.publish(suturing_device);
}

Publishers::Publishers(SinkSource sinks, bool with_clock)
    : sinks_(std::move(sinks)),
      scope_pose_(sinks_.advertise<geometry_msgs::PoseStamped>("scope/measured_cp", kSmallQueue, thinnedTo(0.1))),
      scope_twist_(sinks_.advertise<geometry_msgs::TwistStamped>("scope/measured_cv", kSmallQueue, kLeftToReplay)),
      hand_pose_(sinks_.advertise<geometry_msgs::PoseStamped>("scope/setpoint_cp", kSmallQueue, kLeftToReplay)),
      helix_pose_(sinks_.advertise<geometry_msgs::PoseStamped>("suturing_device/helix/measured_cp", kSmallQueue,
                                                               kLeftToReplay)),
      topology_(sinks_.advertise<vibe_msgs::TissueTopology>("tissue/topology", 1, kKeptWhole, true)),
      particles_(sinks_.advertise<sensor_msgs::PointCloud2>("tissue/particles", kCloudQueue, thinnedTo(2), true)),
      procedure_(sinks_.advertise<vibe_msgs::ProcedureState>("procedure/state", kSmallQueue, kKeptWhole, true)),
      skill_metrics_(
          sinks_.advertise<vibe_msgs::SkillMetrics>("procedure/skill_metrics", kSmallQueue, kKeptWhole, true)),
      events_(sinks_.advertise<vibe_msgs::ProcedureEvent>("procedure/events", kSmallQueue)),
      sutures_(sinks_.advertise<vibe_msgs::SutureArray>("sutures", kCloudQueue, thinnedTo(2), true)),
      applied_input_(sinks_.advertise<vibe_msgs::StepInput>("applied_input", kSmallQueue, kKeptWhole, false,
                                                            [this] { snapshot_asked_ = true; })),
      solver_statistics_(sinks_.advertise<vibe_msgs::SolverStatistics>("solver_statistics", kSmallQueue)),
      scene_(sinks_.advertise<std_msgs::String>("scene", 1, kKeptWhole, true)),
      haptic_(sinks_.advertise<vibe_msgs::HapticParameters>("haptic/parameters", kSmallQueue, kLeftToReplay)),
      pull_(sinks_.advertise<vibe_msgs::TissuePullState>("tissue/pull_state", kSmallQueue, thinnedTo(0.1))),
      step_result_(sinks_.advertise<vibe_msgs::StepResult>("step_result", kSmallQueue, kLeftToReplay, true)),
      session_info_(sinks_.advertise<vibe_msgs::SessionInfo>("session_info", kSmallQueue, kKeptWhole, true)),
      snapshot_(sinks_.advertise<vibe_msgs::StateSnapshot>("snapshot", kCloudQueue, kKeptWhole, false,
                                                           [this] { snapshot_asked_ = true; })),
      step_timing_(sinks_.advertise<vibe_msgs::StepTiming>("step_timing", kSmallQueue, kLeftToReplay)),
      tool_(toolTopics(sinks_)),
      organ_motion_(stepTopic(sinks_, "organ/motion", thinnedTo(0.1),
                              [](Now s) { return makeOrganMotion(s.model(), s.state(), s.now()); })),
      arms_(sinks_) {
  if (sinks_.isGraph())
    static_transforms_ = std::make_unique<tf2_ros::StaticTransformBroadcaster>();
  else
    fixed_frames_ = sinks_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, kKeptWhole, true);
  if (with_clock) clock_ = sinks_.advertise<rosgraph_msgs::Clock>("/clock", kSmallQueue, thinnedTo(0.1));
}

void Publishers::announceModel(const TimedSimulation& simulation) {
  announceRun(simulation);  // first: what is latched below then belongs to this session in a recording
  const Model& model = simulation.model();
  cloud_ = std::make_unique<ParticleCloud>(model, simulation.state(), simulation.revision());
  scene_.publish(makeSceneText(model.scene, simulation.seed()));
  topology_.publish(makeTopology(model, simulation.revision(), simulation.now()));
  std::vector<geometry_msgs::TransformStamped> transforms = {
      makeTransform(Eigen::Isometry3d::Identity(), kWorldFrame, kTissueFrame, simulation.now())};
  if (model.tool) transforms.push_back(makeTransform(model.tool_base, kWorldFrame, kScopeBaseFrame, simulation.now()));
  if (static_transforms_) return static_transforms_->sendTransform(transforms);
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  fixed_frames_.publish(message);
}

void Publishers::announceRun(const TimedSimulation& simulation) {
  session_info_.publish(makeSessionInfo(simulation));
  snapshot_asked_ = true;
}

void Publishers::appliedInput(const TimedSimulation& simulation) {
  snapshot(simulation);
  vibe_msgs::StepInput message = makeStepInput(simulation.input(), simulation.state().step, simulation.now());
  message.run = simulation.run();
  message.session = simulation.session();
  if (hasRecorder()) {
    message.input_hash = hash(simulation.input(), simulation.state().step);
    message.state_hash = hash(simulation.state());
  }
  applied_input_.publish(message);
}

void Publishers::snapshot(const TimedSimulation& simulation) {
  if (snapshot_.getNumSubscribers() == 0) return;
  const bool asked = snapshot_asked_.exchange(false);
  if (!asked && simulation.now() - last_snapshot_ < kSnapshotPeriod) return;
  last_snapshot_ = simulation.now();
  snapshot_.publish(makeStateSnapshot(simulation));
}

void Publishers::stepResult(const TimedSimulation& simulation, const RunStatus& status) {
  const std::int64_t stamp = simulation.now();
  now_ = stamp;
  tool(simulation, true, stamp);
  haptic(simulation, stamp);
  pull(simulation, stamp);
  if (breathingOf(simulation.model().scene)) organ_motion_(simulation);
  if (simulation.state().step % imageInterval(simulation.time().period()) == 0) particles(simulation, stamp);
  if (suturesAreDue(simulation)) sutures(simulation);
  arms_.operatingState(simulation, status);
  for (const Event& event : simulation.events()) events_.publish(makeEvent(event, stamp));
  if (kindOf(simulation, status) != last_kind_ || stamp - last_procedure_ >= kProcedurePeriod) {
    procedureState(simulation, status);
  }
  step_result_.publish(makeStepResult(simulation, false));
  clock(stamp);
}

void Publishers::wholeState(const TimedSimulation& simulation, const RunStatus& status) {
  const std::int64_t stamp = simulation.now();
  now_ = stamp;
  if (stamp != last_particles_) particles(simulation, stamp);
  sutures(simulation);
  procedureState(simulation, status);
  if (stamp == last_tool_) return;
  if (haptic_touching_) hapticRelease(stamp);
  pull(simulation, stamp);
  tool(simulation, false, stamp);
  step_result_.publish(makeStepResult(simulation, true));
  clock(stamp);
}

void Publishers::heartbeat(const TimedSimulation& simulation) {
  if (particles_missed_) particles(simulation, simulation.now());
  clock(simulation.now());
}

void Publishers::procedureState(const TimedSimulation& simulation, const RunStatus& status) {
  last_kind_ = kindOf(simulation, status);
  last_procedure_ = simulation.now();
  procedure_.publish(makeProcedureState(simulation, status));
  skill_metrics_.publish(makeSkillMetrics(simulation));
  arms_.operatingState(simulation, status);
}

bool Publishers::suturesAreDue(const TimedSimulation& simulation) const {
  const ProcedureState& procedure = simulation.state().procedure;
  if (kindOf(procedure) != last_suture_kind_) return true;
  if (procedure.sutures.empty()) return false;
  const bool in_turn = simulation.state().step % imageInterval(simulation.time().period()) == 0;
  return (in_turn && sutures_.getNumSubscribers() > 0) || simulation.now() - last_sutures_ >= kProcedurePeriod;
}

void Publishers::sutures(const TimedSimulation& simulation) {
  last_suture_kind_ = kindOf(simulation.state().procedure);
  last_sutures_ = simulation.now();
  sutures_.publish(makeSutures(simulation.model(), simulation.state(), simulation.now()));
}

void Publishers::warn(const std::string& text) {
  ++warnings_;
  events_.publish(makeWarning(text, now_));
}

void Publishers::complain(const std::string& sentence) {
  {
    const std::lock_guard<std::mutex> lock(gate_mutex_);
    if (!gate_.admits(sentence, steadyTime())) return;
  }
  ROS_WARN_STREAM(sentence);
  warn(sentence);
}

void Publishers::tool(const TimedSimulation& simulation, bool continues, std::int64_t stamp) {
  last_tool_ = stamp;
  const Model& model = simulation.model();
  if (!model.tool) return;
  model.tool->forwardKinematics(simulation.state().joints, simulation.state().tool_displacement, link_poses_);
  const Eigen::Isometry3d tip = model.tool_base * link_poses_[model.tip_link];
  scope_pose_.publish(makePose(tip, kWorldFrame, stamp));
  scope_twist_.publish(makeTipTwist(continues ? last_tip_ : tip, tip, simulation.time().period(), stamp));
  last_tip_ = tip;
  helix_pose_.publish(makePose(model.tool_base * link_poses_[model.helix_link], kWorldFrame, stamp));
  if (hand_pose_.getNumSubscribers() > 0) {
    model.tool->forwardKinematics(simulation.state().joints, link_poses_);
    hand_pose_.publish(makePose(model.tool_base * link_poses_[model.tip_link], kWorldFrame, stamp));
  }
  for (const StepTopic& publish : tool_) publish(simulation);
  arms_.place(simulation, continues, stamp);
}

void Publishers::haptic(const TimedSimulation& simulation, std::int64_t stamp) {
  const std::optional<ToolImpedance>& response = simulation.simulation().toolImpedance();
  if (!response) {
    if (haptic_touching_) hapticRelease(stamp);
    return;
  }
  if (haptic_touching_ && simulation.state().step % hapticInterval(simulation.time().period()) != 0) return;
  haptic_touching_ = true;
  const bool holds = simulation.model().scene.helix && !simulation.state().grip.empty();
  const double limit = holds ? holdingForce(*simulation.model().scene.helix, simulation.state().procedure.grip_turns)
                             : std::numeric_limits<double>::infinity();
  haptic_.publish(makeHapticParameters(*response, limit, stamp));
}

void Publishers::hapticRelease(std::int64_t stamp) {
  haptic_touching_ = false;
  haptic_.publish(makeHapticRelease(stamp));
}

// The state after a reset or load has its own hand, and a listener must not go on drawing the former one.
void Publishers::pull(const TimedSimulation& simulation, std::int64_t stamp) {
  const bool holds = simulation.state().pull.holds();
  if (!holds && !pull_held_) return;
  pull_held_ = holds;
  pull_.publish(makePullState(simulation.state(), stamp));
}

void Publishers::particles(const TimedSimulation& simulation, std::int64_t stamp) {
  last_particles_ = stamp;
  particles_missed_ = particles_.getNumSubscribers() == 0;
  if (particles_missed_) return;
  particles_.publish(cloud_->update(simulation.model(), simulation.state(), stamp, simulation.simulation().coverage()));
}

void Publishers::clock(std::int64_t stamp) {
  rosgraph_msgs::Clock message;
  message.clock = toRosTime(stamp);
  clock_.publish(message);
}

}  // namespace vibe::sim
