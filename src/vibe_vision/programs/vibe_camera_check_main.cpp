#include <time.h>

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <vector>

#include "program_options.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_vision/camera/capture.hpp"

namespace vision = vibe::vision;

namespace {

struct Options {
  std::string source, csv;
  double duration = 5;
  vision::SourceOptions camera;
};

struct Times {
  std::uint64_t sequence = 0;
  double stamp = 0, arrival = 0, taken = 0;
};

double clockTime(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void printStage(const char* name, std::vector<double> delays) {
  std::sort(delays.begin(), delays.end());
  const auto at = [&](double share) {
    return 1e3 * delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))];
  };
  std::printf("%-34s min %7.3f  median %7.3f  p99 %7.3f  max %7.3f ms\n", name, at(0), at(0.5), at(0.99), at(1));
}

void printReport(const std::vector<Times>& times, const vision::Capture& capture, double cpu, bool recorded) {
  const vision::SourceStatistics s = capture.statistics();
  std::printf("frames %zu, lost %llu, incomplete %llu, unreadable %llu, dropped %llu, reconnections %llu\n",
              times.size(), static_cast<unsigned long long>(s.lost), static_cast<unsigned long long>(s.incomplete),
              static_cast<unsigned long long>(s.unreadable), static_cast<unsigned long long>(capture.dropped()),
              static_cast<unsigned long long>(s.reconnects));
  if (times.size() < 2) return;
  std::vector<double> arrival, take, total;
  for (const Times& t : times) {
    arrival.push_back(t.arrival - t.stamp);
    take.push_back(t.taken - t.arrival);
    total.push_back(t.taken - t.stamp);
  }
  const double span = times.back().stamp - times.front().stamp;
  std::printf("rate %.2f Hz, processor time %.3f ms per frame\n", static_cast<double>(times.size() - 1) / span,
              1e3 * cpu / static_cast<double>(times.size()));
  if (recorded) return;  // its stamps are from another time
  printStage("middle of exposure -> last packet", arrival);
  printStage("last packet -> consumer", take);
  printStage("middle of exposure -> consumer", total);
}

void writeTable(const std::string& file, const std::vector<Times>& times) {
  std::ostringstream table;
  table << std::setprecision(17) << "sequence,stamp,arrival,taken\n";
  for (const Times& t : times) table << t.sequence << ',' << t.stamp << ',' << t.arrival << ',' << t.taken << '\n';
  vibe::writeFile(file, table.str(), "The table");
}

bool check(const Options& options) {
  vision::Capture capture(vision::openSource(options.source, options.camera));
  std::vector<Times> times;
  std::string status;
  vision::Frame frame;
  const double end = clockTime(CLOCK_REALTIME) + options.duration;
  const double cpu = clockTime(CLOCK_PROCESS_CPUTIME_ID);
  vision::ReadResult result = vision::ReadResult::Timeout;
  while (result != vision::ReadResult::End && clockTime(CLOCK_REALTIME) < end) {
    result = capture.take(frame, 0.1);
    if (result == vision::ReadResult::Frame) {
      times.push_back({frame.sequence, frame.stamp, frame.arrival, clockTime(CLOCK_REALTIME)});
    }
    if (capture.status() == status) continue;
    status = capture.status();
    std::cout << status << std::endl;
  }
  printReport(times, capture, clockTime(CLOCK_PROCESS_CPUTIME_ID) - cpu, vision::isRecording(options.source));
  if (!options.csv.empty()) writeTable(options.csv, times);
  return !times.empty();
}

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line(
      "Opens a camera or a recording as the node does, and tells rate, lost frames and the delays of a camera. Ends\n"
      "with status 1 if no frame came.",
      "vibe_camera_check");
  Options options;
  line.option("source", options.source, "gige:ADDRESS, v4l2:/dev/video0, video:FILE or images:GLOB").required();
  line.option("--duration", options.duration, "time to look [s]").check(vibe::finiteIn(0.1, 1e5)).showDefault();
  line.option("--rate", options.camera.rate, "frames per second to ask for").showDefault();
  line.option("--exposure", options.camera.exposure, "exposure to ask for [s]").showDefault();
  line.option("--packet-size", options.camera.packet_size, "of GigE Vision [bytes]; 0: the largest that passes")
      .showDefault();
  line.option("--priority", options.camera.realtime_priority, "of the receiving thread, 1 to 99; 0: ordinary")
      .showDefault();
  line.flag("--paced", options.camera.paced, "recordings: in real time");
  line.option("--csv", options.csv, "file for sequence, stamp, arrival and taken [s] of each frame");
  return vibe::runProgram(line, argc, argv, [&options] { return check(options) ? 0 : 1; });
}
