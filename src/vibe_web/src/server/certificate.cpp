#include "server/certificate.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace vibe::web {

namespace {

constexpr long kLife = 3650L * 24 * 3600;  // [s]

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + "; remove the folder of the certificate or make it writable.");
}

void closeFile(std::FILE* file) {
  std::fclose(file);
}

/// Not through an existing file or link.
Owned<std::FILE> newFile(const std::string& path, mode_t mode) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (descriptor < 0) fail("The file " + path + " cannot be made");
  return {::fdopen(descriptor, "w"), closeFile};
}

bool isNumeric(const std::string& name) {
  std::array<unsigned char, 16> address;
  return ::inet_pton(AF_INET, name.c_str(), address.data()) == 1 ||
         ::inet_pton(AF_INET6, name.c_str(), address.data()) == 1;
}

std::string alternativeNames(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names)
    list += (list.empty() ? "" : ",") + std::string(isNumeric(name) ? "IP:" : "DNS:") + name;
  return list;
}

void addExtension(X509* certificate, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const Owned<X509_EXTENSION> extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()),
                                        X509_EXTENSION_free);
  if (!extension || X509_add_ext(certificate, extension.get(), -1) != 1)
    fail("OpenSSL takes no names into a certificate");
}

Owned<X509> signedBy(EVP_PKEY* key, const std::vector<std::string>& names) {
  Owned<X509> certificate(X509_new(), X509_free);
  std::uint64_t serial = 1;
  if (RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) != 1)
    fail("The system gives no random numbers");
  X509_set_version(certificate.get(), 2);
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial >> 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -60);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), kLife);
  X509_set_pubkey(certificate.get(), key);
  X509_NAME* name = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>("ViBE for ROS"), -1, -1,
                             0);
  X509_set_issuer_name(certificate.get(), name);
  addExtension(certificate.get(), NID_subject_alt_name, alternativeNames(names));
  addExtension(certificate.get(), NID_basic_constraints, "critical,CA:FALSE");
  addExtension(certificate.get(), NID_ext_key_usage, "serverAuth");
  if (X509_sign(certificate.get(), key, EVP_sha256()) == 0) fail("OpenSSL does not sign the certificate");
  return certificate;
}

}  // namespace

CertificateFiles provideCertificate(const std::string& folder, const std::vector<std::string>& names) {
  const CertificateFiles files{folder + "/certificate.pem", folder + "/key.pem"};
  std::error_code error;
  if (std::filesystem::exists(files.certificate, error) && std::filesystem::exists(files.key, error)) return files;
  std::filesystem::create_directories(folder, error);
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  if (!key) fail("OpenSSL makes no key");
  const Owned<X509> certificate = signedBy(key.get(), names);
  const Owned<std::FILE> secret = newFile(files.key, 0600);
  if (PEM_write_PrivateKey(secret.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1)
    fail("The key cannot be written");
  const Owned<std::FILE> open = newFile(files.certificate, 0644);
  if (PEM_write_X509(open.get(), certificate.get()) != 1) fail("The certificate cannot be written");
  return files;
}

std::vector<std::string> networkAddresses() {
  std::vector<std::string> addresses;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return addresses;
  const Owned<ifaddrs> owned(all, ::freeifaddrs);
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET || (each->ifa_flags & IFF_LOOPBACK) != 0)
      continue;
    std::array<char, INET_ADDRSTRLEN> text;
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr)
      addresses.emplace_back(text.data());
  }
  return addresses;
}

std::string fingerprint(const std::string& certificate) {
  const Owned<std::FILE> file(std::fopen(certificate.c_str(), "r"), closeFile);
  if (!file) fail("The certificate " + certificate + " cannot be read");
  const Owned<X509> read(PEM_read_X509(file.get(), nullptr, nullptr, nullptr), X509_free);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  if (!read || X509_digest(read.get(), EVP_sha256(), digest.data(), &size) != 1)
    fail("The file " + certificate + " holds no certificate");
  std::string text;
  for (unsigned k = 0; k < size; ++k) {
    std::array<char, 4> pair;
    std::snprintf(pair.data(), pair.size(), k == 0 ? "%02X" : ":%02X", digest[k]);
    text += pair.data();
  }
  return text;
}

}  // namespace vibe::web
