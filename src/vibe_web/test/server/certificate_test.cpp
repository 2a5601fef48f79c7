#include "server/certificate.hpp"

#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <memory>

namespace vibe::web::certificate_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
const Names kNames{"192.168.1.20", "fd00::5", "lab", "lab.local"};

class Certificate : public ::testing::Test {
 protected:
  Certificate() {
    std::string name = (fs::temp_directory_path() / "vibe_certificate_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Certificate() override { fs::remove_all(folder_); }

  Certificates provide(const Names& names = kNames) const { return provideCertificates(folder_, names); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

  /// What OpenSSL's program does here; true when it succeeds.
  bool openssl(const std::string& words) const {
    return std::system(("cd " + folder_ + " && openssl " + words + " >/dev/null 2>&1").c_str()) == 0;
  }
  bool isTrustedAs(const std::string& name) const {
    return openssl("verify -x509_strict -purpose sslserver -CAfile root.pem " + name + " certificate.pem");
  }

  std::string refusal() const {
    try {
      provide();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  std::string folder_;
};

TEST_F(Certificate, IsTrustedByThoseWhoInstallTheRoot) {
  provide();
  for (const char* name : {"-verify_ip 192.168.1.20", "-verify_ip fd00::5", "-verify_hostname lab.local"})
    EXPECT_TRUE(isTrustedAs(name)) << name;
  EXPECT_FALSE(isTrustedAs("-verify_hostname evil.example"));
  EXPECT_TRUE(openssl("x509 -in certificate.pem -checkend " + std::to_string(390 * 24 * 3600)));
  EXPECT_FALSE(openssl("x509 -in certificate.pem -checkend " + std::to_string(398 * 24 * 3600)));
  for (const char* key : {"key.pem", "root_key.pem"})
    EXPECT_EQ(fs::status(path(key)).permissions(), fs::perms::owner_read | fs::perms::owner_write) << key;
}

TEST_F(Certificate, IsThereWholeOrNotAtAll) {
  write(".part-key.pem", "left by a program that was killed, and open to all");
  write(".part-certificate.pem", "the same");
  provide();
  EXPECT_TRUE(isTrustedAs("-verify_hostname lab"));
  EXPECT_EQ(fs::status(path("key.pem")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 4);
}

TEST_F(Certificate, OfProgramsThatStartTogetherIsTheSame) {
  std::array<std::future<std::string>, 4> leaves;
  for (auto& leaf : leaves) leaf = std::async(std::launch::async, [this] { return provide().leaf; });
  const std::string first = leaves[0].get();
  for (std::size_t k = 1; k < leaves.size(); ++k) EXPECT_EQ(leaves[k].get(), first);
}

TEST_F(Certificate, StaysAsLongAsItIsFit) {
  const Certificates first = provide();
  EXPECT_EQ(provide().leaf, first.leaf);
  EXPECT_EQ(provide({"lab"}).leaf, first.leaf);  // one network less
  const Certificates other = provide({"10.0.0.7"});
  EXPECT_NE(other.leaf, first.leaf);
  EXPECT_EQ(other.root, first.root);
  EXPECT_TRUE(isTrustedAs("-verify_ip 10.0.0.7"));
}

TEST_F(Certificate, IsRenewedBeforeItEnds) {
  const Certificates first = provide();
  const std::string request = "req -new -key key.pem -subj '/CN=ViBE for ROS' -out r.csr";
  const std::string names = "subjectAltName=IP:192.168.1.20,IP:fd00::5,DNS:lab,DNS:lab.local";
  write("names", names);
  for (const auto& [days, stays] : {std::pair{"40", true}, {"20", false}, {"-1", false}}) {
    ASSERT_TRUE(openssl(request) &&
                openssl("x509 -req -in r.csr -CA root.pem -CAkey root_key.pem -CAcreateserial -days " +
                        std::string(days) + " -extfile names -out certificate.pem"));
    const auto before = fs::file_size(path("certificate.pem"));
    const Certificates now = provide();
    EXPECT_EQ(fs::file_size(path("certificate.pem")) == before, stays) << days;
    EXPECT_EQ(now.root, first.root);
  }
}

TEST_F(Certificate, OfReleaseOneIsReplaced) {
  ASSERT_TRUE(
      openssl("req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj '/CN=ViBE for ROS' -days 3650 "
              "-keyout key.pem -out certificate.pem"));
  provide();
  EXPECT_TRUE(isTrustedAs("-verify_hostname lab"));
}

TEST_F(Certificate, OfSomebodyElseIsUsedUntilItEnds) {
  const std::string request =
      "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=lab.example -days 5 "
      "-keyout key.pem -out certificate.pem";
  ASSERT_TRUE(openssl(request));
  EXPECT_EQ(provide().root, "");
  EXPECT_FALSE(fs::exists(path("root.pem")));
  ASSERT_TRUE(openssl("req -new -key key.pem -subj /CN=lab.example -out r.csr") &&
              openssl("x509 -req -in r.csr -signkey key.pem -days -1 -out certificate.pem"));
  EXPECT_NE(refusal().find("it has expired"), std::string::npos) << refusal();
}

TEST_F(Certificate, WhoseFilesCannotBeUsedIsOneSentence) {
  const std::vector<std::pair<std::string, std::function<void()>>> harms{
      {"certificate.pem holds no certificate", [&] { write("certificate.pem", ""); }},
      {"certificate.pem holds no certificate", [&] { write("certificate.pem", "-----BEGIN CERTIFICATE-----\nMII"); }},
      {"key.pem holds no key", [&] { write("key.pem", "rubbish"); }},
      {"key.pem: No such file", [&] { fs::remove(path("key.pem")); }},
      {"certificate.pem: No such file", [&] { fs::remove(path("certificate.pem")); }},
      {"the key is that of another one", [&] { openssl("ecparam -genkey -name prime256v1 -noout -out key.pem"); }},
      {"root.pem holds no certificate", [&] { write("root.pem", "x"); }},
      {"root_key.pem: No such file", [&] { fs::remove(path("root_key.pem")); }}};
  for (const auto& [why, harm] : harms) {
    fs::remove_all(folder_);
    provide();
    EXPECT_EQ(refusal(), "");
    harm();
    const std::string said = refusal();
    EXPECT_NE(said.find(why), std::string::npos) << said;
    EXPECT_NE(said.find("; remove it and its key "), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace vibe::web::certificate_test
