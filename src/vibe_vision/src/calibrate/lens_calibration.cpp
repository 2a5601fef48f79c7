#include "vibe_vision/calibrate/lens_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <set>

#include "calibrate/fitting.hpp"
#include "calibrate/lens_limits.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

constexpr double kSignificant = 4;  // standard deviations; errors of neighbouring corners are not independent
constexpr int kGridColumns = 8, kGridRows = 6;
// As in lens_limits.hpp.
constexpr double kEnoughCoverage = 0.6;
constexpr double kLargeResidual = 0.5;  // [px]
constexpr double kFocalUncertainty = 0.01;
constexpr double kBadView = 3;  // times the median residual

/// One call of OpenCV and its results.
struct Fit {
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
  cv::Mat deviations, extrinsic_deviations, view_rms;
  double rms = 0;

  double deviation(int parameter) const { return deviations.at<double>(parameter); }
  double coefficient(int i) const { return distortion.at<double>(i); }
};

Fit fit(const std::vector<std::vector<cv::Point3f>>& objects, const std::vector<std::vector<cv::Point2f>>& images,
        cv::Size size, int flags) {
  Fit result;
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-9);
  result.rms = cv::calibrateCamera(objects, images, size, result.matrix, result.distortion, result.rotations,
                                   result.translations, result.deviations, result.extrinsic_deviations, result.view_rms,
                                   flags, until);
  return result;
}

/// Adds coefficients one after the other as long as they make the residual smaller than chance would (F test).
Fit fitSignificant(const std::vector<std::vector<cv::Point3f>>& objects,
                   const std::vector<std::vector<cv::Point2f>>& images, cv::Size size, std::array<bool, 5>& estimated) {
  int flags = cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  const auto measurements = static_cast<double>(2 * objects.size() * objects[0].size());
  const double freedom = measurements - 9 - 6 * static_cast<double>(objects.size());
  estimated = {};
  Fit result = fit(objects, images, size, flags);
  const auto tryToAdd = [&](std::initializer_list<int> coefficients, int flag) {
    Fit other = fit(objects, images, size, flags & ~flag);
    const double gain = (result.rms * result.rms - other.rms * other.rms) / (other.rms * other.rms) * freedom;
    if (gain < kSignificant * kSignificant * static_cast<double>(coefficients.size())) return;
    flags &= ~flag;
    for (const int i : coefficients) estimated[static_cast<std::size_t>(i)] = true;
    result = std::move(other);
  };
  tryToAdd({0}, cv::CALIB_FIX_K1);
  tryToAdd({2, 3}, cv::CALIB_ZERO_TANGENT_DIST);
  tryToAdd({1}, cv::CALIB_FIX_K2);
  if (estimated[1]) tryToAdd({4}, cv::CALIB_FIX_K3);
  return result;
}

double tiltOf(const cv::Mat& rotation_vector) {
  cv::Mat rotation;
  cv::Rodrigues(rotation_vector, rotation);
  return std::acos(std::min(1.0, std::abs(rotation.at<double>(2, 2))));
}

double coverageOf(const std::vector<BoardView>& views, int width, int height) {
  std::set<int> seen;
  for (const BoardView& view : views) {
    for (const Eigen::Vector2d& corner : view.corners) {
      const int column = static_cast<int>((corner.x() + 0.5) / width * kGridColumns);
      const int row = static_cast<int>((corner.y() + 0.5) / height * kGridRows);
      if (column < 0 || row < 0 || column >= kGridColumns || row >= kGridRows) continue;
      seen.insert(row * kGridColumns + column);
    }
  }
  return static_cast<double>(seen.size()) / (kGridColumns * kGridRows);
}

