// SPDX-License-Identifier: MIT
#include "websocket/channel.hpp"

#include <utility>  // Boost 1.74 uses std::exchange without it
//
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>

namespace hapticd::websocket {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr size_t kMessageBytes = 64 * 1024, kHeadBytes = 8 * 1024;

/// Starts an operation and waits until it is finished. After the timeout the operation is cancelled.
template <class Start>
ErrorCode waitFor(asio::io_context& io, beast::tcp_stream& stream, int timeout_ms, Start start) {
  bool over = false;
  ErrorCode result;
  stream.expires_after(std::chrono::milliseconds(timeout_ms));
  start([&](ErrorCode error, auto&&...) { over = true, result = error; });
  io.restart();
  while (!over && io.run_one() > 0) {
  }
  stream.expires_never();
  return result;
}

class ChannelImpl final : public Channel {
 public:
  ChannelImpl() : stream_(io_) { prepare(); }

  Result<void> open(const std::string& host, unsigned short port, int timeout_ms) {
    tcp::resolver resolver(io_);
    ErrorCode error;
    const auto found = resolver.resolve(host, std::to_string(port), error);
    auto& tcp_stream = beast::get_lowest_layer(stream_);
    if (!error)
      error =
          waitFor(io_, tcp_stream, timeout_ms, [&](auto done) { tcp_stream.async_connect(found, std::move(done)); });
    if (!error) noDelay();
    if (!error)
      error = waitFor(io_, tcp_stream, timeout_ms, [&](auto done) {
        stream_.async_handshake(host + ":" + std::to_string(port), "/", std::move(done));
      });
    if (error) return Error{"ws://" + host + ":" + std::to_string(port) + ": " + error.message()};
    return {};
  }

  /// Accepts the new connection; returns false if it is refused.
  bool take(tcp::socket socket, int timeout_ms) {
    auto& tcp_stream = beast::get_lowest_layer(stream_);
    const int native = socket.release();
    ErrorCode error;
    tcp_stream.socket().assign(tcp::v4(), native, error);
    if (error) return false;
    noDelay();
    http::request_parser<http::empty_body> parser;
    parser.header_limit(kHeadBytes);
    error = waitFor(io_, tcp_stream, timeout_ms,
                    [&](auto done) { http::async_read(tcp_stream, buffer_, parser, std::move(done)); });
    if (error || !beast::websocket::is_upgrade(parser.get()) || !ofThisMachine(parser.get())) return false;
    buffer_.clear();
    error =
        waitFor(io_, tcp_stream, timeout_ms, [&](auto done) { stream_.async_accept(parser.get(), std::move(done)); });
    return !error;
  }

  Result<void> send(std::string_view text, int timeout_ms) override {
    const ErrorCode error = waitFor(io_, beast::get_lowest_layer(stream_), timeout_ms, [&](auto done) {
      stream_.async_write(asio::buffer(text.data(), text.size()), std::move(done));
    });
    if (error) return Error{error.message()};
    return {};
  }

  Result<std::string> receive(int timeout_ms) override {
    buffer_.clear();
    const ErrorCode error = waitFor(io_, beast::get_lowest_layer(stream_), timeout_ms,
                                    [&](auto done) { stream_.async_read(buffer_, std::move(done)); });
    if (error) return Error{error.message()};
    const auto bytes = buffer_.data();
    return std::string(static_cast<const char*>(bytes.data()), bytes.size());
  }

 private:
  void prepare() {
    stream_.read_message_max(kMessageBytes);
    stream_.auto_fragment(false);
    stream_.text(true);
  }
  void noDelay() {
    ErrorCode ignored;
    beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
  }
  static bool ofThisMachine(const http::request<http::empty_body>& request) {
    const auto origin = request[http::field::origin];
    if (origin.empty()) return true;  // the client is not a browser
    for (const char* own : {"http://localhost", "http://127.0.0.1"}) {
      const beast::string_view mine(own);
      if (origin.substr(0, mine.size()) != mine) continue;
      if (origin.size() == mine.size() || origin[mine.size()] == ':') return true;
    }
    return false;
  }

  asio::io_context io_;
  beast::websocket::stream<beast::tcp_stream, false> stream_;  // without compression: both ends are on this machine
  beast::flat_buffer buffer_;
};

class ListenerImpl final : public Listener {
 public:
  explicit ListenerImpl(unsigned short port) : acceptor_(io_, {asio::ip::address_v4::loopback(), port}) {}
  unsigned short port() const override { return acceptor_.local_endpoint().port(); }

  std::unique_ptr<Channel> accept(int timeout_ms) override {
    if (!asked_) {
      asked_ = true;
      acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) {
        asked_ = false;
        if (!error) came_.emplace(std::move(socket));
      });
    }
    io_.restart();
    io_.run_one_for(std::chrono::milliseconds(timeout_ms));
    if (!came_) return nullptr;
    auto channel = std::make_unique<ChannelImpl>();
    constexpr int kHandshakeMs = 2000;
    const bool taken = channel->take(std::move(*came_), kHandshakeMs);
    came_.reset();
    return taken ? std::move(channel) : nullptr;
  }

 private:
  asio::io_context io_;
  tcp::acceptor acceptor_;
  bool asked_ = false;
  std::optional<tcp::socket> came_;
};

}  // namespace

Result<std::unique_ptr<Channel>> Channel::connect(const std::string& host, unsigned short port, int timeout_ms) {
  auto channel = std::make_unique<ChannelImpl>();
  if (auto opened = channel->open(host, port, timeout_ms); !opened) return Error{opened.error()};
  return std::unique_ptr<Channel>(std::move(channel));
}

Result<std::unique_ptr<Listener>> Listener::listen(unsigned short port) {
  try {
    return std::unique_ptr<Listener>(std::make_unique<ListenerImpl>(port));
  } catch (const boost::system::system_error& error) {
    return Error{"cannot serve port " + std::to_string(port) + " of 127.0.0.1: " + error.code().message() +
                 "\n  fix: give another --port"};
  }
}

}  // namespace hapticd::websocket
