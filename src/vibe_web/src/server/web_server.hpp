#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "operator/operator_seat.hpp"
#include "protocol/message_kind.hpp"
#include "server/access.hpp"
#include "server/page_files.hpp"

namespace vibe::web {

constexpr std::size_t kMaxClients = 24;      ///< pages with a stream
constexpr std::size_t kMaxConnections = 96;  ///< besides them
constexpr int kMaxCommands = 250;            ///< of a client in a second; one that sends more is let go

struct ServerOptions {
  /// Numeric; where the system has no IPv6, its own are passed over.
  std::vector<std::string> addresses{"127.0.0.1", "::1"};
  std::uint16_t port = 8890;     ///< 0: one that is free
  std::string page;              ///< folder with the built page
  std::string token, origin;     ///< see AccessRule
  std::string certificate, key;  ///< files for TLS; empty: without
};

/// Serves a page, and to each of its clients the newest message of each kind, with a thread of its own for all of
/// them. Nothing waits for a client: what it has not taken is replaced, so that a slow one sees fewer moments and holds
/// up neither the caller nor the others. Functions may be called from any thread.
class WebServer {
 public:
  using CommandHandler = std::function<void(ClientId, const Command&)>;  ///< in the thread of the server
  using LeaveHandler = std::function<void(ClientId)>;                    ///< the same

  /// @throws std::runtime_error  address or port cannot be had, or the certificate cannot be read
  WebServer(const ServerOptions& options, CommandHandler on_command, LeaveHandler on_leave);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// To all clients, and to those that come later.
  void publish(Kind kind, Bytes message);
  /// To one client; without effect if it is gone.
  void send(ClientId client, Kind kind, Bytes message);
  /// Answers requests of this path, beside the files of the page.
  void provide(const std::string& path, PageFile file);

  std::size_t clients() const;
  std::uint16_t port() const;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace vibe::web
