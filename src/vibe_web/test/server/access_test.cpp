#include "server/access.hpp"

#include <gtest/gtest.h>

#include "server/page_files.hpp"

namespace vibe::web::access_test {
namespace {

const AccessRule kLocal, kLan{"0123456789abcdef", true, ""};

TEST(Access, OfThisMachineNeedsNoTokenButItsName) {
  for (const char* host : {"localhost", "localhost:8890", "127.0.0.1:8890", "[::1]:8890", "[::1]"}) {
    EXPECT_EQ(streamRefusal(kLocal, {host, "", "/stream"}), "") << host;
    EXPECT_EQ(streamRefusal(kLocal, {host, "http://" + std::string(host), "/stream"}), "") << host;
  }
  for (const char* host :
       {"", "evil.example", "127.0.0.1.evil.example:8890", "localhost.evil.example", "192.168.1.5:8890"})
    EXPECT_NE(streamRefusal(kLocal, {host, "", "/stream"}), "") << host;
}

TEST(Access, OfPagesOfOtherServersIsRefused) {
  for (const char* origin : {"http://evil.example", "http://localhost:8891", "https://localhost:8890", "null"})
    EXPECT_NE(streamRefusal(kLocal, {"localhost:8890", origin, "/stream"}), "") << origin;
  const std::string target = "/stream?token=" + kLan.token;
  EXPECT_EQ(streamRefusal(kLan, {"10.0.0.2:8890", "https://10.0.0.2:8890", target}), "");
  EXPECT_NE(streamRefusal(kLan, {"10.0.0.2:8890", "http://10.0.0.2:8890", target}), "");
}

TEST(Access, OfAProxyIsThatOfItsAddressAlone) {
  const AccessRule rule{kLan.token, false, "https://lab.example"};
  for (const char* host : {"lab.example", "127.0.0.1:8890"})
    for (const auto& [origin, good] : {std::pair{"https://lab.example", true},
                                       {"http://lab.example", host[0] == 'l'},  // its own, as far as it knows
                                       {"https://lab.example.evil", false},
                                       {"https://evil.example", false}})
      EXPECT_EQ(streamRefusal(rule, {host, origin, "/stream?token=" + rule.token}).empty(), good) << host << origin;
  EXPECT_NE(streamRefusal(rule, {"lab.example", "https://lab.example", "/stream"}), "");
}

TEST(Access, OfTheNetworkNeedsTheToken) {
  const auto refusal = [](const std::string& query) {
    return streamRefusal(kLan, {"lab:8890", "", "/stream" + query});
  };
  EXPECT_EQ(refusal("?token=" + kLan.token), "");
  EXPECT_EQ(refusal("?rate=3&token=" + kLan.token), "");
  for (const std::string query : {"", "?token=", "?token=0123456789abcdee", "?token=0123456789abcdef0",
                                  "?xtoken=0123456789abcdef", "?token=0123456789abcde"})
    EXPECT_NE(refusal(query), "") << query;
}

TEST(Access, TokensDiffer) {
  EXPECT_EQ(makeToken().size(), 32U);
  EXPECT_NE(makeToken(), makeToken());
}

TEST(PageFiles, NothingOutsideOfTheFolderIsServed) {
  const std::string folder = ".";  // of the tests
  EXPECT_TRUE(readPageFile(folder, "/server/access_test.cpp", false).content);
  for (const char* path : {"/../CMakeLists.txt", "/server/../../CMakeLists.txt", "//etc/passwd", "/server/",
                           "server/access_test.cpp", "/%2e%2e/CMakeLists.txt", "/.hidden", "/none.js", ""})
    EXPECT_FALSE(readPageFile(folder, path, false).content) << path;
}

}  // namespace
}  // namespace vibe::web::access_test
