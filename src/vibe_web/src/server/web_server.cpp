#include "server/web_server.hpp"

#include <cstdio>
#include <deque>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/connection.hpp"

namespace vibe::web {

class WebServer::Core {
 public:
  Core(const ServerOptions& options, CommandHandler on_command, LeaveHandler on_leave)
      : shared_(std::make_shared<Shared>()) {
    shared_->options = options;
    shared_->on_command = std::move(on_command);
    shared_->on_leave = std::move(on_leave);
    if (!options.certificate.empty()) readCertificate(options);
    port_ = options.port;
    for (const std::string& address : options.addresses) listen(asio::ip::make_address(address));
    for (Door& door : doors_) accept(door);
    thread_ = std::thread([this] { serve(); });
  }

  ~Core() {
    io_.stop();
    thread_.join();
  }

  void publish(Kind kind, SharedBytes bytes) {
    asio::post(io_, [this, kind, bytes = std::move(bytes)] {
      shared_->newest[static_cast<std::size_t>(kind)] = bytes;
      // an offer may end a client, which leaves the list
      std::vector<std::function<void(Kind, SharedBytes)>> all;
      for (const auto& [id, offer] : shared_->clients) all.push_back(offer);
      for (const auto& offer : all) offer(kind, bytes);
    });
  }

  void send(ClientId client, Kind kind, SharedBytes bytes) {
    asio::post(io_, [this, client, kind, bytes = std::move(bytes)] {
      const auto found = shared_->clients.find(client);
      if (found != shared_->clients.end()) found->second(kind, bytes);
    });
  }

  void provide(const std::string& path, const PageFile& file) {
    asio::post(io_, [this, path, file] { shared_->provided[path] = file; });
  }

  std::size_t clients() const { return shared_->client_count; }
  std::uint16_t port() const { return port_; }

 private:
  /// What goes wrong with one request ends that connection, and nothing else.
  void serve() {
    for (;;) try {
        io_.run();
        return;
      } catch (const std::exception& error) {
        std::fprintf(stderr, "A connection of the page was given up: %s.\n", error.what());
      }
  }

  void readCertificate(const ServerOptions& options) {
    context_.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_sslv2 |
                         asio::ssl::context::no_sslv3 | asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1);
    Error error;
    context_.use_certificate_chain_file(options.certificate, error);
    if (!error) context_.use_private_key_file(options.key, asio::ssl::context::pem, error);
    if (error)
      throw std::runtime_error("The certificate " + options.certificate + " cannot be used (" + error.message() +
                               "); remove it and its key, and new ones are made.");
  }

  /// One of the addresses where the server listens.
  struct Door {
    asio::ip::tcp::acceptor acceptor;
    asio::steady_timer pause;
  };

  void listen(const asio::ip::address& address) {
    Error error;
    const asio::ip::tcp::endpoint here(address, port_);
    Door door{asio::ip::tcp::acceptor(io_), asio::steady_timer(io_)};
    door.acceptor.open(here.protocol(), error);
    if (!error) door.acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error && address.is_v6()) door.acceptor.set_option(asio::ip::v6_only(true), error);
    if (!error) door.acceptor.bind(here, error);
    if (address.is_v6() &&
        (error == asio::error::address_family_not_supported || error == boost::system::errc::address_not_available))
      return;
    if (!error) door.acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error)
      throw std::runtime_error("The port " + std::to_string(port_) + " of " + address.to_string() + " cannot be had (" +
                               error.message() + "); choose another one with _port:=, or with --port of scripts/run.");
    port_ = door.acceptor.local_endpoint().port();
    doors_.push_back(std::move(door));
  }

  void accept(Door& door) {
    door.acceptor.async_accept([this, &door](Error error, asio::ip::tcp::socket socket) {
      if (error) return acceptLater(door);                      // no more files, for instance
      socket.set_option(asio::ip::tcp::no_delay(true), error);  // a frame waits for nothing that was sent before
      accept(door);
      begin(std::move(socket));
    });
  }

  void acceptLater(Door& door) {
    door.pause.expires_after(std::chrono::milliseconds(100));
    door.pause.async_wait([this, &door](Error error) {
      if (!error) accept(door);
    });
  }

  void begin(asio::ip::tcp::socket&& socket) {
    if (shared_->options.certificate.empty())
      std::make_shared<Connection<beast::tcp_stream>>(std::move(socket), shared_)->run();
    else
      std::make_shared<Connection<beast::ssl_stream<beast::tcp_stream>>>(std::move(socket), shared_, context_)->run();
  }

  std::shared_ptr<Shared> shared_;  // before the context of events, whose connections use it as they go
  asio::ssl::context context_{asio::ssl::context::tls_server};
  asio::io_context io_{1};
  std::deque<Door> doors_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

WebServer::WebServer(const ServerOptions& options, CommandHandler on_command, LeaveHandler on_leave)
    : core_(std::make_unique<Core>(options, std::move(on_command), std::move(on_leave))) {}
WebServer::~WebServer() = default;

void WebServer::publish(Kind kind, Bytes message) {
  core_->publish(kind, std::make_shared<const Bytes>(std::move(message)));
}

void WebServer::send(ClientId client, Kind kind, Bytes message) {
  core_->send(client, kind, std::make_shared<const Bytes>(std::move(message)));
}

void WebServer::provide(const std::string& path, PageFile file) {
  core_->provide(path, file);
}

std::size_t WebServer::clients() const {
  return core_->clients();
}

std::uint16_t WebServer::port() const {
  return core_->port();
}

}  // namespace vibe::web
