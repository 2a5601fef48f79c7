#pragma once
#include <string>

namespace vibe {

/// Line (from 1) of the first tag of an XML text that is broken: an attribute without value or quotes, an end tag that
/// closes another element, an element that is never closed. 0 if all tags are in order. Says where, for parsers that
/// only say that.
int firstBrokenTagLine(const std::string& xml);

}  // namespace vibe
