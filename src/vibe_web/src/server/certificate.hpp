#pragma once

#include <string>
#include <vector>

namespace vibe::web {

/// Files in PEM.
struct CertificateFiles {
  std::string certificate, key;
};

/// A certificate that nobody but this server signs, made in the folder if it is not there: browsers warn of it once and
/// then speak TLS, without which they offer no virtual reality. P-256, ten years; the key is readable by its owner
/// only.
/// @param names  host names and numeric addresses under which the server is reached
/// @throws std::runtime_error  the folder cannot be written, or OpenSSL fails
CertificateFiles provideCertificate(const std::string& folder, const std::vector<std::string>& names);

/// Numeric IPv4 addresses of this machine in networks, without loopback.
std::vector<std::string> networkAddresses();

/// SHA-256 of a certificate as colon-separated pairs, as browsers show it.
/// @throws std::runtime_error  it cannot be read
std::string fingerprint(const std::string& certificate);

}  // namespace vibe::web
