// The receivers in examples/ understand what the sender sends.
#include <gtest/gtest.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <limits>
#include <sstream>
#include <thread>

#include "vibe_vision/datagram/datagram.hpp"
#include "vibe_vision/predict/predictor.hpp"

namespace vibe::vision::receiver_examples_test {
namespace {

double hostTime() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A program that prints what it receives on a port.
class ReceiverProgram {
 public:
  explicit ReceiverProgram(const std::string& program) : port_(20000 + getpid() % 20000) {
    int pipe_ends[2];
    EXPECT_EQ(pipe(pipe_ends), 0);
    process_ = fork();
    if (process_ == 0) {
      dup2(pipe_ends[1], STDOUT_FILENO);
      execl(program.c_str(), program.c_str(), std::to_string(port_).c_str(), nullptr);
      _exit(127);
    }
    close(pipe_ends[1]);
    output_ = fdopen(pipe_ends[0], "r");
  }
  ~ReceiverProgram() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    fclose(output_);
  }
  std::string target() const { return "127.0.0.1:" + std::to_string(port_); }
  std::string line() {
    char text[256] = "";
    return fgets(text, sizeof text, output_) != nullptr ? text : "";
  }

 private:
  int port_;
  pid_t process_ = 0;
  FILE* output_ = nullptr;
};

constexpr float kJerkTime = 0.02F;  // [s]

TrackDatagram exampleDatagram(double stamp) {
  TrackDatagram datagram;
  datagram.stamp = stamp;
  datagram.jerk_time = kJerkTime;
  datagram.instruments.resize(3);
  datagram.instruments[0].tracked = datagram.instruments[0].has_rotation = true;
  datagram.instruments[0].slide = {0.01, 0.2, -3, 100, {}};
  datagram.instruments[0].rotation = {-1, 5, 0, -2000, {}};
  datagram.instruments[1].tracked = true;
  datagram.instruments[1].slide = {0.05, 0, 0, 0, {}};
  datagram.instruments[2].reason = 2;
  datagram.instruments[2].slide.position = std::numeric_limits<double>::quiet_NaN();
  return datagram;
}

double positionOf(const CoordinateSample& sample, double dt) {
  const Eigen::Vector4d mean(sample.position, sample.velocity, sample.acceleration, sample.jerk);
  return (motionTransition(dt, kJerkTime) * mean)(0);
}

/// Sends until the program, which takes a while to start, prints; bytes of strangers before each.
std::string firstLine(ReceiverProgram& receiver, const std::vector<std::uint8_t>& bytes) {
  UdpSender sender(receiver.target());
  std::atomic<bool> printed{false};
  std::thread sending([&] {
    for (int i = 0; i < 200 && !printed; ++i) {
      sender.send({1, 2, 3});
      sender.send(std::vector<std::uint8_t>(bytes.begin(), bytes.end() - 1));
      sender.send(bytes);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  const std::string line = receiver.line();
  printed = true;
  sending.join();
  return line;
}

void expectUnderstands(const std::string& program) {
  ReceiverProgram receiver(program);
  const double begin = hostTime();
  const TrackDatagram datagram = exampleDatagram(begin);
  std::istringstream first(firstLine(receiver, encode(datagram)));
  int index = -1;
  double time = 0, slide = 0, rotation = 0;
  ASSERT_TRUE(first >> index >> time >> slide >> rotation) << first.str();
  EXPECT_EQ(index, 0);
  EXPECT_GE(time, begin - 1e-5);
  EXPECT_LE(time, std::min(hostTime(), begin + 0.1) + 1e-5);  // no further ahead
  EXPECT_NEAR(slide, positionOf(datagram.instruments[0].slide, time - begin), 2e-6);
  EXPECT_NEAR(rotation, positionOf(datagram.instruments[0].rotation, time - begin), 2e-5);
  std::istringstream second(receiver.line());
  std::string more;
  ASSERT_TRUE(second >> index >> time >> slide);
  EXPECT_FALSE(second >> more);
  EXPECT_EQ(index, 1);
  EXPECT_NEAR(slide, 0.05, 1e-6);
  std::istringstream third(receiver.line());
  ASSERT_TRUE(third >> index >> time >> more >> slide);
  EXPECT_EQ(more, "lost");
  EXPECT_EQ(slide, 2);
}

TEST(ReceiverExamples, TheOneInCppUnderstandsTheSender) {
  expectUnderstands(UDP_RECEIVER);
}

TEST(ReceiverExamples, TheOneInPythonUnderstandsTheSender) {
  expectUnderstands("../examples/udp_receiver.py");
}

}  // namespace
}  // namespace vibe::vision::receiver_examples_test
