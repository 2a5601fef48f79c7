#include "vibe_operator/messages/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace vibe::operating {
namespace {

constexpr double kMaxPlain = 1e9;  // larger numbers are written with an exponent

std::string twoDigits(long value) {
  return (value < 10 ? "0" : "") + std::to_string(value);
}

}  // namespace

const char* const kNoValue = "\u2013";

std::string numberText(double value, int decimals) {
  if (!std::isfinite(value)) return kNoValue;
  const bool plain = std::abs(value) < kMaxPlain;
  std::ostringstream text;
  text.imbue(std::locale::classic());  // Qt may have set one that writes a comma
  text << (plain ? std::fixed : std::scientific) << std::setprecision(plain ? std::clamp(decimals, 0, 9) : 1) << value;
  const std::string number = text.str();
  return number.find_first_of("123456789") == std::string::npos && number[0] == '-' ? number.substr(1) : number;
}

std::string quantityText(double value, int decimals, const std::string& unit) {
  const std::string number = numberText(value, decimals);
  return std::isfinite(value) && !unit.empty() ? number + " " + unit : number;
}

std::string durationText(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0 || seconds >= kMaxPlain) return kNoValue;
  if (seconds < 59.95) return quantityText(seconds, 1, "s");
  const long whole = std::lround(seconds);
  const std::string last = twoDigits(whole % 60);
  if (whole < 3600) return std::to_string(whole / 60) + ":" + last;
  return std::to_string(whole / 3600) + ":" + twoDigits(whole / 60 % 60) + ":" + last;
}

std::string countText(unsigned long count, const std::string& singular) {
  return std::to_string(count) + " " + singular + (count == 1 ? "" : "s");
}

}  // namespace vibe::operating
