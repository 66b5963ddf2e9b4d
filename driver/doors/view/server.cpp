// SPDX-License-Identifier: MIT
#include "server.hpp"

#include <utility>  // Boost 1.74 uses std::exchange without it
//
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <list>
#include <optional>
#include <set>
#include <vector>

namespace hapticd::view {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr size_t kHeadBytes = 8 * 1024, kRequestBytes = 64 * 1024, kMostUnread = 32;
constexpr std::chrono::seconds kHeadPatience(10), kIdle(30);

/// The content security policy: only scripts and styles of this server, no inline code, no eval(), no other sources.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

using Request = http::request<http::empty_body>;
using Response = http::response<http::span_body<const char>>;

std::string text(beast::string_view view) {
  return {view.data(), view.size()};
}

RequestHead headOf(const Request& request) {
  RequestHead head;
  head.host = text(request[http::field::host]);
  head.origin = text(request[http::field::origin]);
  head.cookie = text(request[http::field::cookie]);
  head.protocols = text(request[http::field::sec_websocket_protocol]);
  head.target = text(request.target());
  head.upgrade = websocket::is_upgrade(request);
  return head;
}

class ServerImpl;
class Socket;
class Connection;

/// The open connections. Each connection shares the ownership of this register, because connections that are still open
/// at the end outlive the server: they end with the io_context.
struct Register {
  std::set<Socket*> sockets;
  std::list<Connection*> silent;  ///< connections whose request has not come yet; the first waits longest
  size_t connections = 0;

  /// Makes room for one more connection, if need be by ending the one that is silent longest. Returns false if none is.
  bool makeRoom();
};

/// One WebSocket with its conversation. Messages are sent one after the other.
class Socket final : public Peer, public std::enable_shared_from_this<Socket> {
 public:
  Socket(beast::tcp_stream stream, ServerImpl& server);
  ~Socket() override;
  void open(Request request, const Admission& admission);

  void text(std::string json) override { queue(std::make_shared<const std::string>(std::move(json)), true); }
  void binary(Message bytes) override { queue(std::move(bytes), false); }
  bool idle() const override { return waiting_.empty(); }
  void tick() {
    if (conversation_) conversation_->onTick();
  }
  /// Destroys the conversation.
  void endConversation() { conversation_.reset(); }

 private:
  void onOpen(Subprotocol protocol);
  void read();
  void onRead(ErrorCode error);
  void queue(Message bytes, bool text);
  void write();
  void end();

  struct Outgoing {
    Message bytes;
    bool text;
  };
  websocket::stream<beast::tcp_stream, false> stream_;  ///< without compression: rows are for this machine
  ServerImpl& server_;
  std::shared_ptr<Register> register_;
  Request request_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> waiting_;  ///< the first message is being sent
  size_t waiting_bytes_ = 0;
  bool ended_ = false, paused_ = false;
  std::unique_ptr<PeerSession> conversation_;
};

/// One HTTP connection: it answers requests until it becomes a WebSocket.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, ServerImpl& server);
  ~Connection();
  void read();
  void end() { stream_.close(); }  ///< it is destroyed after its last pending operation

 private:
  void onRead(ErrorCode error);
  void answer(const Admission& admission);
  void refuse(unsigned status, const std::string& why);
  void send();

  beast::tcp_stream stream_;
  ServerImpl& server_;
  std::shared_ptr<Register> register_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
  std::string body_;
};

bool Register::makeRoom() {
  if (connections < Server::kMostConnections) return true;
  if (silent.empty()) return false;
  silent.front()->end();
  silent.pop_front();
  return true;
}

class ServerImpl final : public Server {
 public:
  ServerImpl(asio::io_context& io, tcp::acceptor v4, Converse converse)
      : v4_(std::move(v4)), v6_(io), access_policy_(v4_.local_endpoint().port()), converse_(std::move(converse)) {}

  std::string url() const override {
    return "http://127.0.0.1:" + std::to_string(v4_.local_endpoint().port()) + "/?token=" + access_policy_.token();
  }
  ~ServerImpl() override {
    for (Socket* socket : register_->sockets) socket->endConversation();
  }
  size_t sockets() const override { return register_->sockets.size(); }
  void tick() override {
    const std::set<Socket*>& sockets = register_->sockets;
    for (Socket* socket : std::vector<Socket*>(sockets.begin(), sockets.end())) socket->tick();
  }

