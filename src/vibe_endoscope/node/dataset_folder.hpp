#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "dataset_options.hpp"
#include "session_frames.hpp"
#include "truth/truth_camera.hpp"

namespace vibe::endoscope {

/// The files of a data set. All functions throw std::runtime_error, in one sentence, if a file cannot be written.
///
/// Each lens has a folder ("" with one lens, "left/", "right/") with one folder for each kind of image; files are named
/// by the number of the image from 000000. Indexes and descriptions are text files in the folder of the data set.
/// All is written into its folder .part-dataset and moved up by finish(), so that nobody takes half a data set for one.
class DatasetFolder {
 public:
  /// Creates the folder.
  /// @throws std::runtime_error  it is there and not empty, or cannot be made
  explicit DatasetFolder(const DatasetOptions& options);
  /// Removes everything again unless finish() has written all of it.
  ~DatasetFolder();
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  /// Starts an image: a line in times.txt and in poses.txt.
  /// @param camera  pose of the (left) lens in the frame of the particles
  void addImage(std::size_t number, const ros::Time& stamp, const Eigen::Isometry3d& camera);
  void writeColour(const std::string& lens, std::size_t number, const std::vector<std::uint8_t>& pixels);
  void writeTruth(const std::string& lens, std::size_t number, const TruthCamera& camera, const TruthScene& scene,
                  const TruthView& view);
  void writeFlow(const std::string& lens, std::size_t number, const TruthFlow& flow);
  void writeParticles(std::size_t number, const sensor_msgs::PointCloud2& particles);
  void writeTopology(const vibe_msgs::TissueTopology& topology);
  void writeSutures(std::size_t number, const vibe_msgs::SutureArray& sutures);
  /// What describes the whole: intrinsics.json, labels.json, and dataset.json, which comes into place last.
  /// @param frame  of the poses
  void finish(const vibe_msgs::SessionInfo& info, const std::string& labels, const std::string& frame);

 private:
  std::string fileOf(const std::string& lens, const char* kind, std::size_t number, const char* ending) const;
  void writeText(const std::string& name, const std::string& text);
  std::string intrinsics() const;
  std::string description(const vibe_msgs::SessionInfo& info, const std::string& frame) const;

  void putInPlace() const;

  DatasetOptions options_;
  std::string folder_;  // that is written to
  bool is_new_ = false, is_finished_ = false;
  std::ofstream times_, poses_;  // not whole: the folder is
  std::size_t images_ = 0;
  double first_ = 0, last_ = 0;              // stamps [s]
  std::array<std::uint64_t, 256> pixels_{};  // per label
};

}  // namespace vibe::endoscope
