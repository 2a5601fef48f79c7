// The main function of every test program. --only_file=NAME_test.cpp runs the cases of this file alone: ctest knows one
// test per file, whatever program it is in. A --gtest_filter is stronger.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace {

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Calls visit(full name, file) for every case of the program.
template <class Visit>
void visitCases(Visit visit) {
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      visit(std::string(suite.name()) + '.' + test.name(), std::string(test.file()));
    }
  }
}

/// The cases of a file, as a filter of gtest; empty if there are none, or if a case stands in a file that is no test:
/// it would run with no file.
std::string filterOf(const std::string& file) {
  std::string filter;
  bool lost = false;
  visitCases([&](const std::string& name, const std::string& place) {
    if (endsWith(place, '/' + file)) filter += name + ':';
    if (endsWith(place, "_test.cpp")) return;
    std::fprintf(stderr, "%s stands in %s, and would never run: cases belong into files *_test.cpp\n", name.c_str(),
                 place.c_str());
    lost = true;
  });
  if (filter.empty()) std::fprintf(stderr, "there is no case in %s\n", file.c_str());
  return lost ? "" : filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const std::string option = "--only_file=";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.compare(0, option.size(), option) != 0 || GTEST_FLAG_GET(filter) != "*") continue;
    const std::string filter = filterOf(word.substr(option.size()));
    if (filter.empty()) return 2;
    GTEST_FLAG_SET(filter, filter);
  }
  return RUN_ALL_TESTS();
}