  void start() {
    bindV6();
    accept(v4_);
    if (v6_.is_open()) accept(v6_);
  }
  const AccessPolicy& accessPolicy() const { return access_policy_; }
  const Converse& startSession() const { return converse_; }
  bool full() const { return sockets() >= kMostSockets; }
  const std::shared_ptr<Register>& connected() const { return register_; }

 private:
  /// Binds the same port of ::1, for browsers that resolve "localhost" to it. Without IPv6 it is left out.
  void bindV6() {
    ErrorCode error;
    const tcp::endpoint endpoint(asio::ip::address_v6::loopback(), v4_.local_endpoint().port());
    v6_.open(endpoint.protocol(), error);
    if (!error) v6_.set_option(asio::ip::v6_only(true), error);
    if (!error) v6_.bind(endpoint, error);
    if (!error) v6_.listen(asio::socket_base::max_listen_connections, error);
    if (error) v6_.close(error);
  }

  void accept(tcp::acceptor& acceptor) {
    acceptor.async_accept([this, &acceptor](ErrorCode error, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (!error && register_->makeRoom()) std::make_shared<Connection>(std::move(socket), *this)->read();
      if (!error) return accept(acceptor);
      // waits before it accepts again, because there may be no free descriptor
      auto timer = std::make_shared<asio::steady_timer>(acceptor.get_executor(), std::chrono::milliseconds(500));
      timer->async_wait([this, &acceptor, timer](ErrorCode) { accept(acceptor); });
    });
  }

  tcp::acceptor v4_, v6_;
  AccessPolicy access_policy_;
  Converse converse_;
  std::shared_ptr<Register> register_ = std::make_shared<Register>();
};

Connection::Connection(tcp::socket socket, ServerImpl& server)
    : stream_(std::move(socket)), server_(server), register_(server.connected()) {
  ++register_->connections;
}

Connection::~Connection() {
  register_->silent.remove(this);
  --register_->connections;
}

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(kHeadBytes);
  parser_->body_limit(0);
  stream_.expires_after(kHeadPatience);
  register_->silent.push_back(this);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](ErrorCode error, size_t) { self->onRead(error); });
}

void Connection::onRead(ErrorCode error) {
  register_->silent.remove(this);
  if (error == http::error::header_limit)
    return refuse(431, "the head of the request is larger than 8 KiB, expected less");
  if (error == http::error::body_limit) return refuse(413, "the request has a body, expected none");
  if (error.category() == make_error_code(http::error::bad_method).category() && error != http::error::end_of_stream)
    return refuse(400, "the request is not HTTP");
  if (error) return;  // the client is gone, or too slow: the socket closes with this object
  const RequestHead head = headOf(parser_->get());
  const Admission admission = server_.accessPolicy().check(head);
  if (admission.status != 200) return refuse(admission.status, admission.why);
  if (!head.upgrade) return answer(admission);
  if (server_.full()) return refuse(503, "8 pages are open, which is the limit: close one of them");
  stream_.expires_never();
  std::make_shared<Socket>(std::move(stream_), server_)->open(parser_->release(), admission);
}

void Connection::answer(const Admission& admission) {
  const Request& request = parser_->get();
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return refuse(405, "this method is not served, expected GET or HEAD");
  const Asset asset = assetOf(pathOf(text(request.target())));
  if (asset.bytes.empty()) return refuse(404, "there is no such file");
  response_ = Response(http::status::ok, request.version());
  response_.set(http::field::content_type, text({asset.type.data(), asset.type.size()}));
  if (admission.give_cookie) response_.set(http::field::set_cookie, server_.accessPolicy().cookie());
  response_.body() = {asset.bytes.data(), asset.bytes.size()};
  response_.keep_alive(request.keep_alive());
  send();
}

void Connection::refuse(unsigned status, const std::string& why) {
  body_ = why + "\n";
  response_ = Response(http::status(status), 11);
  response_.set(http::field::content_type, "text/plain; charset=utf-8");
  response_.body() = {body_.data(), body_.size()};
  response_.keep_alive(false);
  send();
}

