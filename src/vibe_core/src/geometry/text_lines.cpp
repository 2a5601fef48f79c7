#include "geometry/text_lines.hpp"

#include <cctype>
#include <cmath>
#include <limits>

#include "vibe_core/files/number_text.hpp"

namespace vibe {

namespace {

constexpr std::string_view kBlanks = " \t\v\f";
constexpr std::size_t kLongestShown = 30;

}  // namespace

std::string lowered(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<double> realOf(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = readReal(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error != std::errc::result_out_of_range) return value;
  const bool tiny = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
  return tiny ? 0 : std::copysign(std::numeric_limits<double>::infinity(), word[0] == '-' ? -1.0 : 1.0);
}

std::string noNumber(int line, std::string_view word) {
  const std::string what = "line " + std::to_string(line) + ": " + shown(word) + " is not a number";
  std::string point(word);
  std::replace(point.begin(), point.end(), ',', '.');
  if (word.find(',') != std::string_view::npos && realOf(point))
    return what + " of this format, which has a decimal point; write the file with points in the place of commas";
  return what + "; correct the line, or write the file anew";
}

std::string shown(std::string_view word) {
  std::string text(word.substr(0, kLongestShown));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return "'" + text + (word.size() > kLongestShown ? "...'" : "'");
}

}  // namespace vibe
