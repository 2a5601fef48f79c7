#include "server/certificate.hpp"

#include "server/host_names.hpp"

#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "vibe_core/files/files.hpp"

namespace vibe::web {

namespace {

constexpr long kDay = 24L * 3600;            // [s]
constexpr long kRootLife = 3650;             // [days]
constexpr long kLife = 397;                  // browsers take 398 at most [days]
constexpr long kRenewal = 30;                // before the end [days]
const char* const kIssuer = "ViBE for ROS";  // begins the name of the root, and was all of the name in 1.0.0

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

struct Pair {
  Owned<X509> certificate{nullptr, X509_free};
  Owned<EVP_PKEY> key{nullptr, EVP_PKEY_free};
  explicit operator bool() const { return certificate && key; }
};

struct PairFiles {
  std::string certificate, key;
};

void closeFile(std::FILE* file) {
  std::fclose(file);
}

/// A folder that one program at a time uses, so that two which start together have the same pair.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ >= 0) ::flock(descriptor_, LOCK_EX);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + "; choose another folder with _certificates:=, or make this one writable.");
}

[[noreturn]] void refuse(const PairFiles& files, const std::string& why) {
  throw std::runtime_error("The certificate " + files.certificate + " cannot be used (" + why +
                           "); remove it and its key " + files.key + ", and new ones are made.");
}

template <class T, class Read>
Owned<T> readFrom(const PairFiles& files, const std::string& path, Read read, void (*release)(T*), const char* what) {
  const Owned<std::FILE> file(std::fopen(path.c_str(), "re"), closeFile);
  if (!file) refuse(files, path + ": " + std::strerror(errno));
  Owned<T> found(read(file.get(), nullptr, nullptr, nullptr), release);
  if (!found) refuse(files, path + " holds no " + what);
  return found;
}

/// Empty where neither file is there.
Pair readPair(const PairFiles& files) {
  std::error_code error;
  if (!std::filesystem::exists(files.certificate, error) && !std::filesystem::exists(files.key, error) && !error)
    return {};
  Pair pair;
  pair.certificate = readFrom<X509>(files, files.certificate, PEM_read_X509, X509_free, "certificate");
  pair.key = readFrom<EVP_PKEY>(files, files.key, PEM_read_PrivateKey, EVP_PKEY_free, "key");
  const bool match = X509_check_private_key(pair.certificate.get(), pair.key.get()) == 1;
  ERR_clear_error();
  if (!match) refuse(files, "the key is that of another one");
  return pair;
}

/// Whole or not at all; nobody else can ever open what has mode 0600.
template <class Write>
void writeFile(const std::string& path, mode_t mode, Write write) {
  WholeFile whole(path, "The file");
  const std::string& part = whole.part();
  ::unlink(part.c_str());  // of a program that was killed; a file that is there would keep its mode
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  Owned<std::FILE> file(descriptor < 0 ? nullptr : ::fdopen(descriptor, "w"), closeFile);
  if (!file) fail("The file " + path + " cannot be written (" + std::strerror(errno) + ")");
  const bool written = write(file.get());
  whole.finish(std::fclose(file.release()) == 0 && written);
}

void writePair(const PairFiles& files, const Pair& pair, const X509* issuer) {
  writeFile(files.key, 0600, [&](std::FILE* file) {
    return PEM_write_PrivateKey(file, pair.key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1;
  });
  writeFile(files.certificate, 0644, [&](std::FILE* file) {
    return PEM_write_X509(file, pair.certificate.get()) == 1 &&
           (issuer == nullptr || PEM_write_X509(file, issuer) == 1);
  });
}

std::string alternativeNames(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    const Owned<ASN1_OCTET_STRING> address(a2i_IPADDRESS(name.c_str()), ASN1_OCTET_STRING_free);
    list += (list.empty() ? "" : ",") + std::string(address ? "IP:" : "DNS:") + name;
  }
  return list;
}

void addExtension(X509* certificate, X509* issuer, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Owned<X509_EXTENSION> extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()),
                                        X509_EXTENSION_free);
  if (!extension || X509_add_ext(certificate, extension.get(), -1) != 1)
    throw std::runtime_error("OpenSSL takes '" + value + "' into no certificate.");
}

std::uint64_t randomNumber() {
  std::uint64_t number = 1;
  if (RAND_bytes(reinterpret_cast<unsigned char*>(&number), sizeof number) != 1)
    throw std::runtime_error("The system gives no random numbers for a certificate.");
  return number >> 1;
}

/// A new key with a certificate that has all but its extensions and its signature.
Pair unsignedPair(const std::string& common_name, long days) {
  Pair pair;
  pair.key.reset(EVP_EC_gen("P-256"));
  pair.certificate.reset(X509_new());
  if (!pair) throw std::runtime_error("OpenSSL makes no key.");
  X509* certificate = pair.certificate.get();
  X509_set_version(certificate, 2);
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate), randomNumber());
  X509_gmtime_adj(X509_getm_notBefore(certificate), -3600);  // the clock of a phone may be late
  X509_gmtime_adj(X509_getm_notAfter(certificate), days * kDay - 3600);
  X509_set_pubkey(certificate, pair.key.get());
  X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate), "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(common_name.c_str()), -1, -1, 0);
  return pair;
}

