#include "vibe_core/suture/technique_csv.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

using Fields = std::vector<std::string>;

std::string trimmed(const std::string& text) {
  const char* const kSpace = " \t\r\v\f";
  const std::size_t begin = text.find_first_not_of(kSpace);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

Fields split(const std::string& row) {
  Fields fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = row.find(',', begin);
    fields.push_back(trimmed(row.substr(begin, end - begin)));
    if (end == std::string::npos) return fields;
    begin = end + 1;
  }
}

bool toNumber(const std::string& text, double& value) {
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(begin, end, value);  // unlike strtod(), independent of the locale
  return fault == std::errc() && stop == end;
}

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  void take(std::string line) {
    if (++number_ == 1 && line.compare(0, 3, "\xef\xbb\xbf") == 0) line.erase(0, 3);  // byte order mark
    const bool blank = trimmed(line).empty();
    const std::string row = trimmed(line.substr(0, line.find('#')));
    if (!row.empty()) return takeRow(split(row));
    if (blank && !sets_.empty() && !sets_.back().empty()) sets_.emplace_back();
  }

  std::vector<std::vector<Eigen::Vector3d>> finish() {
    if (!sets_.empty() && sets_.back().empty()) sets_.pop_back();
    if (sets_.empty()) throw Error(name_ + " holds no bite; give it a row x,y,z per bite.");
    return std::move(sets_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ":" + std::to_string(number_) + ": " + what);
  }

  void takeRow(const Fields& fields) {
    const bool first = columns_.empty();
    if (first) {
      bool header = true;
      for (const std::string& field : fields)
        header =
            header && !field.empty() && std::isalpha(static_cast<unsigned char>(field[0])) != 0 && !isSpecial(field);
      column_count_ = header ? fields.size() : 3;
      columns_ = header ? namedColumns(fields) : std::vector<std::size_t>{0, 1, 2};
      if (header) return;
    }
    if (fields.size() != column_count_)
      fail("the row has " + std::to_string(fields.size()) + " columns instead of " + std::to_string(column_count_) +
           "; write x,y,z with commas between them.");
    if (sets_.empty()) sets_.emplace_back();
    sets_.back().push_back({number(fields, 0), number(fields, 1), number(fields, 2)});
  }

  /// "nan" and "infinity" begin with letters but are meant as numbers.
  static bool isSpecial(const std::string& field) {
    double value;
    return toNumber(field, value);
  }

  std::vector<std::size_t> namedColumns(const Fields& names) const {
    std::vector<std::size_t> columns;
    for (const char axis : {'x', 'y', 'z'}) {
      std::size_t found = names.size();
      for (std::size_t k = names.size(); k-- > 0;) {
        const bool alone = names[k].size() == 1 || std::isalnum(static_cast<unsigned char>(names[k][1])) == 0;
        if (alone && std::tolower(static_cast<unsigned char>(names[k][0])) == axis) found = k;
      }
      if (found == names.size()) fail(std::string("the header names no column '") + axis + "'; name x, y and z.");
      columns.push_back(found);
    }
    return columns;
  }

  double number(const Fields& fields, std::size_t axis) const {
    const std::string& text = fields[columns_[axis]];
    const std::string where = std::string(1, "xyz"[axis]) + " '" + text.substr(0, 40) + "'";
    double value;
    if (!toNumber(text, value)) fail(where + " is not a number; write it like 0.012 or 1.2e-2.");
    if (!std::isfinite(value)) fail(where + " is not finite; correct the position or leave the bite out.");
    return value;
  }

  std::string name_;
  std::size_t number_ = 0;
  std::vector<std::size_t> columns_;  // of x, y and z; empty before the first row
  std::size_t column_count_ = 3;
  std::vector<std::vector<Eigen::Vector3d>> sets_;
};

}  // namespace

std::vector<std::vector<Eigen::Vector3d>> readTechniqueCsv(std::istream& in, const std::string& name) {
  Reader reader(name);
  for (std::string line; std::getline(in, line);) reader.take(std::move(line));
  if (in.bad()) throw Error(name + " could not be read to its end; check that it is a file that you may read.");
  return reader.finish();
}

}  // namespace vibe
