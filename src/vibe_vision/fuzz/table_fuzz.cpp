// sources: src/camera/frame_table.cpp src/calibrate/stop_list.cpp ../vibe_core/src/scene/yaml_source.cpp
// sources: ../vibe_core/src/scene/yaml_guard.cpp ../vibe_core/src/scene/unit.cpp ../vibe_core/src/scene/words.cpp
// sources: ../vibe_core/src/files/files.cpp ../vibe_core/src/files/foreign_content.cpp
// sources: ../vibe_core/src/files/number_text.cpp ../vibe_core/src/files/csv_row.cpp
// includes: ../vibe_core/src
// packages: yaml-cpp
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "camera/frame_table.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/calibrate/stop_list.hpp"

// Any text as a table of frames and as a list of stops: an Error with its sentence, or rows with finite numbers.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void readFrames(const std::string& text) {
  const int file = memfd_create("table", 0);
  require(file >= 0 && write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  try {
    const vibe::vision::FrameTable table =
        vibe::vision::FrameTable::load("/proc/self/fd/" + std::to_string(file), 1e-3);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      require(std::isfinite(table.rows[i].stamp) && std::isfinite(table.rows[i].exposure));
      require(i == 0 || table.rows[i].stamp > table.rows[i - 1].stamp);
    }
  } catch (const vibe::Error& error) {
    require(error.what()[0] != '\0');
  }
  close(file);
}

void readStops(const std::string& text) {
  try {
    const std::vector<vibe::vision::StopImage> stops = vibe::vision::parseStopList(text, "folder/stops.csv");
    require(!stops.empty());
    for (const vibe::vision::StopImage& stop : stops) require(std::abs(stop.slide) <= 1 && !stop.image.empty());
  } catch (const vibe::Error& error) {
    require(error.what()[0] != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  readFrames(text);
  readFrames("sequence,stamp,exposure\n1,0.5,0.001\n" + text);
  readStops(text);
  readStops("image,slide\na.png,5 mm\n" + text);
  return 0;
}
