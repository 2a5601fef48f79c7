#pragma once
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <mutex>
#include <string>
#include <vector>

namespace vibe::latency {

/// A table of times and values that grows while somebody measures: add() only copies, flush() writes.
class EventTable {
 public:
  /// @param columns  separated by commas
  /// @throws Error if the file cannot be written
  EventTable(const std::string& file, const std::string& columns);

  /// One row, from any thread: whole numbers first, such as times of the wall clock [ns], then real ones.
  void add(std::initializer_list<std::int64_t> numbers, std::initializer_list<double> values = {});
  /// Writes what has been added, from one thread. @throws Error if that fails
  void flush();

 private:
  struct Row {
    std::vector<std::int64_t> numbers;
    std::vector<double> values;
  };
  std::string file_;
  std::ofstream out_;
  std::mutex mutex_;
  std::vector<Row> rows_;

  void check();
};

}  // namespace vibe::latency
