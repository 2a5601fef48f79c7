// endoscope_camera: what the endoscope sees, as images, without rviz and without a screen.
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <message_filters/subscriber.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <rviz/ogre_helpers/render_system.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/String.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/transform_listener.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "camera_options.hpp"
#include "endoscope_scene.hpp"
#include "image_due.hpp"
#include "sensor/sensor_model.hpp"
#include "truth/truth_camera.hpp"
#include "truth_topics.hpp"
#include "truth_world.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/graphics/virtual_display.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace vibe::endoscope {
namespace {

constexpr unsigned kWaiting =
    10;  // states that wait for their transforms; if there are more, no transform is to be expected
constexpr std::size_t kSutures = 240;  // messages kept to find the one that belongs to a state
constexpr int kFailure = 1, kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]
constexpr double kRepeatPeriod = 5;     // of the warning about a fault that lasts [s of wall time]

Eigen::Isometry3d toIsometry(const geometry_msgs::Transform& transform) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(transform.translation.x, transform.translation.y, transform.translation.z));
  const auto& turn = transform.rotation;
  pose.rotate(Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized());
  return pose;
}

sensor_msgs::CameraInfo infoOf(const CameraOptions& options, double aside, const std::string& frame) {
  const graphics::RoundCamera& round = options.round;
  graphics::CameraNumbers numbers = graphics::numbersOf(round, aside);
  numbers.d[0] = options.sensor.distortion;  // the first radial coefficient of both models
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

/// Publishes what the endoscope sees as images, one or two per state of the tissue, and the truth beside them: depth,
/// normals, labels, optical flow, pose. An image has the stamp of the tissue it shows, with everything else as it was
/// at that time. Without subscribers it subscribes to nothing, and only what has subscribers is computed. Runs in the
/// thread that calls ros::spin().
class EndoscopeCamera {
 public:
  /// @throws std::runtime_error  the graphics system does not support it
  EndoscopeCamera(ros::NodeHandle node, const CameraOptions& options, Ogre::SceneManager& scene,
                  const std::string& description)
      : node_(node),
        options_(options),
        scene_(scene, description, options.smoke),
        camera_(scene, options.round, options.sharpness),
        sensor_(options.sensor, options.round),
        truth_(description),
        truth_camera_(options.round, static_cast<double>(graphics::kScopeNearClip),
                      static_cast<double>(graphics::kScopeFarClip)),
        due_(options.rate) {
    for (const std::string& problem : truth_.problems()) ROS_WARN_STREAM(problem);
    label_table_ = node_.advertise<std_msgs::String>("endoscope/label_table", 1, true);
    std_msgs::String table;
    table.data = truth_.labels();
    label_table_.publish(table);
    eyes_.reserve(2);
    addEye(options.stereo ? "endoscope/left/" : "endoscope/", 0, options.frame_id);
    if (options.stereo) addEye("endoscope/right/", options.baseline, options.right_frame_id);
    particles_.registerCallback(&EndoscopeCamera::followParticles, this);
  }

 private:
  /// One of the lenses: the only one, or left or right.
  struct Eye {
    double aside;  ///< distance to the right of the camera frame [m]
    sensor_msgs::CameraInfo numbers;
    ros::Publisher image, info;
    TruthTopics truth;
    bool isWatched() const { return image.getNumSubscribers() + info.getNumSubscribers() > 0 || truth.isWatched(); }
  };

  void addEye(const std::string& name, double aside, const std::string& frame) {
    const ros::SubscriberStatusCallback changed = [this](const ros::SingleSubscriberPublisher&) { listenAsNeeded(); };
    eyes_.push_back({aside, infoOf(options_, aside, frame), {}, {}, TruthTopics(node_, name, changed)});
    eyes_.back().image = node_.advertise<sensor_msgs::Image>(name + "image_raw", 2, changed, changed);
    eyes_.back().info = node_.advertise<sensor_msgs::CameraInfo>(name + "camera_info", 2, changed, changed);
  }

  bool isWatched() const {
    return std::any_of(eyes_.begin(), eyes_.end(), [](const Eye& eye) { return eye.isWatched(); });
  }

  void listenAsNeeded() {
    if (isWatched() && !filter_) listen();
    if (!isWatched() && filter_) stopListening();
  }

  void listen() {
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

  void stopListening() {
    particles_.unsubscribe();
    filter_.reset();
    topology_.shutdown();
    sutures_.shutdown();
    transform_listener_.reset();
    transforms_.clear();
    recent_sutures_.clear();
    for (Eye& eye : eyes_) eye.truth.forget();
  }

  void receiveTopology(const vibe_msgs::TissueTopology::ConstPtr& message) {
    const std::string problem = scene_.setTopology(*message);
    if (!problem.empty()) ROS_WARN_STREAM(problem);
    truth_.setTopology(*message);  // the same checks
  }

  void receiveSutures(const vibe_msgs::SutureArray::ConstPtr& message) {
    const bool set_back = !recent_sutures_.empty() && message->header.stamp < recent_sutures_.back()->header.stamp;
    if (set_back) recent_sutures_.clear();
    recent_sutures_.push_back(message);
    if (recent_sutures_.size() > kSutures) recent_sutures_.pop_front();
  }

  /// Smoke and the age of marks follow the states as they arrive. Transforms of a simulation that is faster than real
  /// time can be gone already, or release states in another order, which looked as if time had been set back: marks
  /// stayed white.
  void followParticles(const sensor_msgs::PointCloud2::ConstPtr& message) {
    scene_.followParticles(*message);  // receiveParticles() says what is wrong
  }

  void receiveParticles(const sensor_msgs::PointCloud2::ConstPtr& message) {
    const ros::Time stamp = message->header.stamp;
    if (!isWatched() || !due_.isDue(stamp)) return;
    const ros::WallTime begin = ros::WallTime::now();
    const EndoscopeScene::PoseOf pose_of = [&](const std::string& frame) {
      return find(frame, message->header.frame_id, stamp);
    };
    const std::optional<Eigen::Isometry3d> camera = pose_of(options_.camera_frame);
    if (!camera) return;  // the filter has seen this transform; it can be missing only if time was set back since
    std::string problem = draw(*message, pose_of);
    if (problem.empty()) problem = drawTruth(*message, *camera, pose_of);
    if (!problem.empty()) {
      ROS_WARN_STREAM_THROTTLE(kRepeatPeriod, problem);
      return;
    }
    for (Eye& eye : eyes_) publish(eye, *camera, message->header);
    ROS_DEBUG("%.1f ms for the state of %.3f s", 1e3 * (ros::WallTime::now() - begin).toSec(), stamp.toSec());
  }

  vibe_msgs::SutureArray::ConstPtr suturesAt(const ros::Time& stamp) const {
    vibe_msgs::SutureArray::ConstPtr latest;
    for (const auto& sutures : recent_sutures_)
      if (sutures->header.stamp <= stamp) latest = sutures;
    return latest;
  }

  /// What is wrong with the particles, in one sentence; empty: the scene shows this state.
  std::string draw(const sensor_msgs::PointCloud2& particles, const EndoscopeScene::PoseOf& pose_of) {
    std::string problem = scene_.showParticles(particles);
    if (!problem.empty()) return problem;
    scene_.placeInstrument(pose_of);
    const vibe_msgs::SutureArray::ConstPtr sutures = suturesAt(particles.header.stamp);
    if (sutures && sutures != drawn_sutures_) {
      problem = scene_.setSutures(*sutures, pose_of);
      if (problem.empty())
        drawn_sutures_ = sutures;
      else
        ROS_WARN_STREAM_THROTTLE(kRepeatPeriod, problem);
    }
    scene_.drawBlood();
    return "";
  }

  /// The same for the truth, if somebody wants it.
  std::string drawTruth(const sensor_msgs::PointCloud2& particles, const Eigen::Isometry3d& camera,
                        const EndoscopeScene::PoseOf& pose_of) {
    if (std::none_of(eyes_.begin(), eyes_.end(), [](const Eye& eye) { return eye.truth.needsRays(); })) return "";
    const std::string problem = truth_.setParticles(particles);
    if (!problem.empty()) return problem;
    truth_.placeInstrument(pose_of);
    const vibe_msgs::SutureArray::ConstPtr sutures = suturesAt(particles.header.stamp);
    if (sutures && sutures != true_sutures_ && truth_.setSutures(*sutures, pose_of).empty()) true_sutures_ = sutures;
    truth_.pressOnLens(camera);
    truth_.commit();
    return "";
  }

  void publish(Eye& eye, const Eigen::Isometry3d& camera, const std_msgs::Header& particles) {
    eye.numbers.header.stamp = particles.stamp;
    const Eigen::Isometry3d pose = camera * Eigen::Translation3d(eye.aside, 0, 0);
    if (eye.image.getNumSubscribers() > 0) publishImage(eye, pose);
    eye.info.publish(eye.numbers);
    eye.truth.publish(truth_camera_, truth_.scene(), pose, eye.numbers.header, particles.frame_id);
  }

  void publishImage(Eye& eye, const Eigen::Isometry3d& pose) {
    sensor_msgs::ImagePtr image = boost::make_shared<sensor_msgs::Image>();
    image->header = eye.numbers.header;
    image->width = eye.numbers.width;
    image->height = eye.numbers.height;
    image->encoding = sensor_msgs::image_encodings::RGB8;
    image->step = 3 * image->width;
    if (options_.auto_exposure)
      camera_.take(pose, image->header.stamp.toSec(), image->data);
    else
      camera_.take(pose, image->data);
    // the two lenses of a pair have noise of their own
    sensor_.expose(image->data, 2 * image->header.stamp.toNSec() + (&eye == &eyes_.front() ? 0 : 1));
    eye.image.publish(image);
  }

  std::optional<Eigen::Isometry3d> find(const std::string& frame, const std::string& target, const ros::Time& stamp) {
    try {
      return toIsometry(transforms_.lookupTransform(target, frame, stamp).transform);
    } catch (const tf2::TransformException&) {
      return std::nullopt;
    }
  }

  ros::NodeHandle node_;
  CameraOptions options_;
  EndoscopeScene scene_;
  graphics::OffscreenCamera camera_;
  SensorModel sensor_;
  TruthWorld truth_;
  TruthCamera truth_camera_;
  ros::Publisher label_table_;
  std::vector<Eye> eyes_;
  ImageDue due_;

  // while there are subscribers
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> transform_listener_;
  ros::Subscriber topology_, sutures_;
  message_filters::Subscriber<sensor_msgs::PointCloud2> particles_;
  std::unique_ptr<tf2_ros::MessageFilter<sensor_msgs::PointCloud2>> filter_;
  std::deque<vibe_msgs::SutureArray::ConstPtr> recent_sutures_;
  vibe_msgs::SutureArray::ConstPtr drawn_sutures_, true_sutures_;
};

int fail(const std::exception& error, int status) {
  std::fprintf(stderr, "endoscope_camera: %s\n", error.what());
  return status;
}

void run(const CameraOptions& options) {
  graphics::provideDisplay();
  rviz::RenderSystem::forceNoStereo();
  Ogre::SceneManager* scene = rviz::RenderSystem::get()->root()->createSceneManager();
  graphics::loadResources();
  ros::NodeHandle node;
  std::string description;
  node.getParam("robot_description", description);
  EndoscopeCamera camera(node, options, *scene, description);
  ros::spin();
}

int runCamera(int argc, char** argv) {
  CameraOptions options;
  try {
    ros_utils::init(argc, argv, "endoscope_camera");
    ros_utils::waitForMaster(kMasterPatience);
    options = readCameraOptions(ros::NodeHandle("~"));
  } catch (const std::exception& error) {
    return fail(error, kUsage);
  }
  try {
    run(options);
  } catch (const std::exception& error) {
    return fail(error, kFailure);
  }
  return 0;
}

}  // namespace
}  // namespace vibe::endoscope

int main(int argc, char** argv) {
  return vibe::endoscope::runCamera(argc, argv);
}
