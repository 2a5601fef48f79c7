#pragma once
#include <string>

namespace vibe::operating {

// Numbers for display, always with a decimal point whatever the locale. A value that is not finite is shown as a dash.

extern const char* const kNoValue;  ///< an en dash

/// "12.30"; never "-0.00". From 1e9 on "1.2e+09".
std::string numberText(double value, int decimals);

/// "12.30 mm"; only the number if the unit is empty, only the dash if there is no value.
std::string quantityText(double value, int decimals, const std::string& unit);

/// "7.5 s" below a minute, "3:07" (minutes and seconds) from a minute on, "1:02:07" from an hour on.
std::string durationText(double seconds);

/// "1 bite", "2 bites".
std::string countText(unsigned long count, const std::string& singular);

}  // namespace vibe::operating
