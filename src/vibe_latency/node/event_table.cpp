#include "event_table.hpp"

#include <iomanip>

#include "vibe_core/common/error.hpp"

namespace vibe::latency {

EventTable::EventTable(const std::string& file, const std::string& columns) : file_(file), out_(file) {
  out_ << columns << '\n' << std::setprecision(17) << std::flush;
  check();
}

void EventTable::add(std::initializer_list<std::int64_t> numbers, std::initializer_list<double> values) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rows_.push_back({numbers, values});
}

void EventTable::flush() {
  std::vector<Row> rows;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    rows.swap(rows_);
  }
  for (const Row& row : rows) {
    const char* separator = "";
    for (const std::int64_t number : row.numbers) {
      out_ << separator << number;
      separator = ",";
    }
    for (const double value : row.values) out_ << ',' << value;
    out_ << '\n';
  }
  out_.flush();
  check();
}

void EventTable::check() {
  if (!out_) throw Error("Cannot write to '" + file_ + "'; check the folder and whether the disk is full.");
}

}  // namespace vibe::latency
