#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::vision {

/// What a recording knows about its frames, from a text file with one row per frame and commas between columns. The
/// first line names the columns: "stamp" (middle of the exposure, Unix time [s]) is needed, "sequence" and "exposure"
/// [s] may be there, others are ignored.
struct FrameTable {
  struct Row {
    std::uint64_t sequence = 0;
    double stamp = 0;
    double exposure = 0;
  };
  std::vector<Row> rows;
  std::string file;

  /// @param exposure  of all frames if the file does not say
  /// @throws Error with file, line and remedy: no such column, not a number, stamps or sequence that do not increase
  static FrameTable load(const std::string& file, double exposure);
};

}  // namespace vibe::vision
