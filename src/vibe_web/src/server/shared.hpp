#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <string>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include "server/guests.hpp"
#include "server/web_server.hpp"

namespace vibe::web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;
using Error = beast::error_code;
using Request = http::request<http::empty_body>;

constexpr auto kReadTimeout = std::chrono::seconds(10);  ///< for a request, an answer or a handshake

/// What a server and its connections share. All of it belongs to the thread of the server.
struct Shared {
  ServerOptions options;
  WebServer::CommandHandler on_command;
  WebServer::LeaveHandler on_leave;
  std::array<SharedBytes, kKinds> newest;
  std::map<std::string, PageFile> provided;
  std::map<ClientId, std::function<void(Kind, SharedBytes)>> clients;
  std::atomic<std::size_t> client_count{0};
  Guests guests{kMaxConnections};
  ClientId last_id = 0;

  AccessRule rule() const { return {options.token, !options.certificate.empty(), options.origin}; }
};

}  // namespace vibe::web