void warnAboutViews(const LensCalibration& result, std::vector<std::string>& warnings) {
  if (result.views.size() < kEnoughViews) {
    warnings.push_back("the board was found in " + std::to_string(result.views.size()) +
                       " images only; take at least " + std::to_string(kEnoughViews));
  }
  double largest = 0;
  std::vector<double> rms;
  for (const BoardFit& view : result.views) {
    largest = std::max(largest, view.tilt);
    rms.push_back(view.rms);
  }
  if (largest < kEnoughTilt) {
    warnings.push_back("the board is tilted by " + withDecimals(largest * 180 / M_PI, 0) +
                       " deg at most, so the focal length is hardly determined; tilt it by 20 to 40 deg, to all sides");
  }
  for (const BoardFit& view : result.views) {
    if (view.rms <= kBadView * median(rms)) continue;
    warnings.push_back(view.name + " fits badly, " + withDecimals(view.rms, 2) +
                       " px; look whether the board is blurred or bent in it and leave it out");
  }
}

void warnAboutResult(const LensCalibration& result, std::vector<std::string>& warnings) {
  if (result.coverage < kEnoughCoverage) {
    warnings.push_back("the board covers " + withDecimals(100 * result.coverage, 0) +
                       " % of the image, so the distortion elsewhere is a guess; move it into all corners and edges");
  }
  if (result.camera.reprojection_rms > kLargeResidual) {
    warnings.push_back("the residual of " + withDecimals(result.camera.reprojection_rms, 2) +
                       " px is large; check that the board is flat, in focus, and not moving");
  }
  const double relative = result.deviation[0] / result.camera.fx;
  if (relative > kFocalUncertainty) {
    warnings.push_back("the focal length is uncertain by " + withDecimals(100 * relative, 1) +
                       " %; add images of the tilted board");
  }
}

CameraModel cameraOf(const Fit& fit, int width, int height) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = fit.matrix.at<double>(0, 0);
  camera.fy = fit.matrix.at<double>(1, 1);
  camera.cx = fit.matrix.at<double>(0, 2);
  camera.cy = fit.matrix.at<double>(1, 2);
  for (int i = 0; i < 5; ++i) camera.distortion[static_cast<std::size_t>(i)] = fit.coefficient(i);
  camera.reprojection_rms = fit.rms;
  return camera;
}

void checkViews(const std::vector<BoardView>& views, const BoardSpec& board) {
  if (views.size() < 3) {
    throw Error("a chessboard of " + std::to_string(board.columns) + "x" + std::to_string(board.rows) +
                " inner corners was found in " + std::to_string(views.size()) +
                " images, 3 are needed at the least; take 8 or more with the whole board in view, and count its inner "
                "corners");
  }
  for (const BoardView& view : views) {
    if (view.corners.size() != static_cast<std::size_t>(board.columns) * static_cast<std::size_t>(board.rows)) {
      throw Error(view.name + ": has " + std::to_string(view.corners.size()) + " corners of a board of " +
                  std::to_string(board.columns) + "x" + std::to_string(board.rows) + "; give all of them");
    }
  }
}

}  // namespace

std::vector<cv::Point3f> boardPoints(const BoardSpec& board) {
  const auto square = static_cast<float>(1e3 * board.square);
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(static_cast<float>(column) * square, static_cast<float>(row) * square, 0.0F);
    }
  }
  return points;
}

LensCalibration calibrateLens(const std::vector<BoardView>& views, const BoardSpec& board, int width, int height) {
  checkViews(views, board);
  std::vector<std::vector<cv::Point2f>> images;
  for (const BoardView& view : views) {
    images.emplace_back();
    for (const Eigen::Vector2d& p : view.corners) {
      images.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
  }
  const std::vector<std::vector<cv::Point3f>> objects(views.size(), boardPoints(board));
  LensCalibration result;
  Fit best;
  try {
    best = fitSignificant(objects, images, cv::Size(width, height), result.estimated);
  } catch (const cv::Exception&) {
    throw Error("these images of the chessboard do not determine a lens; take them with the board tilted to all sides");
  }
  result.camera = cameraOf(best, width, height);
  for (int i = 0; i < 4; ++i) result.deviation[static_cast<std::size_t>(i)] = best.deviation(i);
  for (std::size_t i = 0; i < views.size(); ++i) {
    result.views.push_back({views[i].name, best.view_rms.at<double>(static_cast<int>(i)), tiltOf(best.rotations[i])});
  }
  result.coverage = coverageOf(views, width, height);
  warnAboutViews(result, result.warnings);
  warnAboutResult(result, result.warnings);
  return result;
}

}  // namespace vibe::vision
