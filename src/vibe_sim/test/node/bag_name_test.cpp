// Names of recordings that several programs want at the same moment: each has one of its own, and nothing is
// overwritten.
#include "recording/bag_name.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <set>
#include <vector>

#include "sentences.hpp"

namespace vibe::sim::bag_name_test {
namespace {

class BagName : public ::testing::Test {
 protected:
  std::string folder = ::testing::TempDir() + "vibe_bag_name_test";
  std::string file = folder + "/a.bag";

  BagName() {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  ~BagName() override { std::filesystem::remove_all(folder); }

  static void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string read(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(BagName, EightAtOnceHaveDifferentNames) {
  std::vector<std::future<std::string>> names;
  for (int k = 0; k < 8; ++k)
    names.push_back(std::async(std::launch::async, [this] {
      std::string name = claimFreeBag(file);
      write(name + ".active", name);
      finishBag(name);
      return name;
    }));
  std::set<std::string> different;
  for (auto& name : names) different.insert(name.get());
  EXPECT_EQ(different.size(), 8U);
  EXPECT_EQ(different.count(file) + different.count(folder + "/a-8.bag"), 2U);
  for (const std::string& name : different) EXPECT_EQ(read(name), name);
}

TEST_F(BagName, ANameIsGivenOnce) {
  int claimed = 0;
  std::vector<std::future<std::string>> sentences;
  for (int k = 0; k < 8; ++k)
    sentences.push_back(std::async(std::launch::async, [this] { return sentenceOf([this] { claimBag(file); }); }));
  for (auto& each : sentences) {
    const std::string sentence = each.get();
    claimed += sentence.empty();
    if (!sentence.empty()) expectMentions(sentence, "another program writes it, or one was killed");
  }
  EXPECT_EQ(claimed, 1);
}

TEST_F(BagName, NothingIsOverwritten) {
  write(file, "whole");
  expectMentions(sentenceOf([this] { claimBag(file); }), "is there already; give another path");
  EXPECT_EQ(claimFreeBag(file), folder + "/a-2.bag");
  write(folder + "/a-2.bag.active", "new");
  write(folder + "/a-2.bag", "somebody else's");
  expectMentions(sentenceOf([this] { finishBag(folder + "/a-2.bag"); }), "rename it by hand");
  EXPECT_EQ(read(folder + "/a-2.bag"), "somebody else's");
  EXPECT_EQ(read(folder + "/a-2.bag.active"), "new");
  expectMentions(sentenceOf([this] { claimBag(folder + "/none/a.bag"); }), "in a folder that is there");
}

}  // namespace
}  // namespace vibe::sim::bag_name_test
