// SPDX-License-Identifier: MIT
#include "document/yaml_scan.hpp"

namespace hapticd::document {
namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0';
}

class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}

  Scan scan() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n')
        newLine();
      else if (c == '#' && (at_ == 0 || isBlank(text_[at_ - 1])))
        skipLine();
      else if ((c == '"' || c == '\'') && fresh_)
        quoted(c);
      else
        plain(c);
    }
    return found_;
  }

 private:
  char next() const { return at_ + 1 < text_.size() ? text_[at_ + 1] : '\0'; }
  Mark here(char what) const { return {line_, static_cast<int>(at_ - line_start_) + 1, what}; }
  bool inFlow() const { return !found_.open.empty(); }

  void newLine() {
    const bool block = !inFlow() && opensBlock();
    ++line_;
    line_start_ = ++at_;
    fresh_ = true;
    if (block) skipBlock();
  }
  void skipLine() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  /// Returns whether the line that ends here has | or > at its end (perhaps with options after it), so that a block
  /// text begins.
  bool opensBlock() const {
    size_t end = at_;
    while (end > line_start_ && (isBlank(text_[end - 1]) || text_[end - 1] == '-' || text_[end - 1] == '+' ||
                                 (text_[end - 1] >= '0' && text_[end - 1] <= '9')))
      --end;
    return end > line_start_ + 1 && (text_[end - 1] == '|' || text_[end - 1] == '>') && text_[end - 2] == ' ';
  }
  size_t indentAt(size_t start) const {
    size_t at = start;
    while (at < text_.size() && text_[at] == ' ') ++at;
    return at - start;
  }
  /// Skips the lines that are indented more than the line that opened the block.
  void skipBlock() {
    size_t opener = line_start_ - 1;
    while (opener > 0 && text_[opener - 1] != '\n') --opener;
    const size_t indent = indentAt(opener);
    while (at_ < text_.size()) {
      const size_t own = indentAt(at_);
      const char first = at_ + own < text_.size() ? text_[at_ + own] : '\0';
      if (own <= indent && first != '\n' && first != '\r') return;
      skipLine();
      if (at_ < text_.size()) ++at_;
      ++line_;
      line_start_ = at_;
    }
  }

  /// Goes from a quote to the quote that closes it.
  void quoted(char quote) {
    const Mark begin = here(quote);
    fresh_ = false;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') ++line_, line_start_ = at_ + 1;
      if (quote == '"' && text_[at_] == '\\') {
        if (next() == '\n') ++line_, line_start_ = at_ + 2;
        ++at_;
      } else if (text_[at_] == quote) {
        if (quote == '"' || next() != '\'') break;
        ++at_;  // '' within '...' stands for one quote
      }
    }
    if (at_ >= text_.size()) {
      found_.quote = begin;
      return;
    }
    ++at_;
    after_quote_ = at_;
    if (line_ == begin.line || found_.long_quote) return;
    found_.long_quote = begin;
    found_.long_quote_ends = line_;
  }

  void plain(char c) {
    const bool flow = inFlow();
    if ((c == '[' || c == '{') && (flow || fresh_)) {
      found_.open.push_back(here(c));
      fresh_ = true;
    } else if (flow && (c == ']' || c == '}')) {
      close(c);
    } else if (flow && c == ',') {
      fresh_ = true;
    } else if (c == ':' && (isBlank(next()) || (flow && after_quote_ == at_))) {
      fresh_ = true;
    } else if (fresh_ && (c == '&' || c == '!')) {  // an anchor or a tag; the value that it marks comes after it
      while (!isBlank(next())) ++at_;
    } else if (!(fresh_ && (isBlank(c) || ((c == '-' || c == '?') && isBlank(next()))))) {
      fresh_ = false;
      if (!flow && (c == ']' || c == '}') && closed_line_ == line_ && !found_.wrong_close) found_.wrong_close = here(c);
    }
    ++at_;
  }
  void close(char c) {
    const Mark opened = found_.open.back();
    closed_line_ = line_;
    fresh_ = false;
    if ((opened.what == '[') != (c == ']') && !found_.wrong_close) {
      found_.wrong_close = here(c);
      found_.wrong_open = opened;
    }
    found_.open.pop_back();
  }

  const std::string& text_;
  Scan found_;
  size_t at_ = 0, line_start_ = 0, after_quote_ = std::string::npos;
  int line_ = 1, closed_line_ = 0;
  bool fresh_ = true;  ///< true if a value may begin here
};

}  // namespace

Scan scanYaml(const std::string& text) {
  return Scanner(text).scan();
}

}  // namespace hapticd::document
