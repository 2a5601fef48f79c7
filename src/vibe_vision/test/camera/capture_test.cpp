#include "vibe_vision/camera/capture.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "camera/host_time.hpp"

namespace vibe::vision::capture_test {

namespace {

/// Counts how many frames are alive.
class Script : public FrameSource {
 public:
  Script(int count, double period) : count_(count), period_(period) {}

  ReadResult read(Frame& frame, double timeout) override {
    if (result != ReadResult::Frame) {
      sleepFor(std::min(timeout, 0.005));
      return result;
    }
    if (next_ == count_) return ReadResult::End;
    sleepFor(period_);
    ++alive;
    frame.owner = std::shared_ptr<const void>(nullptr, [this](const void*) { --alive; });
    frame.sequence = static_cast<std::uint64_t>(next_++);
    most_alive = std::max(most_alive.load(), alive.load());
    return ReadResult::Frame;
  }
  SourceStatistics statistics() const override { return {}; }
  std::string status() const override { return "script"; }

  std::atomic<ReadResult> result{ReadResult::Frame};
  std::atomic<int> alive{0}, most_alive{0};

 private:
  int count_, next_ = 0;
  double period_;
};

}  // namespace

TEST(LatestFrame, TheNewestWinsAndIsTakenOnce) {
  LatestFrame latest;
  Frame frame;
  for (std::uint64_t k = 1; k <= 3; ++k) {
    frame.sequence = k;
    latest.put(frame);
  }
  Frame taken;
  EXPECT_EQ(latest.take(taken, 10), ReadResult::Frame);
  EXPECT_EQ(taken.sequence, 3U);
  EXPECT_EQ(latest.dropped(), 2U);
  EXPECT_EQ(latest.take(taken, 0), ReadResult::Timeout);
}

TEST(LatestFrame, HoldsNoPixelsOfFramesThatWereReplacedOrTaken) {
  LatestFrame latest;
  const auto pixels = std::make_shared<int>();
  Frame frame, taken;
  frame.owner = pixels;
  latest.put(frame);
  latest.put(std::move(frame));
  EXPECT_EQ(pixels.use_count(), 2);
  EXPECT_EQ(latest.take(taken, 0), ReadResult::Frame);
  taken = Frame();
  EXPECT_EQ(pixels.use_count(), 1);
}

TEST(LatestFrame, TheLastFrameIsTakenBeforeTheEnd) {
  LatestFrame latest;
  latest.put(Frame());
  latest.close();
  Frame taken;
  EXPECT_EQ(latest.take(taken, 10), ReadResult::Frame);
  EXPECT_EQ(latest.take(taken, 1000), ReadResult::End);
}

TEST(LatestFrame, WakesTheOneThatWaits) {
  LatestFrame latest;
  std::thread giver([&latest] {
    sleepFor(0.02);
    latest.put(Frame());
  });
  Frame taken;
  EXPECT_EQ(latest.take(taken, 1000), ReadResult::Frame);
  giver.join();
  std::thread closer([&latest] {
    sleepFor(0.02);
    latest.close();
  });
  EXPECT_EQ(latest.take(taken, 1000), ReadResult::End);
  closer.join();
}

TEST(Capture, ASlowConsumerGetsTheNewestFrameAndNothingGrows) {
  auto script = std::make_unique<Script>(200, 0.002);
  Script& source = *script;
  Capture capture(std::move(script));
  Frame frame;
  std::vector<std::uint64_t> seen;
  while (capture.take(frame, 10) == ReadResult::Frame) {
    seen.push_back(frame.sequence);
    sleepFor(0.02);
  }
  ASSERT_FALSE(seen.empty());
  EXPECT_LT(seen.size(), 150U);
  EXPECT_EQ(seen.back(), 199U);  // the newest is never lost
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GT(seen[i], seen[i - 1]);
  EXPECT_EQ(capture.dropped() + seen.size(), 200U);
  EXPECT_LE(source.most_alive, 4);  // taken, waiting, being read, being replaced
}

TEST(Capture, GoneIsToldUntilTheCameraIsBack) {
  auto script = std::make_unique<Script>(1, 0);
  Script& source = *script;
  source.result = ReadResult::Gone;
  Capture capture(std::move(script));
  Frame frame;
  while (capture.take(frame, 0.01) == ReadResult::Timeout) {
  }
  EXPECT_EQ(capture.take(frame, 0.01), ReadResult::Gone);
  source.result = ReadResult::Frame;
  ReadResult result = ReadResult::Gone;
  for (int i = 0; i < 1000 && result != ReadResult::Frame; ++i) result = capture.take(frame, 0.01);
  EXPECT_EQ(result, ReadResult::Frame);
  EXPECT_EQ(capture.take(frame, 10), ReadResult::End);
}

TEST(Capture, TakeWaitsNoLongerThanItsTimeout) {
  auto script = std::make_unique<Script>(1, 0);
  script->result = ReadResult::Timeout;
  Capture capture(std::move(script));
  Frame frame;
  const double begin = steadyTime();
  EXPECT_EQ(capture.take(frame, 0.05), ReadResult::Timeout);
  EXPECT_GE(steadyTime() - begin, 0.05);
  EXPECT_LT(steadyTime() - begin, 5);
}

TEST(Capture, AnExceptionOfTheSourceEndsItWithTheMessage) {
  class Broken : public Script {
   public:
    Broken() : Script(1, 0) {}
    ReadResult read(Frame&, double) override { throw std::runtime_error("the disk is gone"); }
  };
  Capture capture(std::make_unique<Broken>());
  Frame frame;
  EXPECT_EQ(capture.take(frame, 10), ReadResult::End);
  EXPECT_EQ(capture.status(), "the disk is gone");
}

}  // namespace vibe::vision::capture_test