void sign(X509* certificate, const Pair& issuer) {
  X509_set_issuer_name(certificate, X509_get_subject_name(issuer.certificate.get()));
  if (X509_sign(certificate, issuer.key.get(), EVP_sha256()) == 0)
    throw std::runtime_error("OpenSSL does not sign the certificate.");
}

Pair makeRoot() {
  // phones list it by its name, which X.509 limits to 64 characters
  Pair root = unsignedPair((kIssuer + std::string(", ") + hostNames().front()).substr(0, 64), kRootLife);
  X509* certificate = root.certificate.get();
  addExtension(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  addExtension(certificate, certificate, NID_key_usage, "critical,keyCertSign,cRLSign");
  addExtension(certificate, certificate, NID_subject_key_identifier, "hash");
  sign(certificate, root);
  return root;
}

Pair makeLeaf(const Pair& root, const std::vector<std::string>& names) {
  Pair leaf = unsignedPair(kIssuer, kLife);
  X509* certificate = leaf.certificate.get();
  X509* issuer = root.certificate.get();
  addExtension(certificate, issuer, NID_subject_alt_name, alternativeNames(names));
  addExtension(certificate, issuer, NID_basic_constraints, "critical,CA:FALSE");
  addExtension(certificate, issuer, NID_key_usage, "critical,digitalSignature");
  addExtension(certificate, issuer, NID_ext_key_usage, "serverAuth");
  addExtension(certificate, issuer, NID_subject_key_identifier, "hash");
  addExtension(certificate, issuer, NID_authority_key_identifier, "keyid");
  sign(certificate, root);
  return leaf;
}

bool endsWithin(const X509* certificate, long days) {
  std::time_t then = std::time(nullptr) + days * kDay;
  return X509_cmp_time(X509_get0_notAfter(certificate), &then) < 0;
}

bool hasName(X509* certificate, const std::string& name) {
  return X509_check_ip_asc(certificate, name.c_str(), 0) == 1 ||
         X509_check_host(certificate, name.c_str(), name.size(), 0, nullptr) == 1;
}

bool isOurs(const X509* certificate) {
  std::array<char, 80> name{};
  X509_NAME_get_text_by_NID(X509_get_issuer_name(certificate), NID_commonName, name.data(), name.size());
  return std::string(name.data()).rfind(kIssuer, 0) == 0;
}

bool isFit(X509* certificate, const Pair& root, const std::vector<std::string>& names) {
  return !endsWithin(certificate, kRenewal) && X509_verify(certificate, root.key.get()) == 1 &&
         std::all_of(names.begin(), names.end(), [&](const std::string& name) { return hasName(certificate, name); });
}

std::string derOf(const X509* certificate) {
  std::string der(static_cast<std::size_t>(i2d_X509(certificate, nullptr)), '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(der.data());
  i2d_X509(certificate, &bytes);
  return der;
}

}  // namespace

Certificates provideCertificates(const std::string& folder, const std::vector<std::string>& names) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const FolderLock alone(folder);
  const PairFiles of_root{folder + "/root.pem", folder + "/root_key.pem"};
  const PairFiles of_leaf{folder + "/certificate.pem", folder + "/key.pem"};
  Pair leaf = readPair(of_leaf);
  if (leaf && !isOurs(leaf.certificate.get())) {
    if (endsWithin(leaf.certificate.get(), 0)) refuse(of_leaf, "it has expired");
    return {of_leaf.certificate, of_leaf.key, derOf(leaf.certificate.get()), ""};
  }
  Pair root = readPair(of_root);
  if (!root || endsWithin(root.certificate.get(), kRenewal)) {
    root = makeRoot();
    writePair(of_root, root, nullptr);
  }
  if (!leaf || !isFit(leaf.certificate.get(), root, names)) {
    leaf = makeLeaf(root, names);
    writePair(of_leaf, leaf, root.certificate.get());
  }
  ERR_clear_error();
  return {of_leaf.certificate, of_leaf.key, derOf(leaf.certificate.get()), derOf(root.certificate.get())};
}

std::string fingerprint(const std::string& certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  EVP_Digest(certificate.data(), certificate.size(), digest.data(), &size, EVP_sha256(), nullptr);
  std::string text;
  for (unsigned k = 0; k < size; ++k) {
    std::array<char, 4> pair;
    std::snprintf(pair.data(), pair.size(), k == 0 ? "%02X" : ":%02X", digest[k]);
    text += pair.data();
  }
  return text;
}

}  // namespace vibe::web
