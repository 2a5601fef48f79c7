#include "vibe_hardware/gamepad/pad_finder.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "gamepad/evdev_pad.hpp"

namespace vibe {
namespace {

namespace fs = std::filesystem;

/// Paths of event0, event1, ... in the order of their numbers.
std::vector<std::string> eventPaths(const std::string& folder) {
  std::vector<std::pair<long, std::string>> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool is_event = name.size() > 5 && name.size() < 12 && name.rfind("event", 0) == 0 &&
                          std::all_of(name.begin() + 5, name.end(), [](unsigned char c) { return std::isdigit(c); });
    if (is_event) found.emplace_back(std::stol(name.substr(5)), entry->path().string());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> paths;
  for (const auto& [number, path] : found) paths.push_back(path);
  return paths;
}

bool isWanted(const std::string& wanted, const libevdev& device, const std::string& path) {
  if (wanted.empty()) return isPad(device);
  const PadInfo info = infoOf(device, path);
  return info.name.find(wanted) != std::string::npos || info.phys.find(wanted) != std::string::npos;
}

std::unique_ptr<PadSource> openPath(const std::string& path, std::string& why) {
  EvdevDevice device = openEvdev(path);
  if (device.isOpen()) return std::make_unique<EvdevPad>(std::move(device), path);
  why = "The gamepad '" + path + "' " + device.problem + ".";
  return nullptr;
}

std::string explain(const std::string& wanted, const std::string& folder, std::size_t seen, std::size_t closed,
                    const std::string& problem) {
  std::string why =
      wanted.empty() ? "No gamepad found: " : "No device found with '" + wanted + "' in its name or phys: ";
  if (seen == 0) return why + "there is no input device in " + folder + ". Plug one in.";
  why += std::to_string(seen) + " input device" + (seen == 1 ? " in " : "s in ") + folder;
  why += wanted.empty() ? ", none of them with two axes and a button of a gamepad or joystick" : "";
  if (closed > 0) why += "; " + std::to_string(closed) + " of them " + problem;
  return why + ". Plug one in.";
}

}  // namespace

std::vector<PadListing> listInputDevices(const std::string& folder) {
  std::vector<PadListing> listings;
  for (const std::string& path : eventPaths(folder)) {
    PadListing listing;
    const EvdevDevice device = openEvdev(path);
    listing.info.path = path;
    listing.problem = device.problem;
    if (device.isOpen()) {
      listing.info = infoOf(*device.handle, path);
      listing.state = stateOf(*device.handle);
      listing.is_pad = isPad(*device.handle);
    }
    listings.push_back(listing);
  }
  return listings;
}

std::unique_ptr<PadSource> openPad(const std::string& wanted, std::string& why, const std::string& folder) {
  if (!wanted.empty() && wanted.front() == '/') return openPath(wanted, why);
  const std::vector<std::string> paths = eventPaths(folder);
  std::size_t closed = 0;
  std::string problem;
  for (const std::string& path : paths) {
    EvdevDevice device = openEvdev(path);
    if (device.isOpen() && isWanted(wanted, *device.handle, path))
      return std::make_unique<EvdevPad>(std::move(device), path);
    if (device.isOpen()) continue;
    ++closed;
    problem = device.problem;
  }
  why = explain(wanted, folder, paths.size(), closed, problem);
  return nullptr;
}

}  // namespace vibe
