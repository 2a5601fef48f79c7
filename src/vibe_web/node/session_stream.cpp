#include "session_stream.hpp"

#include <algorithm>

#include <vibe_msgs/SolverStatistics.h>

#include "protocol/byte_writer.hpp"
#include "protocol/session_health.hpp"
#include "protocol/shape_message.hpp"
#include "protocol/suture_stream.hpp"
#include "protocol/topology_message.hpp"
#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "vibe_graphics/geometry/deformable_surface.hpp"
#include "vibe_graphics/geometry/mucosa_map.hpp"
#include "vibe_graphics/geometry/mucosa_pattern.hpp"
#include "vibe_graphics/geometry/suture_shapes.hpp"
#include "vibe_graphics/messages/suture_messages.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::web {

using nlohmann::json;

namespace {

constexpr std::uint32_t kQueue = 2;  // a state that is not the newest is of no use
constexpr std::uint32_t kEventQueue = 1000;
constexpr int kSlowTicks = 2;                     // of tick(): heat and thread five times a second
constexpr int kRobotTicks = 10;                   // until there is a robot description
constexpr int kFoldTicks = 4;                     // the stretch of the wall, on which folds depend, changes slowly
constexpr std::size_t kShapeBytesPerTick = 5000;  // of thread, and as much of blood: 50 kB/s each
const char* const kBase = "scope_base";

}  // namespace

struct SessionStream::Organ {
  graphics::TissueMesh mesh;
  graphics::MucosaMap map;
  WallLook look;
  graphics::DeformableSurface surface;  // on which blood lies
  graphics::BleedingShape bleeding;
  explicit Organ(graphics::TissueMesh read)
      : mesh(std::move(read)), map(graphics::mapMucosa(mesh)), look(mesh, map), surface(mesh) {
    bleeding.setMesh(&mesh);
  }
};

SessionStream::~SessionStream() = default;

SessionStream::SessionStream(const ros::NodeHandle& handle, WebServer& server)
    : handle_(handle), server_(server), scene_(constantText()) {
  findRobot();
  const graphics::MucosaPattern pattern = graphics::makeMucosaPattern();
  auto voxels = std::make_shared<const std::string>(pattern.voxels.begin(), pattern.voxels.end());
  server_.provide("/pattern", {"application/octet-stream", std::move(voxels), false});
  const auto add = [this](ros::Subscriber subscriber) { subscribers_.push_back(std::move(subscriber)); };
  add(handle_.subscribe("tissue/topology", kQueue, &SessionStream::takeTopology, this));
  particles_ = handle_.subscribe("tissue/particles", kQueue, &SessionStream::takeParticles, this,
                                 ros::TransportHints().tcpNoDelay());
  add(handle_.subscribe("joint_states", kQueue, &SessionStream::takeJoints, this, ros::TransportHints().tcpNoDelay()));
  add(handle_.subscribe("sutures", kQueue, &SessionStream::takeSutures, this));
  add(handle_.subscribe("/tf_static", kEventQueue, &SessionStream::takeTransforms, this));
  add(handle_.subscribe<geometry_msgs::WrenchStamped>("scope/measured_cf", kQueue, [this](const auto& message) {
    const auto &f = message->wrench.force, &t = message->wrench.torque;
    const std::array<double, 6> wrench{f.x, f.y, f.z, t.x, t.y, t.z};
    std::transform(wrench.begin(), wrench.end(), content_.wrench.begin(),
                   [](double v) { return static_cast<float>(v); });
  }));
  add(handle_.subscribe<vibe_msgs::ProcedureState>("procedure/state", kQueue, [this](const auto& m) { state_ = m; }));
  // once a second, also during a pause
  add(handle_.subscribe<vibe_msgs::SolverStatistics>("solver_statistics", kQueue, [this](const auto&) {
    if (state_ && state_->paused) heard_ = ros::SteadyTime::now();
  }));
  add(handle_.subscribe<vibe_msgs::SkillMetrics>("procedure/skill_metrics", kQueue,
                                                 [this](const auto& m) { skill_ = m; }));
  add(handle_.subscribe<vibe_msgs::ProcedureEvent>("procedure/events", kEventQueue, [this](const auto& message) {
    events_.add(*message);
    events_changed_ = true;
  }));
  replays_ = handle_.subscribe("replay/status", kQueue, &SessionStream::takeReplay, this);
}

