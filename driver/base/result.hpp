// SPDX-License-Identifier: MIT
/// Result<T>: a value, or an error message for the user. The code of the set-up returns it. The servo path uses status
/// codes instead.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace hapticd {

/// The kind of an error, for callers that treat one kind in another way. Its message is for the user only.
enum class ErrorKind : uint8_t {
  kOther,
  kAbsent,  ///< hardware that could not be opened: it is not plugged in, or another program uses it
};

/// An error in words for the user: what failed, the measured state, the consequence, and how to fix it.
struct Error {
  std::string message;
  ErrorKind kind = ErrorKind::kOther;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: implicit by intent
  Result(Error error) : state_(std::move(error)) {}  // NOLINT
  explicit operator bool() const { return std::holds_alternative<T>(state_); }
  T& operator*() & { return std::get<T>(state_); }
  const T& operator*() const& { return std::get<T>(state_); }
  T&& operator*() && { return std::get<T>(std::move(state_)); }
  T* operator->() { return &std::get<T>(state_); }
  const T* operator->() const { return &std::get<T>(state_); }
  const std::string& error() const { return std::get<Error>(state_).message; }
  ErrorKind kind() const { return std::get<Error>(state_).kind; }

 private:
  std::variant<T, Error> state_;
};

/// Success, or a message.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), failed_(true) {}  // NOLINT
  explicit operator bool() const { return !failed_; }
  const std::string& error() const { return error_.message; }
  ErrorKind kind() const { return error_.kind; }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace hapticd
