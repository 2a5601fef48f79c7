#pragma once
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace vibe::hardware {

/// Writes when each blink of a hand happened and when the report that shows it left the device, as a table with the
/// columns `blink`, `event` and `report`: number from 0, and times of the wall clock [ns].
class BlinkLog {
 public:
  /// @param blinks  times of the hand [s], ascending
  /// @throws Error if the file cannot be written
  BlinkLog(const std::string& file, std::vector<double> blinks);

  /// A tick is over. @param hand  time of the hand at its end [s]  @param wall  the same time on the wall clock [ns]
  void tick(double hand, std::int64_t wall);
  /// A report has left the device. @param wall  [ns]
  void report(std::int64_t wall);

 private:
  std::string file_;
  std::ofstream out_;
  std::vector<double> blinks_;
  std::size_t next_ = 0, reported_ = 0;
  std::vector<std::int64_t> events_;
};

}  // namespace vibe::hardware
