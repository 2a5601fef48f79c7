#include "endoscope_camera.hpp"

#include <ros/console.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>

namespace vibe {
namespace {

constexpr unsigned kWaiting =
    10;  // states that wait for their transforms; if there are more, no transform is to be expected
constexpr std::size_t kSutures = 240;  // messages kept to find the one that belongs to a state
constexpr double kRepeatPeriod = 5;    // of the warning about a fault that lasts [s of wall time]

Eigen::Isometry3d poseOf(const geometry_msgs::Transform& transform) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(transform.translation.x, transform.translation.y, transform.translation.z));
  const auto& turn = transform.rotation;
  pose.rotate(Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized());
  return pose;
}

sensor_msgs::CameraInfo infoOf(const RoundCamera& round, double aside, const std::string& frame) {
  const CameraNumbers numbers = numbersOf(round, aside);
  sensor_msgs::CameraInfo info;
  info.header.frame_id = frame;
  info.width = static_cast<std::uint32_t>(round.width);
  info.height = static_cast<std::uint32_t>(round.height);
  info.distortion_model = numbers.distortion_model;
  info.D = numbers.d;
  std::copy(numbers.k.begin(), numbers.k.end(), info.K.begin());
  std::copy(numbers.r.begin(), numbers.r.end(), info.R.begin());
  std::copy(numbers.p.begin(), numbers.p.end(), info.P.begin());
  return info;
}

}  // namespace

EndoscopeCamera::EndoscopeCamera(ros::NodeHandle node, const CameraOptions& options, Ogre::SceneManager& scene,
                                 const std::string& description)
    : node_(node),
      options_(options),
      scene_(scene, description),
      camera_(scene, options.round, options.sharpness),
      due_(options.rate) {
  eyes_.reserve(2);
  addEye(options.stereo ? "endoscope/left/" : "endoscope/", 0, options.frame_id);
  if (options.stereo) addEye("endoscope/right/", options.baseline, options.right_frame_id);
}

void EndoscopeCamera::addEye(const std::string& name, double aside, const std::string& frame) {
  const ros::SubscriberStatusCallback changed = [this](const ros::SingleSubscriberPublisher&) { listenAsNeeded(); };
  eyes_.push_back({aside, infoOf(options_.round, aside, frame), {}, {}});
  eyes_.back().image = node_.advertise<sensor_msgs::Image>(name + "image_raw", 2, changed, changed);
  eyes_.back().info = node_.advertise<sensor_msgs::CameraInfo>(name + "camera_info", 2, changed, changed);
}

bool EndoscopeCamera::isWatched() const {
  return std::any_of(eyes_.begin(), eyes_.end(), [](const Eye& eye) { return eye.listeners() > 0; });
}

void EndoscopeCamera::listenAsNeeded() {
  if (isWatched() && !filter_) listen();
  if (!isWatched() && filter_) stopListening();
}

void EndoscopeCamera::listen() {
  transform_listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_);
  topology_ = node_.subscribe("tissue/topology", 1, &EndoscopeCamera::receiveTopology, this);
  sutures_ = node_.subscribe("sutures", 10, &EndoscopeCamera::receiveSutures, this);
  filter_ = std::make_unique<tf2_ros::MessageFilter<sensor_msgs::PointCloud2>>(transforms_, options_.camera_frame,
                                                                               kWaiting, node_);
  filter_->connectInput(particles_);
  filter_->registerCallback(&EndoscopeCamera::receiveParticles, this);
  // drawing may be slower than the simulator; only the newest state is drawn
  particles_.subscribe(node_, "tissue/particles", 2);
}

void EndoscopeCamera::stopListening() {
  particles_.unsubscribe();
  filter_.reset();
  topology_.shutdown();
  sutures_.shutdown();
  transform_listener_.reset();
  transforms_.clear();
  recent_sutures_.clear();
}

void EndoscopeCamera::receiveTopology(const vibe_msgs::TissueTopology::ConstPtr& message) {
  const std::string problem = scene_.setTopology(*message);
  if (!problem.empty()) ROS_WARN_STREAM(problem);
}

void EndoscopeCamera::receiveSutures(const vibe_msgs::SutureArray::ConstPtr& message) {
  const bool set_back = !recent_sutures_.empty() && message->header.stamp < recent_sutures_.back()->header.stamp;
  if (set_back) recent_sutures_.clear();
  recent_sutures_.push_back(message);
  if (recent_sutures_.size() > kSutures) recent_sutures_.pop_front();
}

void EndoscopeCamera::receiveParticles(const sensor_msgs::PointCloud2::ConstPtr& message) {
  const ros::Time stamp = message->header.stamp;
  if (!isWatched() || !due_.isDue(stamp)) return;
  const ros::WallTime begin = ros::WallTime::now();
  const std::string problem = scene_.setParticles(*message);
  if (!problem.empty()) {
    ROS_WARN_STREAM_THROTTLE(kRepeatPeriod, problem);
    return;
  }
  const EndoscopeScene::PoseOf pose_of = [&](const std::string& frame) {
    return find(frame, message->header.frame_id, stamp);
  };
  const std::optional<Eigen::Isometry3d> camera = pose_of(options_.camera_frame);
  if (!camera) return;  // the filter has seen this transform; it can be missing only if time was set back since
  drawSutures(stamp, pose_of);
  scene_.placeInstrument(pose_of);
  for (Eye& eye : eyes_) publish(eye, *camera, stamp);
  ROS_DEBUG("%.1f ms for the state of %.3f s", 1e3 * (ros::WallTime::now() - begin).toSec(), stamp.toSec());
}

void EndoscopeCamera::drawSutures(const ros::Time& stamp, const EndoscopeScene::PoseOf& poseOf) {
  vibe_msgs::SutureArray::ConstPtr latest;
  for (const auto& sutures : recent_sutures_)
    if (sutures->header.stamp <= stamp) latest = sutures;
  if (!latest || latest == drawn_sutures_) return;
  const std::string problem = scene_.setSutures(*latest, poseOf);
  if (problem.empty())
    drawn_sutures_ = latest;
  else
    ROS_WARN_STREAM_THROTTLE(kRepeatPeriod, problem);
}

void EndoscopeCamera::publish(Eye& eye, const Eigen::Isometry3d& camera, const ros::Time& stamp) {
  eye.numbers.header.stamp = stamp;
  if (eye.image.getNumSubscribers() > 0) {
    sensor_msgs::ImagePtr image = boost::make_shared<sensor_msgs::Image>();
    image->header = eye.numbers.header;
    image->width = eye.numbers.width;
    image->height = eye.numbers.height;
    image->encoding = sensor_msgs::image_encodings::RGB8;
    image->step = 3 * image->width;
    const Eigen::Isometry3d lens = camera * Eigen::Translation3d(eye.aside, 0, 0);
    if (options_.auto_exposure)
      camera_.take(lens, stamp.toSec(), image->data);
    else
      camera_.take(lens, image->data);
    eye.image.publish(image);
  }
  eye.info.publish(eye.numbers);
}

std::optional<Eigen::Isometry3d> EndoscopeCamera::find(const std::string& frame, const std::string& target,
                                                       const ros::Time& stamp) {
  try {
    return vibe::poseOf(transforms_.lookupTransform(target, frame, stamp).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace vibe
