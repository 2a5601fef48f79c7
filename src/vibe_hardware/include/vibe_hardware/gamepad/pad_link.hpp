#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// Looks for a pad until there is one, and again when it is gone.
class PadLink {
 public:
  /// Opens a pad, or returns null and says why in one sentence.
  using Open = std::function<std::unique_ptr<PadSource>(std::string& why)>;
  explicit PadLink(Open open) : open_(std::move(open)) {}

  /// Brings the pad up to date, or looks for one, twice a second. Never waits.
  /// @param now  steady time [s]
  /// @return one sentence when something has changed, and the first time that no pad is found; else empty
  std::string poll(double now);

  /// null: there is none at present
  PadSource* pad() const { return pad_.get(); }
  std::uint64_t connections() const { return connections_; }

 private:
  Open open_;
  std::unique_ptr<PadSource> pad_;
  double last_try_ = -1e9;  // [s]
  bool told_ = false;       // that there is none
  std::uint64_t connections_ = 0;

  std::string look(double now);
};

}  // namespace vibe::hardware
