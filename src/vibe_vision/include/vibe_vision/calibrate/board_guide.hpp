#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_vision/calibrate/lens_calibration.hpp"

namespace vibe::vision {

/// A picture of the chessboard, and what it is good for.
struct BoardPicture {
  std::optional<std::vector<Eigen::Vector2d>> corners;  ///< row by row [px]; nothing: no whole board is seen
  double edge = 0;                                      ///< width of an edge from black to white [px]
  std::string problem;                                  ///< what spoils it, with the remedy; empty: nothing
};

/// Guides a person who takes pictures of a chessboard for calibrateLens(): what spoils a picture, and which pictures
/// are still missing.
class BoardGuide {
 public:
  /// @param focal_length  roughly, for the tilt of the board [px]. @param width, height  of the images [px]
  BoardGuide(const BoardSpec& board, double focal_length, int width, int height);

  /// Looks for the board; no memory.
  BoardPicture look(const ImageView& image) const;
  /// Whether the board is elsewhere, or tilted otherwise, than in all pictures taken. @param corners  of a whole board
  bool isNew(const std::vector<Eigen::Vector2d>& corners) const;
  void take(const std::vector<Eigen::Vector2d>& corners);  ///< counts a picture
  std::size_t taken() const { return taken_.size(); }      ///< pictures
  /// "2 more pictures; tilts that bring its left and upper side farther away; the lower right of the image"; empty:
  /// none
  std::string missing() const;

 private:
  static constexpr int kColumns = 8, kRows = 6;  // of the parts in which corners are counted

  BoardSpec board_;
  double focal_length_;
  int width_, height_;
  std::vector<std::vector<Eigen::Vector2d>> taken_;
  std::array<bool, 4> tilted_{};  // left, right, upper, lower side farther away
  std::array<std::array<bool, kColumns>, kRows> seen_{};

  Eigen::Vector2d slopeOf(const std::vector<Eigen::Vector2d>& corners) const;
  std::vector<std::string> unseenParts() const;
};

}  // namespace vibe::vision
