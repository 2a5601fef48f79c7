#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calibrate/fitting.hpp"
#include "vibe_vision/calibrate/lens_calibration.hpp"

namespace vibe::vision {
namespace {

constexpr double kWrongCorner = 0.15;  // of the distance of neighbours
constexpr double kWindow = 0.22;       // half the window of the refinement, of the same distance
constexpr int kSmallestWindow = 2, kLargestWindow = 15;

using Corners = std::vector<cv::Point2f>;

/// The corners as a grid.
class CornerGrid {
 public:
  CornerGrid(const Corners& corners, const BoardSpec& board) : corners_(corners), board_(board) {}

  /// Median distance of neighbours in a row [px].
  double spacing() const {
    std::vector<float> distances;
    for (int row = 0; row < board_.rows; ++row) {
      for (int column = 1; column < board_.columns; ++column) {
        const cv::Point2f d = at(row, column) - at(row, column - 1);
        distances.push_back(std::hypot(d.x, d.y));
      }
    }
    return median(distances);
  }

  /// Where the neighbours say that a corner is: the median of what they give on all straight lines through it.
  cv::Point2f expected(int row, int column) const {
    std::vector<float> x, y;
    for (const auto& [dr, dc] : {std::pair<int, int>{0, 1}, {1, 0}, {1, 1}, {1, -1}}) {
      add(row, column, -dr, -dc, dr, dc, 0.5F, x, y);     // between two
      add(row, column, dr, dc, 2 * dr, 2 * dc, 2, x, y);  // beyond two, on either side
      add(row, column, -dr, -dc, -2 * dr, -2 * dc, 2, x, y);
    }
    return {median(x), median(y)};
  }

 private:
  const Corners& corners_;
  const BoardSpec& board_;

  bool isInside(int row, int column) const {
    return row >= 0 && column >= 0 && row < board_.rows && column < board_.columns;
  }
  const cv::Point2f& at(int row, int column) const {
    return corners_[static_cast<std::size_t>(row) * static_cast<std::size_t>(board_.columns) +
                    static_cast<std::size_t>(column)];
  }
  void add(int row, int column, int r1, int c1, int r2, int c2, float weight, std::vector<float>& x,
           std::vector<float>& y) const {
    if (!isInside(row + r1, column + c1) || !isInside(row + r2, column + c2)) return;
    const cv::Point2f point = weight * at(row + r1, column + c1) + (1 - weight) * at(row + r2, column + c2);
    x.push_back(point.x);
    y.push_back(point.y);
  }
};

/// Replaces corners that do not lie where their neighbours say. @return whether there were any
bool mendCorners(Corners& corners, const BoardSpec& board) {
  const Corners found = corners;
  const CornerGrid grid(found, board);
  const double limit = kWrongCorner * grid.spacing();
  bool wrong = false;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      cv::Point2f& corner = corners[static_cast<std::size_t>(row * board.columns + column)];
      const cv::Point2f expected = grid.expected(row, column), d = corner - expected;
      if (std::hypot(d.x, d.y) < limit) continue;
      corner = expected;
      wrong = true;
    }
  }
  return wrong;
}

void refine(const cv::Mat& image, const BoardSpec& board, Corners& corners) {
  const double spacing = CornerGrid(corners, board).spacing();
  const int window = std::clamp(static_cast<int>(kWindow * spacing), kSmallestWindow, kLargestWindow);
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4);
  cv::cornerSubPix(image, corners, cv::Size(window, window), cv::Size(-1, -1), until);
}

}  // namespace

std::optional<std::vector<Eigen::Vector2d>> findBoard(const ImageView& image, const BoardSpec& board) {
  const cv::Mat grey = image.mat();
  Corners found;
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE;
  if (!cv::findChessboardCornersSB(grey, cv::Size(board.columns, board.rows), found, flags)) return std::nullopt;
  mendCorners(found, board);
  refine(grey, board, found);
  if (mendCorners(found, board)) return std::nullopt;  // covered, or not a board
  std::vector<Eigen::Vector2d> corners;
  for (const cv::Point2f& point : found) corners.emplace_back(point.x, point.y);
  return corners;
}

}  // namespace vibe::vision