void Connection::send() {
  response_.set("Content-Security-Policy", kPolicy);
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.set("Cross-Origin-Opener-Policy", "same-origin");
  response_.set("Referrer-Policy", "no-referrer");
  response_.set(http::field::cache_control, "no-store");
  response_.prepare_payload();
  const bool head_only = parser_->is_header_done() && parser_->get().method() == http::verb::head;
  if (head_only) response_.body() = {};  // the head keeps its length
  stream_.expires_after(kIdle);
  http::async_write(stream_, response_, [self = shared_from_this()](ErrorCode error, size_t) {
    if (!error && self->response_.keep_alive()) return self->read();
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
  });
}

Socket::Socket(beast::tcp_stream stream, ServerImpl& server)
    : stream_(std::move(stream)), server_(server), register_(server.connected()) {
  ++register_->connections;
  register_->sockets.insert(this);
}

Socket::~Socket() {
  register_->sockets.erase(this);
  --register_->connections;
}

void Socket::open(Request request, const Admission& admission) {
  request_ = std::move(request);
  stream_.set_option(websocket::stream_base::timeout{kHeadPatience, kIdle, true});
  stream_.set_option(websocket::stream_base::decorator(
      [name = admission.protocol_name](auto& response) { response.set(http::field::sec_websocket_protocol, name); }));
  stream_.read_message_max(kRequestBytes);
  stream_.auto_fragment(false);
  beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true));
  stream_.async_accept(request_, [self = shared_from_this(), protocol = admission.protocol](ErrorCode error) {
    if (!error) self->onOpen(protocol);
  });
}

void Socket::onOpen(Subprotocol protocol) {
  conversation_ = server_.startSession()(protocol, *this);
  read();
}

void Socket::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, size_t) { self->onRead(error); });
}

void Socket::onRead(ErrorCode error) {
  if (error) return end();
  const auto bytes = buffer_.data();
  const auto* data = static_cast<const char*>(bytes.data());
  if (stream_.got_text())
    conversation_->onText({data, bytes.size()});
  else
    conversation_->onBinary(std::as_bytes(std::span(data, bytes.size())));
  buffer_.consume(buffer_.size());
  paused_ = waiting_.size() > kMostUnread;  // no more requests are read from a client that does not read its answers
  if (!ended_ && !paused_) read();
}

void Socket::queue(Message bytes, bool is_text) {
  if (ended_) return;
  waiting_bytes_ += bytes->size();
  waiting_.push_back({std::move(bytes), is_text});
  if (waiting_bytes_ > kMostWaiting) return end();
  if (waiting_.size() == 1) write();
}

void Socket::write() {
  const Outgoing& out = waiting_.front();
  stream_.text(out.text);
  stream_.async_write(asio::buffer(*out.bytes), [self = shared_from_this(), held = out.bytes](ErrorCode error, size_t) {
    if (error) return self->end();
    self->waiting_bytes_ -= held->size();
    self->waiting_.pop_front();
    if (self->ended_) return;
    if (!self->waiting_.empty()) self->write();
    if (self->paused_ && self->waiting_.empty()) self->paused_ = false, self->read();
  });
}

/// Ends the conversation. This object is destroyed after its last pending operation.
void Socket::end() {
  if (std::exchange(ended_, true)) return;
  ErrorCode ignored;
  beast::get_lowest_layer(stream_).socket().close(ignored);
  // done later, because the conversation itself may have called this function
  asio::post(stream_.get_executor(), [self = shared_from_this()] { self->conversation_.reset(); });
}

}  // namespace

Result<std::unique_ptr<Server>> Server::listen(asio::io_context& io, unsigned short port, Converse converse) {
  try {
    tcp::acceptor v4(io, tcp::endpoint(asio::ip::address_v4::loopback(), port));
    auto server = std::make_unique<ServerImpl>(io, std::move(v4), std::move(converse));
    server->start();
    return std::unique_ptr<Server>(std::move(server));
  } catch (const boost::system::system_error& error) {
    return Error{"cannot serve port " + std::to_string(port) + " of 127.0.0.1: " + error.code().message() +
                 "\n  fix: give another --port, or no --port for any free port"};
  }
}

}  // namespace hapticd::view
