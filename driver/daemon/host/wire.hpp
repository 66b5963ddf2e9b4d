// SPDX-License-Identifier: MIT
/// Packs numbers and texts into bytes, which a process and its child exchange. Both run on the same machine with the
/// same build, so the bytes have no portable format.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>

namespace hapticd::host {

class Packer {
 public:
  void number(uint32_t value) { raw(&value, sizeof value); }
  void number(double value) { raw(&value, sizeof value); }
  void text(const std::string& value) {
    number(static_cast<uint32_t>(value.size()));
    raw(value.data(), value.size());
  }
  std::string take() { return std::move(bytes_); }

 private:
  void raw(const void* data, size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string bytes_;
};

/// Reads what Packer wrote. If the bytes end too early, it returns zeros, and good() is false.
class Unpacker {
 public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
  uint32_t count() { return value<uint32_t>(); }
  double real() { return value<double>(); }
  std::string text() {
    const size_t size = count();
    if (!has(size)) return "";
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  bool good() const { return good_; }

 private:
  bool has(size_t size) {
    good_ = good_ && size <= bytes_.size() - at_;
    return good_;
  }
  template <class T>
  T value() {
    T result{};
    if (!has(sizeof result)) return result;
    std::memcpy(&result, bytes_.data() + at_, sizeof result);
    at_ += sizeof result;
    return result;
  }
  const std::string& bytes_;
  size_t at_ = 0;
  bool good_ = true;
};

}  // namespace hapticd::host
