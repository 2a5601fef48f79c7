#include "server/web_server.hpp"

#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/connection.hpp"

namespace vibe::web {

class WebServer::Core {
 public:
  Core(const ServerOptions& options, CommandHandler on_command, LeaveHandler on_leave)
      : shared_(std::make_shared<Shared>()), acceptor_(io_), pause_(io_) {
    shared_->options = options;
    shared_->on_command = std::move(on_command);
    shared_->on_leave = std::move(on_leave);
    if (!options.certificate.empty()) readCertificate(options);
    listen(options);
    accept();
    thread_ = std::thread([this] { io_.run(); });
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

  void listen(const ServerOptions& options) {
    Error error;
    const asio::ip::tcp::endpoint here(asio::ip::make_address(options.address, error), options.port);
    if (!error) acceptor_.open(here.protocol(), error);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(here, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error)
      throw std::runtime_error("The port " + std::to_string(options.port) + " of " + options.address +
                               " cannot be had (" + error.message() + "); choose another one.");
    port_ = acceptor_.local_endpoint().port();
  }

  void accept() {
    acceptor_.async_accept([this](Error error, asio::ip::tcp::socket socket) {
      if (error) return acceptLater();                          // no more files, for instance
      socket.set_option(asio::ip::tcp::no_delay(true), error);  // a frame waits for nothing that was sent before
      if (shared_->connections < kMaxConnections) begin(std::move(socket));
      accept();
    });
  }

  void acceptLater() {
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](Error error) {
      if (!error) accept();
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
  asio::ip::tcp::acceptor acceptor_;
  asio::steady_timer pause_;
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
