#include "vibe_vision/calibrate/board_guide.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "calibrate/fitting.hpp"
#include "calibrate/lens_limits.hpp"

namespace vibe::vision {
namespace {

constexpr double kWideEdge = 4;         // from which an edge is blurred [px]; OpenCV advises 3 for sharp pictures
constexpr double kSaturated = 250;      // [DN]
constexpr double kLeastContrast = 40;   // [DN]
constexpr double kNewPlace = 0.08;      // of the image's width
constexpr double kNewTilt = 0.12;       // of the slope
constexpr double kEnoughOfAPart = 0.6;  // as of the whole image
const double kSlope = std::tan(kEnoughTilt);

std::vector<cv::Point2f> pointsOf(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& p : corners) points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  return points;
}

/// Grey value below which a share of the pixels is.
int quantileOf(const cv::Mat& grey, double share) {
  std::vector<std::uint8_t> values;
  for (int y = 0; y < grey.rows; ++y) values.insert(values.end(), grey.ptr(y), grey.ptr(y) + grey.cols);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Why no board is found.
std::string whyNone(const cv::Mat& grey) {
  if (quantileOf(grey, 0.5) >= kSaturated) return "over-exposed; shorten the exposure or take light away";
  if (quantileOf(grey, 0.98) - quantileOf(grey, 0.02) < kLeastContrast)
    return "too dark or without contrast; give more light or a longer exposure";
  return "no whole chessboard; bring all of it and its white rim into view, in focus, and check --board";
}

}  // namespace

BoardGuide::BoardGuide(const BoardSpec& board, double focal_length, int width, int height)
    : board_(board), focal_length_(focal_length), width_(width), height_(height) {}

BoardPicture BoardGuide::look(const ImageView& image) const {
  BoardPicture picture;
  const cv::Mat grey = image.mat();
  picture.corners = findBoard(image, board_);
  if (!picture.corners) {
    picture.problem = whyNone(grey);
    return picture;
  }
  const cv::Scalar found =
      cv::estimateChessboardSharpness(grey, cv::Size(board_.columns, board_.rows), pointsOf(*picture.corners));
  picture.edge = found[0];
  if (found[2] >= kSaturated)
    picture.problem =
        "over-exposed, its white has " + withDecimals(found[2], 0) + " DN; shorten the exposure or take light away";
  else if (found[2] - found[1] < kLeastContrast)
    picture.problem = "too dark, white and black differ by " + withDecimals(found[2] - found[1], 0) +
                      " DN; give more light or a longer exposure";
  else if (picture.edge > kWideEdge)
    picture.problem = "blurred, its edges are " + withDecimals(picture.edge, 1) +
                      " px wide; hold it still and at the distance that is in focus";
  return picture;
}

/// By how much the board is farther away to the right and to the bottom of the image.
Eigen::Vector2d BoardGuide::slopeOf(const std::vector<Eigen::Vector2d>& corners) const {
  const cv::Matx33d matrix(focal_length_, 0, (width_ - 1) / 2.0, 0, focal_length_, (height_ - 1) / 2.0, 0, 0, 1);
  cv::Mat rotation_vector, translation, rotation;
  cv::solvePnP(boardPoints(board_), pointsOf(corners), matrix, cv::noArray(), rotation_vector, translation);
  cv::Rodrigues(rotation_vector, rotation);
  const double x = rotation.at<double>(0, 2), y = rotation.at<double>(1, 2), z = rotation.at<double>(2, 2);
  return {-x / z, -y / z};
}

bool BoardGuide::isNew(const std::vector<Eigen::Vector2d>& corners) const {
  const Eigen::Vector2d slope = slopeOf(corners);
  return std::none_of(taken_.begin(), taken_.end(), [&](const std::vector<Eigen::Vector2d>& other) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) sum += (corners[i] - other[i]).norm();
    const bool near = sum < kNewPlace * width_ * static_cast<double>(corners.size());
    return near && (slope - slopeOf(other)).norm() < kNewTilt;
  });
}

void BoardGuide::take(const std::vector<Eigen::Vector2d>& corners) {
  taken_.push_back(corners);
  const Eigen::Vector2d slope = slopeOf(corners);
  const std::array<double, 4> farther = {-slope.x(), slope.x(), -slope.y(), slope.y()};
  for (std::size_t i = 0; i < 4; ++i) tilted_[i] = tilted_[i] || farther[i] > kSlope;
  for (const Eigen::Vector2d& corner : corners) {
    const int column = static_cast<int>((corner.x() + 0.5) / width_ * kColumns);
    const int row = static_cast<int>((corner.y() + 0.5) / height_ * kRows);
    if (column < 0 || row < 0 || column >= kColumns || row >= kRows) continue;
    seen_[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = true;
  }
}

/// Of nine, those in which corners were seen at few places.
std::vector<std::string> BoardGuide::unseenParts() const {
  const std::array<std::size_t, 4> columns = {0, 3, 5, 8}, rows = {0, 2, 4, 6};
  const std::array<const char*, 3> across = {"left", "", "right"}, down = {"upper", "", "lower"};
  std::vector<std::string> parts;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      double seen = 0, all = 0;
      for (std::size_t y = rows[r]; y < rows[r + 1]; ++y)
        for (std::size_t x = columns[c]; x < columns[c + 1]; ++x) seen += seen_[y][x] ? 1 : 0, ++all;
      if (seen >= kEnoughOfAPart * all) continue;
      const bool middle = r == 1 && c == 1, corner = r != 1 && c != 1;
      parts.push_back(middle ? "middle" : std::string(down[r]) + (corner ? " " : "") + across[c]);
    }
  return parts;
}

std::string BoardGuide::missing() const {
  std::vector<std::string> wishes, sides;
  const std::array<const char*, 4> names = {"left", "right", "upper", "lower"};
  for (std::size_t i = 0; i < 4; ++i)
    if (!tilted_[i]) sides.emplace_back(names[i]);
  if (taken_.size() < kEnoughViews) wishes.push_back(std::to_string(kEnoughViews - taken_.size()) + " more pictures");
  if (!sides.empty()) wishes.push_back("tilts by 20 to 40 deg with its " + listOf(sides) + " side farther away");
  const std::vector<std::string> parts = unseenParts();
  if (!parts.empty()) wishes.push_back("the board at the " + listOf(parts) + " of the image");
  std::string text;
  for (const std::string& wish : wishes) text += (text.empty() ? "" : "; ") + wish;
  return text;
}

}  // namespace vibe::vision
