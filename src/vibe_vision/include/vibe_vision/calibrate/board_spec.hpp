#pragma once

namespace vibe::vision {

/// Chessboard for the calibration of the lens, counted by its inner corners as OpenCV does.
struct BoardSpec {
  int columns = 9, rows = 6;
  double square = 5e-3;  ///< side of a square [m]
};

}  // namespace vibe::vision
