// SPDX-License-Identifier: MIT
#include "daemon.hpp"

#include <sys/un.h>

#include <cerrno>
#include <deque>
#include <utility>  // Boost 1.74 uses std::exchange without it
//
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <vector>

#include "document/json_text.hpp"

namespace hapticd::view {

namespace {

namespace asio = boost::asio;
using Local = asio::local::stream_protocol;
using ErrorCode = boost::system::error_code;

constexpr size_t kMostAnswer = 64u << 20;  ///< [bytes] largest size of an answer

Json refusal(const std::string& why) {
  return {{"ok", false}, {"error", why}};
}

class DaemonImpl final : public Daemon {
 public:
  DaemonImpl(asio::io_context& io, std::string file)
      : io_(io), file_(std::move(file)), link_(std::make_shared<Link>(io)) {}
  ~DaemonImpl() override {
    link_->owner = nullptr;
    ErrorCode ignored;
    link_->socket.close(ignored);
  }

  void ask(const Json& request, Answered answered) override {
    if (!connected_) {
      asio::post(io_, [answered] { answered(refusal("no daemon answers"), Descriptor()); });
      return;
    }
    pending_.push_back(std::move(answered));
    out_ += document::jsonLine(request) + "\n";
    if (sending_.empty()) send();
  }
  bool connected() const override { return connected_; }

  void connect() override {
    if (connected_ || file_.size() >= sizeof(sockaddr_un{}.sun_path)) return;
    link_->owner = nullptr;
    link_ = std::make_shared<Link>(io_);
    link_->owner = this;
    ErrorCode error;
    link_->socket.connect(Local::endpoint(file_), error);  // a local socket connects at once, or fails
    if (error) return;
    link_->socket.non_blocking(true, error);
    connected_ = true;
    in_.clear(), out_.clear(), sending_.clear(), memories_.clear();
    receive();
  }

 private:
  /// The state of a connection. It outlives its owner while an operation is in progress.
  struct Link {
    explicit Link(asio::io_context& io) : socket(io) {}
    Local::socket socket;
    DaemonImpl* owner = nullptr;
  };

  void send() {
    sending_ = std::exchange(out_, "");
    asio::async_write(link_->socket, asio::buffer(sending_), [link = link_](ErrorCode error, size_t) {
      if (link->owner == nullptr) return;
      if (error) return link->owner->lost();
      link->owner->sending_.clear();
      if (!link->owner->out_.empty()) link->owner->send();
    });
  }

  void receive() {
    link_->socket.async_wait(Local::socket::wait_read, [link = link_](ErrorCode error) {
      if (link->owner == nullptr) return;
      if (error || !link->owner->take()) return link->owner->lost();
      if (link->owner->connected_) link->owner->receive();
    });
  }

  /// Reads the bytes that have arrived, and the descriptor that may come with them. Returns false if the daemon has
  /// ended.
  bool take() {
    char buffer[1 << 14];
    std::vector<Descriptor> descriptors;
    const ssize_t got = receiveWith(link_->socket.native_handle(), buffer, descriptors);
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    for (Descriptor& descriptor : descriptors) memories_.push_back(std::move(descriptor));
    if (got == 0) return false;
    in_.append(buffer, static_cast<size_t>(got));
    answer();
    return in_.size() <= kMostAnswer;
  }

  void answer() {
    size_t begin = 0;
    for (size_t end; (end = in_.find('\n', begin)) != std::string::npos; begin = end + 1) {
      Json json = document::parseJson(std::string_view(in_).substr(begin, end - begin));
      if (!json.is_object()) json = refusal("the answer of the daemon cannot be read");
      if (pending_.empty()) continue;
      const Answered answered = std::move(pending_.front());
      pending_.pop_front();
      answered(json, takeMemory(json));
    }
    in_.erase(0, begin);
  }

  /// Returns the descriptor that belongs to an answer. One read may contain several answers; the descriptor belongs to
  /// the answer with the key "bytes".
  Descriptor takeMemory(const Json& answer) {
    if (memories_.empty() || !answer.contains("bytes")) return {};
    Descriptor memory = std::move(memories_.front());
    memories_.pop_front();
    return memory;
  }

  void lost() {
    connected_ = false;
    ErrorCode ignored;
    link_->socket.close(ignored);
    for (const Answered& answered : std::exchange(pending_, {}))
      answered(refusal("the daemon has ended"), Descriptor());
  }

  asio::io_context& io_;
  std::string file_;
  std::shared_ptr<Link> link_;
  bool connected_ = false;
  std::string in_, out_, sending_;
  std::deque<Descriptor> memories_;
  std::deque<Answered> pending_;
};

}  // namespace

std::unique_ptr<Daemon> Daemon::at(asio::io_context& io, std::string file) {
  return std::make_unique<DaemonImpl>(io, std::move(file));
}

}  // namespace hapticd::view
