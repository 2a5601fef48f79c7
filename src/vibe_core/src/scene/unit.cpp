#include "vibe_core/scene/unit.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "arithmetic/turn.hpp"
#include "scene/yaml_guard.hpp"
#include "vibe_core/files/number_text.hpp"

namespace vibe {
namespace {

constexpr Dimension kNone{};
constexpr Dimension kLength{1, 0, 0, 0};
constexpr Dimension kVolume{3, 0, 0, 0};
constexpr Dimension kMass{0, 1, 0, 0};
constexpr Dimension kTime{0, 0, 1, 0};
constexpr Dimension kRate{0, 0, -1, 0};
constexpr Dimension kForce{1, 1, -2, 0};
constexpr Dimension kPressure{-1, 1, -2, 0};
constexpr Dimension kEnergy{2, 1, -2, 0};
constexpr Dimension kPower{2, 1, -3, 0};
constexpr Dimension kAngle{0, 0, 0, 1};
constexpr Dimension kPixel{0, 0, 0, 0, 1};
constexpr Dimension kGrey{0, 0, 0, 0, 0, 1};

struct Symbol {
  const char* name;
  double factor;
  Dimension dimension;
};

constexpr Symbol kSymbols[] = {
    {"1", 1, kNone},
    {"%", 1e-2, kNone},
    {"m", 1, kLength},
    {"dm", 1e-1, kLength},
    {"cm", 1e-2, kLength},
    {"mm", 1e-3, kLength},
    {"um", 1e-6, kLength},
    {"µm", 1e-6, kLength},  // micro sign
    {"μm", 1e-6, kLength},  // Greek letter, which Unicode prefers
    {"in", 25.4e-3, kLength},
    {"L", 1e-3, kVolume},
    {"l", 1e-3, kVolume},
    {"dL", 1e-4, kVolume},
    {"mL", 1e-6, kVolume},
    {"ml", 1e-6, kVolume},
    {"kg", 1, kMass},
    {"g", 1e-3, kMass},
    {"mg", 1e-6, kMass},
    {"s", 1, kTime},
    {"ms", 1e-3, kTime},
    {"us", 1e-6, kTime},
    {"min", 60, kTime},
    {"h", 3600, kTime},
    {"Hz", 1, kRate},
    {"kHz", 1e3, kRate},
    {"N", 1, kForce},
    {"mN", 1e-3, kForce},
    {"kN", 1e3, kForce},
    {"Pa", 1, kPressure},
    {"hPa", 1e2, kPressure},
    {"kPa", 1e3, kPressure},
    {"MPa", 1e6, kPressure},
    {"bar", 1e5, kPressure},
    {"mbar", 1e2, kPressure},
    {"mmHg", 133.322387415, kPressure},
    {"J", 1, kEnergy},
    {"kJ", 1e3, kEnergy},
    {"W", 1, kPower},
    {"kW", 1e3, kPower},
    {"rad", 1, kAngle},
    {"mrad", 1e-3, kAngle},
    {"deg", kPi / 180, kAngle},
    {"turn", 2 * kPi, kAngle},
    {"turns", 2 * kPi, kAngle},
    {"cmH2O", 98.0665, kPressure},
    {"px", 1, kPixel},
    {"DN", 1, kGrey},
};

/// What the SI units of this project measure, for error messages.
struct Measure {
  const char* si_unit;
  const char* name;
  const char* examples;
};

constexpr Measure kMeasures[] = {
    {"1", "a pure number", "0.45 or 45 %"},
    {"m", "a length", "0.02 (m), 2 cm or 20 mm"},
    {"m^3", "a volume", "0.00075 (m^3), 0.75 L or 36 mL"},
    {"s", "a time", "0.0167 (s), 16.7 ms or 2 min"},
    {"1/s", "a rate", "30 (1/s), 30 1/s or 10 Hz"},
    {"kg", "a mass", "0.2 (kg) or 200 g"},
    {"kg/m^3", "a density", "1050 (kg/m^3) or 1.05 g/cm^3"},
    {"N", "a force", "8 (N), 8 N or 500 mN"},
    {"Pa", "a pressure", "1333 (Pa), 10 mmHg or 1.3 kPa"},
    {"Pa/m", "a stiffness per area", "5000 (Pa/m), 5 kPa/m or 5 N/cm^3"},
    {"m^3/s", "a flow", "5e-5 (m^3/s), 3 L/min or 50 mL/s"},
    {"m/s", "a speed", "0.02 (m/s), 2 cm/s or 20 mm/s"},
    {"m/s^2", "an acceleration", "-9.81 (m/s^2) or 9.81 N/kg"},
    {"J", "an energy", "25 (J) or 0.6 kJ"},
    {"N/m", "a stiffness", "2000 (N/m) or 2 N/mm"},
    {"N m^2", "a rigidity", "0.027 (N m^2) or 270 N cm^2"},
    {"N m/rad", "a rotational stiffness", "0.3 (N m/rad) or 5 N mm/deg"},
    {"W", "a power", "40 (W) or 40 W"},
    {"rad", "an angle", "1.57 (rad), 90 deg or 3 turns"},
    {"rad/s", "an angular speed", "0.5 (rad/s) or 30 deg/s"},
    {"1/m", "an inverse length", "0.5 (1/m) or 0.5 1/m"},
    {"px", "a length in the image", "364 (px) or 363.5 px"},
    {"px/m", "a scale of an image", "10000 (px/m) or 10 px/mm"},
    {"DN", "a grey value", "20 (DN) or 20 DN"},
};

const Symbol* findSymbol(std::string_view name) {
  for (const Symbol& symbol : kSymbols) {
    if (name == symbol.name) return &symbol;
  }
  return nullptr;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

/// "cm^3" -> the unit of cm, three times; sign -1 divides. False if it is not known.
bool multiplyFactor(std::string_view factor, int sign, Unit& unit) {
  factor = trim(factor);
  int power = 1;
  const std::size_t caret = factor.find('^');
  if (caret != std::string_view::npos) {
    const std::string_view digits = factor.substr(caret + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    if (error != std::errc() || end != digits.data() + digits.size() || power < -4 || power > 4) return false;
    factor = trim(factor.substr(0, caret));
  }
  const Symbol* symbol = findSymbol(factor);
  if (symbol == nullptr) return false;
  const int exponent = sign * power;
  for (int k = 0; k < std::abs(exponent); ++k) {
    unit.factor = exponent > 0 ? unit.factor * symbol->factor : unit.factor / symbol->factor;
  }
  unit.dimension.length += exponent * symbol->dimension.length;
  unit.dimension.mass += exponent * symbol->dimension.mass;
  unit.dimension.time += exponent * symbol->dimension.time;
  unit.dimension.angle += exponent * symbol->dimension.angle;
  unit.dimension.pixel += exponent * symbol->dimension.pixel;
  unit.dimension.grey += exponent * symbol->dimension.grey;
  return true;
}

/// "N / m" -> "N/m", "N m" -> "N*m": a space between two units multiplies them.
std::string withoutSpaces(std::string_view text) {
  const auto isSign = [](char c) { return c == '*' || c == '/' || c == '^'; };
  std::string joined;
  bool apart = false;
  for (const char c : trim(text)) {
    if (std::isspace(static_cast<unsigned char>(c))) {
      apart = true;
      continue;
    }
    if (apart && !isSign(c) && !isSign(joined.back())) joined += '*';
    apart = false;
    joined += c;
  }
  return joined;
}

const Measure* findMeasure(const Dimension& dimension) {
  for (const Measure& measure : kMeasures) {
    if (parseUnit(measure.si_unit)->dimension == dimension) return &measure;
  }
  return nullptr;
}

/// Splits "10 mmHg" after the number.
std::size_t numberLength(std::string_view text) {
  double value = 0;
  const std::size_t skip = !text.empty() && text.front() == '+' ? 1 : 0;
  const auto result = readReal(text.data() + skip, text.data() + text.size(), value);
  if (result.ec == std::errc::invalid_argument) return 0;
  return static_cast<std::size_t>(result.ptr - text.data());
}

bool isNotFinite(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  if (!text.empty() && text.front() == '.') text.remove_prefix(1);
  std::string word;
  for (const char c : text) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word.rfind("nan", 0) == 0 || word.rfind("inf", 0) == 0;
}

}  // namespace

bool operator==(const Dimension& a, const Dimension& b) {
  return a.length == b.length && a.mass == b.mass && a.time == b.time && a.angle == b.angle && a.pixel == b.pixel &&
         a.grey == b.grey;
}

std::optional<Unit> parseUnit(const std::string& written) {
  constexpr std::size_t kLongestUnit = 40;
  if (written.size() > kLongestUnit) return std::nullopt;
  const std::string text = withoutSpaces(written);
  Unit unit;
  int sign = 1;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find_first_of("*/", begin);
    const std::size_t length = end == std::string::npos ? std::string::npos : end - begin;
    if (!multiplyFactor(std::string_view(text).substr(begin, length), sign, unit)) return std::nullopt;
    if (end == std::string::npos) return unit;
    sign = text[end] == '/' ? -1 : 1;
    begin = end + 1;
  }
}

std::vector<std::pair<std::string, double>> knownLengths() {
  std::vector<std::pair<std::string, double>> lengths;
  for (const Symbol& symbol : kSymbols)
    if (symbol.dimension == kLength) lengths.emplace_back(symbol.name, symbol.factor);
  return lengths;
}

Quantity parseNumber(const std::string& text) {
  const std::string_view trimmed = trim(text);
  if (isNotFinite(trimmed)) return {0, "is not a finite number; write a finite one"};
  const std::size_t skip = trimmed.size() > 1 && trimmed.front() == '+' && trimmed[1] != '-' ? 1 : 0;
  double value = 0;
  const char* end = trimmed.data() + trimmed.size();
  const auto result = readReal(trimmed.data() + skip, end, value);
  if (result.ec == std::errc::result_out_of_range) return {0, "does not fit a double; write a number of sane size"};
  if (result.ec != std::errc() || result.ptr != end) return {0, "is not a number; write digits like 12 or 1.2e-3"};
  if (!std::isfinite(value)) return {0, "is not a finite number; write a finite one"};
  return {value, ""};
}

std::string describeQuantity(const std::string& si_unit) {
  for (const Measure& measure : kMeasures) {
    if (si_unit == measure.si_unit) return std::string(measure.name) + "; write for example " + measure.examples;
  }
  return "a value in " + si_unit;
}

Quantity parseQuantity(const std::string& text, const std::string& si_unit) {
  const std::string_view trimmed = trim(text);
  if (isNotFinite(trimmed)) return {0, "is not finite, it must be " + describeQuantity(si_unit)};
  const std::size_t split = numberLength(trimmed);
  if (split == 0) return {0, "is not a number, it must be " + describeQuantity(si_unit)};
  const Quantity number = parseNumber(std::string(trimmed.substr(0, split)));
  if (!number.problem.empty()) return number;
  const std::string unit_text(trim(trimmed.substr(split)));
  if (unit_text.empty()) return number;

  const std::optional<Unit> unit = parseUnit(unit_text);
  if (!unit)
    return {0, "has the unknown unit \"" + printable(unit_text, 20) + "\", it must be " + describeQuantity(si_unit)};
  if (unit->dimension != parseUnit(si_unit)->dimension) {
    const Measure* measure = findMeasure(unit->dimension);
    const std::string what = measure != nullptr ? std::string("is ") + measure->name : "has the unit " + unit_text;
    return {0, what + ", but it must be " + describeQuantity(si_unit)};
  }
  const double value = number.value * unit->factor;
  if (!std::isfinite(value)) return {0, "is too large; write a number of sane size"};
  return {value, ""};
}

}  // namespace vibe
