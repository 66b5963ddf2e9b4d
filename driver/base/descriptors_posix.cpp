// SPDX-License-Identifier: MIT
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/descriptors.hpp"

namespace hapticd {

namespace {

constexpr size_t kControlBytes = CMSG_SPACE(kMostDescriptors * sizeof(int));

/// One message with room for its descriptors.
struct Message {
  Message(void* bytes, size_t size) noexcept : part{bytes, size} {
    header.msg_iov = &part;
    header.msg_iovlen = 1;
  }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;
  iovec part;
  msghdr header{};
  alignas(cmsghdr) char control[kControlBytes]{};
};

/// Calls `take` with each descriptor of a received message.
template <class Take>
void forEachDescriptor(msghdr& header, Take take) {
  for (cmsghdr* at = CMSG_FIRSTHDR(&header); at != nullptr; at = CMSG_NXTHDR(&header, at)) {
    if (at->cmsg_level != SOL_SOCKET || at->cmsg_type != SCM_RIGHTS) continue;
    const size_t count = (at->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(at) + i * sizeof fd, sizeof fd);
      take(fd);
    }
  }
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

std::ptrdiff_t sendWith(int socket, std::string_view bytes, std::span<const int> descriptors) noexcept {
  if (descriptors.size() > kMostDescriptors || bytes.empty()) {
    errno = EMSGSIZE;
    return -1;
  }
  Message message(const_cast<char*>(bytes.data()), bytes.size());
  if (!descriptors.empty()) {
    message.header.msg_control = message.control;
    message.header.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* rights = CMSG_FIRSTHDR(&message.header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(rights), descriptors.data(), descriptors.size_bytes());
  }
  for (;;)
    if (const ssize_t sent = sendmsg(socket, &message.header, MSG_NOSIGNAL); sent >= 0 || errno != EINTR) return sent;
}

std::ptrdiff_t receiveWith(int socket, std::span<char> to, std::vector<Descriptor>& descriptors) {
  Message message(to.data(), to.size());
  message.header.msg_control = message.control;
  message.header.msg_controllen = sizeof message.control;
  ssize_t got = -1;
  do got = recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC);
  while (got < 0 && errno == EINTR);
  if (got < 0) return got;
  const size_t known = descriptors.size();
  forEachDescriptor(message.header, [&](int fd) { descriptors.emplace_back(fd); });
  if ((message.header.msg_flags & MSG_CTRUNC) == 0) return got;
  descriptors.erase(descriptors.begin() + static_cast<std::ptrdiff_t>(known), descriptors.end());
  errno = EMSGSIZE;
  return -1;
}

}  // namespace hapticd