/// The parameter may be set later than this node starts.
void SessionStream::findRobot() {
  try {
    std::string description;
    handle_.getParam("robot_description", description);
    const RobotText robot = readRobot(description);
    scene_["robot"] = robot.json;
    for (const auto& [path, file] : robot.meshes) server_.provide(path, {"text/plain", contentOf(file), false});
    for (const std::string& problem : robot.problems) ROS_WARN("%s", problem.c_str());
    publishScene();
  } catch (const std::exception& error) {
    warn(error.what());
  }
}

void SessionStream::publishScene() {
  if (organ_) server_.publish(Kind::Scene, textMessage(Kind::Scene, dumped(scene_)));
}

void SessionStream::takeTopology(const vibe_msgs::TissueTopology& message) {
  graphics::TissueMesh mesh;
  const std::string wrong = graphics::readTopology(message, mesh);
  if (!wrong.empty()) return warn(wrong);
  organ_ = std::make_unique<Organ>(std::move(mesh));
  has_frame_ = false;
  frame_ = {};
  scene_["name"] = organ_->mesh.name;
  scene_["revision"] = organ_->mesh.revision;
  publishScene();
  server_.publish(Kind::Topology, encodeTopology(organ_->mesh, organ_->map));
}

void SessionStream::takeReplay(const ros::MessageEvent<const vibe_msgs::ReplayStatus>& event) {
  replay_ = event.getMessage();
  player_ = event.getPublisherName();
  replay_heard_ = ros::SteadyTime::now();
  if (!replay_->playing) heard_ = replay_heard_;
  server_.publish(Kind::Replay, textMessage(Kind::Replay, replayText(*replay_)));
}

/// A recording is over when its player has ended, or says nothing while another node sends states: one that was killed
/// stays registered, and one that hangs or computes may speak again.
void SessionStream::watchRecording() {
  const bool silent = (ros::SteadyTime::now() - replay_heard_).toSec() > kStale;
  if (!replay_ || (replays_.getNumPublishers() > 0 && (!silent || source_ == player_))) return;
  replay_ = nullptr;
  events_ = {};  // they are those of the recording
  events_changed_ = true;
  server_.publish(Kind::Replay, textMessage(Kind::Replay, "null"));
}

void SessionStream::takeParticles(const ros::MessageEvent<const sensor_msgs::PointCloud2>& event) {
  unseen_ = event.getMessage();
  source_ = event.getPublisherName();
  heard_ = ros::SteadyTime::now();
  publishFrame();
}

/// The newest state, which waits until somebody looks: a simulator that pauses, or a recording at its end, sends no
/// other.
void SessionStream::publishFrame() {
  if (!unseen_ || !organ_ || server_.clients() == 0) return;
  const std::string wrong = graphics::readParticles(*unseen_, organ_->mesh, frame_);
  unseen_ = nullptr;
  if (!wrong.empty()) return warn(wrong);
  organ_->look.see(frame_);
  has_frame_ = true;
  content_.revision = frame_.revision;
  content_.time = frame_.time;
  content_.smoke = organ_->look.smoke();
  server_.publish(Kind::Frame, encodeFrame(content_, frame_.positions));
}

void SessionStream::takeJoints(const sensor_msgs::JointState& message) {
  content_.joints.assign(message.position.begin(), message.position.end());
  if (scene_.contains("joints") && scene_["joints"] == message.name) return;
  scene_["joints"] = message.name;
  publishScene();
}

void SessionStream::takeTransforms(const tf2_msgs::TFMessage& message) {
  for (const auto& each : message.transforms) {
    if (each.child_frame_id != kBase) continue;
    const auto& p = each.transform.translation;
    const auto& q = each.transform.rotation;
    scene_["base"] = {{"link", kBase}, {"place", {p.x, p.y, p.z}}, {"turn", {q.x, q.y, q.z, q.w}}};
    publishScene();
  }
}

