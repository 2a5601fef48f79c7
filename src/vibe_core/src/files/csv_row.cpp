#include "vibe_core/files/csv_row.hpp"

#include "vibe_core/files/number_text.hpp"

namespace vibe {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string> cellsOf(std::string_view row) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = row.find(',', begin);
    cells.emplace_back(trimmed(row.substr(begin, end - begin)));
    if (end == std::string_view::npos) return cells;
    begin = end + 1;
  }
}

std::optional<double> numberOf(std::string_view cell) {
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);  // which readReal() does not take
  double value = 0;
  const auto [end, error] = readReal(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

}  // namespace vibe
