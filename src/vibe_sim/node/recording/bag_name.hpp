#pragma once

#include <string>

namespace vibe::sim {

// The name of a bag while it is written, and when it is whole. Two programs that want the same name at the same moment
// never get it both, and no file is ever overwritten.

/// FILE.active is there, empty and ours.
/// @throws Error if FILE or FILE.active is there already, or the folder cannot be written to
void claimBag(const std::string& file);

/// As claimBag(), for the first free one of a.bag, a-2.bag, a-3.bag and so on.
/// @return its name
std::string claimFreeBag(const std::string& file);

/// FILE.active gets its name.
/// @throws Error if there is a file of that name by now, or it cannot be renamed
void finishBag(const std::string& file);

}  // namespace vibe::sim