void SessionStream::takeSutures(const vibe_msgs::SutureArray::ConstPtr& message) {
  sutures_ = message;
  sutures_changed_ = true;
}

void SessionStream::tick() {
  ++ticks_;
  if (ticks_ % kRobotTicks == 0 && !scene_.contains("robot")) findRobot();
  watchRecording();
  watchHealth();
  publishFrame();
  if (events_changed_) server_.publish(Kind::Events, textMessage(Kind::Events, events_.text()));
  events_changed_ = false;
  if (ticks_ % kSlowTicks != 0) return;
  if (sutures_changed_) publishSutures();
  publishWall();
  if (!state_) return;
  std::string text = stateText(*state_, skill_.get(), sutures_.get());
  if (text == state_text_) return;
  state_text_ = std::move(text);
  server_.publish(Kind::State, textMessage(Kind::State, state_text_));
}

void SessionStream::watchHealth() {
  SessionHealth health;
  health.published = particles_.getNumPublishers() > 0;
  if (!health.published || heard_.isZero()) heard_ = ros::SteadyTime::now();
  health.silence = (ros::SteadyTime::now() - heard_).toSec();
  health.paused = !replay_ && state_ && state_->paused;
  health.robot = scene_.contains("robot");
  health.base = scene_.contains("base") || !organ_;  // which is sent with the organ
  const HealthNote note = noteOf(health);
  const std::string text = json({{"text", note.text}, {"alarm", note.alarm}}).dump();
  if (text == health_text_) return;
  health_text_ = text;
  server_.publish(Kind::Health, textMessage(Kind::Health, text));
}

void SessionStream::publishSutures() {
  sutures_changed_ = false;
  graphics::SutureDrawing drawing;
  const std::string wrong = graphics::readSutures(*sutures_, drawing);
  if (!wrong.empty()) return warn(wrong);
  server_.publish(Kind::Sutures, encodeSutures(drawing));
  publishThreads(drawing);
  if (organ_) organ_->bleeding.setWounds(drawing, {});
}

/// The shape of all thread is large, and pages move it with the lines of the sutures. So it is sent anew only when
/// there are other lines, and else no more often than the wire bears.
void SessionStream::publishThreads(const graphics::SutureDrawing& drawing) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& set : drawing.sets)
    for (const auto& piece : set.pieces) points.insert(points.end(), piece.line.begin(), piece.line.end());
  if (points.size() == thread_points_ && ticks_ < threads_due_) return;
  graphics::ColouredShape threads;
  graphics::appendSutures(drawing, graphics::naturalSutures(), threads);
  Bytes shape = encodeShape(Kind::Threads, threads, points);
  if (shape == threads_) return;
  server_.publish(Kind::Threads, shape);
  thread_points_ = points.size();
  threads_due_ = ticks_ + static_cast<int>(shape.size() / kShapeBytesPerTick);
  threads_ = std::move(shape);
}

void SessionStream::publishWall() {
  if (!organ_ || !has_frame_ || server_.clients() == 0) return;
  if (ticks_ % kFoldTicks == 0)
    if (auto folds = organ_->look.folds(frame_)) server_.publish(Kind::Folds, std::move(*folds));
  if (auto heat = organ_->look.heat(frame_)) server_.publish(Kind::Heat, std::move(*heat));
  if (!sutures_ || (sutures_->bleedings.empty() && organ_->bleeding.shape().triangles.empty())) return;
  if (ticks_ < blood_due_) return;  // pages move it with the wall
  organ_->surface.update(frame_.positions);
  if (!organ_->bleeding.update(&organ_->surface.vertices(), Eigen::Isometry3d::Identity())) return;
  Bytes shape = encodeShape(Kind::Blood, organ_->bleeding.shape());
  blood_due_ = ticks_ + static_cast<int>(shape.size() / kShapeBytesPerTick);
  server_.publish(Kind::Blood, std::move(shape));
}

void SessionStream::warn(const std::string& sentence) {
  if (sentence == last_warning_) return;
  last_warning_ = sentence;
  ROS_WARN("%s", sentence.c_str());
}

}  // namespace vibe::web
