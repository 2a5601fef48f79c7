#include "vibe_vision/config/camera_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "vibe_core/files/files.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::camera_files_test {
namespace {

/// As cameracalibrator.py of the package camera_calibration writes it.
const std::string kRos = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [430.215550, 0.000000, 306.691343,
         0.000000, 430.531693, 227.224800,
         0.000000, 0.000000, 1.000000]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.337586, 0.111612, -2.18e-04, -3.05e-04, 0.]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1., 0., 0., 0., 1., 0., 0., 0., 1.]
projection_matrix:
  rows: 3
  cols: 4
  data: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0.]
)";

/// As Kalibr writes a camchain of two cameras.
const std::string kKalibr = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.294726, 0.085835, -0.000102, 0.000271]
  distortion_model: radtan
  intrinsics: [461.487, 460.208, 366.203, 247.957]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: omni
  distortion_coeffs: [-0.2, 0.08, 0.0, 0.0]
  distortion_model: radtan
  intrinsics: [0.9, 459.1, 458.2, 380.0, 250.0]
  resolution: [752, 480]
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  EXPECT_NE(text.find(what), std::string::npos);
  return text.replace(text.find(what), what.size(), by);
}

CameraModel read(const std::string& text, const std::string& camera = "") {
  const std::string file = testing::TempDir() + "camera_files_" + std::to_string(getpid()) + ".yaml";
  writeFile(file, text, "The camera");
  return loadCameraFile(file, camera);
}

TEST(CameraFiles, CameraInfoOfRos) {
  const CameraModel camera = read(kRos);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.fx, 430.215550);
  EXPECT_EQ(camera.fy, 430.531693);
  EXPECT_EQ(camera.cx, 306.691343);
  EXPECT_EQ(camera.cy, 227.224800);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{-0.337586, 0.111612, -2.18e-04, -3.05e-04, 0}));
}

TEST(CameraFiles, CamchainOfKalibr) {
  const CameraModel camera = read(kKalibr, "cam0");
  EXPECT_EQ(camera.width, 752);
  EXPECT_EQ(camera.fx, 461.487);
  EXPECT_EQ(camera.fy, 460.208);
  EXPECT_EQ(camera.cx, 366.203);
  EXPECT_EQ(camera.cy, 247.957);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{-0.294726, 0.085835, -0.000102, 0.000271, 0}));
}

TEST(CameraFiles, WhatIsWrittenReadsBackToTheSameBits) {
  CameraModel camera;
  camera.width = 728, camera.height = 544;
  camera.fx = 4530.1 / 3, camera.fy = 1503.25, camera.cx = 1e3 / 3, camera.cy = 265.8;
  camera.distortion = {-0.1 / 3, 1e-7 / 3, 1e-3, -8e-4, 0};
  for (const CameraFileFormat format : {CameraFileFormat::Ros, CameraFileFormat::Kalibr}) {
    const CameraModel back = read(toCameraFile(camera, format));
    EXPECT_EQ(back.width, camera.width);
    EXPECT_EQ(back.height, camera.height);
    EXPECT_EQ(back.fx, camera.fx);
    EXPECT_EQ(back.fy, camera.fy);
    EXPECT_EQ(back.cx, camera.cx);
    EXPECT_EQ(back.cy, camera.cy);
    EXPECT_EQ(back.distortion, camera.distortion);
  }
  camera.distortion[4] = 0.25;
  EXPECT_EQ(read(toCameraFile(camera, CameraFileFormat::Ros)).distortion, camera.distortion);
  EXPECT_ERROR(toCameraFile(camera, CameraFileFormat::Kalibr), "k3 = 0.25");
}

TEST(CameraFiles, MistakesAreNamedWithTheirPlace) {
  EXPECT_ERROR(read(kKalibr), "has 2 cameras; choose one");
  EXPECT_ERROR(read(kKalibr, "cam2"), "'cam2' is not a camera");
  EXPECT_ERROR(read(kKalibr, "cam1"), "is 'omni', only 'pinhole'");
  EXPECT_ERROR(read(replaced(kRos, "plumb_bob", "equidistant")), ".yaml:10: distortion_model: is 'equidistant'");
  EXPECT_ERROR(read(replaced(kRos, "image_width: 640\n", "")), "lacks the key 'image_width'");
  EXPECT_ERROR(read(replaced(kRos, "430.215550", "0")), "focal length that is not above 0 px");
  EXPECT_ERROR(read("cameras: 2\n"), "neither the 'camera_matrix'");
}

}  // namespace
}  // namespace vibe::vision::camera_files_test
