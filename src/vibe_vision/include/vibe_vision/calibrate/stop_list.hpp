#pragma once
#include <string>
#include <vector>

namespace vibe::vision {

/// An image that was taken while the instrument stood at a known slide.
struct StopImage {
  std::string image;  ///< path; relative ones are relative to the folder of the list
  double slide = 0;   ///< [m]
  int line = 0;       ///< of the list, from 1
};

/// Reads a CSV file whose first line is "image,slide"; slides are in metres or have a unit of length, "5 mm". Empty
/// lines and lines that begin with # are left out.
/// @throws Error with file, line and remedy
std::vector<StopImage> loadStopList(const std::string& file);
/// @param place  what to call the text in errors; its folder is where relative paths start
std::vector<StopImage> parseStopList(const std::string& text, const std::string& place);

}  // namespace vibe::vision
