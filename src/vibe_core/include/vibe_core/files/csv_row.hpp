#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vibe {

// Rows of small tables that people write: commas between the cells, and no quotation marks.

/// Without the blanks, tabs and ends of lines around it. Refers to the same text.
std::string_view trimmed(std::string_view text);

/// The cells of a row, trimmed; one more than there are commas.
std::vector<std::string> cellsOf(std::string_view row);

/// All of a cell as a number with a decimal point, whatever the locale is; "+1", "nan" and "inf" are numbers, too.
/// Nothing if it is none, or no double holds it.
std::optional<double> numberOf(std::string_view cell);

}  // namespace vibe
