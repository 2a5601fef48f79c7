#pragma once
#include <string>
#include <vector>

#include "cosim_frame.hpp"

namespace vibe_firmware {

/// Replies of the firmware in a file, one after the other.
/// @throw std::runtime_error if the file cannot be written or read
void writeTrace(const std::string& file, const std::vector<CosimReply>& trace);
std::vector<CosimReply> readTrace(const std::string& file);

/// One sentence about the first difference between two traces; empty if there is none.
std::string firstDifference(const std::vector<CosimReply>& one, const std::vector<CosimReply>& other);

}  // namespace vibe_firmware
