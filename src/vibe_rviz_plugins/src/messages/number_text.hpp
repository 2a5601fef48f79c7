#pragma once
#include <string>

namespace vibe {

// Numbers as a person reads them, always with a decimal point whatever the locale. What is not finite has no value and
// is told by a dash.

extern const char* const kNoValue;  ///< an en dash

/// "12.30"; never "-0.00". From a milliard on "1.2e+09".
std::string numberText(double value, int decimals);

/// "12.30 mm"; without a unit only the number, without a value only the dash.
std::string quantityText(double value, int decimals, const std::string& unit);

/// "7.5 s" below a minute, "3:07" (minutes and seconds) from there on, "1:02:07" from an hour on.
std::string durationText(double seconds);

/// "1 bite", "2 bites".
std::string countText(unsigned long count, const std::string& singular);

}  // namespace vibe
