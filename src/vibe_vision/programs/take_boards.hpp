#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "image_files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/calibrate/board_guide.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// Takes pictures of a chessboard that a person holds before a camera, one whenever it stands still where it is needed,
/// and says what to do next.
class BoardTaker {
 public:
  /// @param focal_length  roughly [px]. @throws Error if the folder cannot be made or has pictures already
  BoardTaker(const BoardSpec& board, double focal_length, const std::string& folder)
      : board_(board), focal_length_(focal_length), folder_(folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed) throw Error(folder + ": the folder cannot be made: " + failed.message());
    if (std::filesystem::exists(fileOf(0)))
      throw Error(fileOf(0) + ": is there already; give another folder, or remove the pictures");
  }

  /// @return what to do, a sentence
  std::string look(const Frame& frame) {
    if (!guide_) guide_.emplace(board_, focal_length_, frame.image.width, frame.image.height);
    const BoardPicture picture = guide_->look(frame.image);
    const bool still = picture.corners && before_ && distance(*picture.corners, *before_) < kStill;
    before_ = picture.corners;
    if (!picture.problem.empty()) return "Not taken: " + picture.problem + ".";
    if (!guide_->isNew(*picture.corners)) return "Move or tilt the board. Missing: " + missing() + ".";
    if (!still) return "Hold the board still.";
    save(frame.image, fileOf(guide_->taken()));
    guide_->take(*picture.corners);
    return "Taken: " + fileOf(guide_->taken() - 1) + ". Missing: " + (missing().empty() ? "nothing" : missing()) + ".";
  }

  /// What pictures are needed still; empty: none.
  std::string missing() const { return guide_ ? guide_->missing() : "all"; }

 private:
  static constexpr double kStill = 1;  // mean distance of the corners from one look to the next [px]

  BoardSpec board_;
  double focal_length_;
  std::filesystem::path folder_;
  std::optional<BoardGuide> guide_;  // from the first picture on
  std::optional<std::vector<Eigen::Vector2d>> before_;

  std::string fileOf(std::size_t number) const { return folder_ / formatted("board_%03zu.png", number); }
  static double distance(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).norm();
    return sum / static_cast<double>(a.size());
  }
  static void save(const ImageView& image, const std::string& file) {
    if (std::filesystem::exists(file)) throw Error(file + ": is there already; give another folder");
    writePicture(file, image.mat());
  }
};

/// Lets a person hold the board before a camera until nothing is missing. @param next  the newest frame
/// @param say  each new sentence. @return whether nothing is missing
inline bool takeBoards(const std::function<ReadResult(Frame&)>& next, double seconds, BoardTaker& taker,
                       const std::function<void(const std::string&)>& say) {
  Frame frame;
  std::string told;
  double first = -1;
  for (int silent = 0; silent < 10;) {
    const ReadResult result = next(frame);
    if (result == ReadResult::End) break;
    silent = result == ReadResult::Frame ? 0 : silent + 1;
    if (result != ReadResult::Frame) continue;
    if (first < 0) first = frame.stamp;
    if (frame.stamp - first > seconds) break;
    const std::string sentence = taker.look(frame);
    if (sentence != told) say(sentence);
    told = sentence;
    if (taker.missing().empty()) return true;
  }
  if (first < 0) say("No frame came.");
  return false;
}

}  // namespace vibe::vision
