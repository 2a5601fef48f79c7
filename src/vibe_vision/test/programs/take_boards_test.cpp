#include "take_boards.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "calibrate/rendered_board.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::take_boards_test {
namespace {

Frame frameOf(const RenderedBoard& board, double x, double stamp) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(x - 0.02, -0.0125, 0.2));
  const auto pixels = std::make_shared<std::vector<std::uint8_t>>(board.draw(pose, 0.5, 1));
  Frame frame;
  frame.image = board.view(*pixels);
  frame.owner = pixels;
  frame.stamp = stamp;
  return frame;
}

TEST(TakeBoards, APictureIsTakenWhenTheBoardStandsStillWhereItIsNeeded) {
  const RenderedBoard board(smallCamera(), kBoard);
  const Frame left = frameOf(board, -0.01, 0), right = frameOf(board, 0.01, 0);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("take_boards_" + std::to_string(::getpid()));
  BoardTaker taker(kBoard, 750, folder);
  std::vector<std::string> said;
  std::size_t at = 0;
  const std::vector<Frame> frames = {left, right, right, right, left};
  const auto next = [&](Frame& frame) {
    if (at == frames.size()) return ReadResult::End;
    frame = frames[at++];
    return ReadResult::Frame;
  };
  EXPECT_FALSE(takeBoards(next, 60, taker, [&](const std::string& sentence) { said.push_back(sentence); }));
  ASSERT_EQ(said.size(), 4U);
  EXPECT_EQ(said[0], "Hold the board still.");
  EXPECT_EQ(said[1].rfind("Taken: ", 0), 0U) << said[1];
  EXPECT_EQ(said[2].rfind("Move or tilt the board. Missing: 7 more pictures", 0), 0U) << said[2];
  EXPECT_EQ(said[3], "Hold the board still.");
  const cv::Mat saved = cv::imread(folder / "board_000.png", cv::IMREAD_GRAYSCALE);
  EXPECT_EQ(saved.cols, 364);
  EXPECT_FALSE(std::filesystem::exists(folder / "board_001.png"));
  EXPECT_ERROR(BoardTaker(kBoard, 750, folder), "give another folder");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vibe::vision::take_boards_test
