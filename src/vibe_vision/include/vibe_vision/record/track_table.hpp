#pragma once
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "vibe_core/files/files.hpp"
#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// Results as CSV: one row per frame and instrument. Columns: docs/vision.md, "Tracking recorded material".
class TrackTable {
 public:
  /// Writes the first line. The file is there once close() has been called. @throws Error if it cannot be written
  TrackTable(const std::string& file, const VisionConfig& config);
  /// Adds a row per instrument. @param measurements  in the order of the configuration
  void add(const Frame& frame, const Measurements& measurements);
  /// Writes what is left. @throws Error if the disk is full
  void close();

 private:
  WholeFile whole_;
  std::vector<std::string> names_;
  std::ofstream out_;  // of whole_, its part()
};

/// What became of the frames.
class TrackSummary {
 public:
  explicit TrackSummary(const VisionConfig& config);  ///< for its instruments
  /// @param seconds  of processor time that tracking this frame took
  void add(const Measurements& measurements, double seconds);
  std::uint64_t frames() const { return seconds_.size(); }  ///< added so far
  /// Lines for people: per instrument the share that was tracked and why the rest was not; time per frame.
  std::string text() const;

 private:
  struct Instrument {
    std::string name;
    std::uint64_t tracked = 0, reacquired = 0;
    std::map<Doubt, std::uint64_t> doubtful;  ///< measurements with each doubt
    std::map<LostReason, std::uint64_t> lost;
  };
  std::vector<Instrument> instruments_;
  std::vector<double> seconds_;
};

}  // namespace vibe::vision
