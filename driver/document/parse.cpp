// SPDX-License-Identifier: MIT
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <unordered_map>

#include "base/regular_file.hpp"
#include "document/absent_file.hpp"
#include "document/foreign_file.hpp"
#include "document/node.hpp"
#include "document/recovery.hpp"
#include "document/syntax_error.hpp"

namespace hapticd::document {
namespace {

constexpr const char* kEmpty =
    "the file is empty, expected YAML; a scene begins with \"hapticd: 1\", a device file with \"hapticd-device: 1\"";

/// An exception that stops the reading at once, with the reason.
struct Refused {
  YAML::Mark mark;
  std::string what;
};

/// Builds the tree from the parser's events. Nodes with anchors are kept as copies. An alias copies such a node again,
/// and the copied values count toward the limit.
class Builder final : public YAML::EventHandler {
 public:
  Builder(const std::string& file, size_t most_nodes, Problems& problems)
      : file_(file), problems_(problems), most_nodes_(most_nodes) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(make(mark, Node::Kind::kNull), mark, anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node = make(mark, Node::Kind::kScalar);
    node.scalar = value;
    node.quoted = tag != "?" && tag != "";  // "!" is the parser's mark of a quoted or block scalar
    if (node.quoted) last_quoted_ = mark;
    if (!node.quoted && (value == "~" || value == "null" || value == "Null" || value == "NULL"))
      node.kind = Node::Kind::kNull;
    add(std::move(node), mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    for (const Open& open : open_)
      if (open.anchor == anchor)
        throw Refused{mark, "an alias (*name) inside the very node that it stands for, so the file would never end"};
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw Refused{mark, "an alias (*name) without its anchor (&name) before it"};
    count(sizeOf(found->second), mark);
    add(found->second, mark, 0);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, Node::Kind::kSequence, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, Node::Kind::kMap, anchor);
  }
  void OnSequenceEnd() override { closeLast(); }
  void OnMapEnd() override { closeLast(); }

  std::optional<Node> take() { return std::move(root_); }
  /// Returns the place where the last quoted text began.
  const YAML::Mark& lastQuoted() const { return last_quoted_; }

 private:
  /// A key of a mapping, to find those that are given twice.
  struct Known {
    int line;
    size_t entry;  // its index in the mapping
  };
  struct Open {
    Node node;
    YAML::anchor_t anchor;
    std::optional<Node> key;  // in a map: the key whose value has not come yet
    std::unordered_map<std::string, Known> names;
    std::optional<size_t> twice;  // in a map: the entry that has the same key as `key`
  };

  Node make(const YAML::Mark& mark, Node::Kind kind) {
    count(1, mark);
    Node node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }
  void count(size_t nodes, const YAML::Mark& mark) {
    nodes_ += nodes;
    if (nodes_ > most_nodes_)
      throw Refused{mark, "the file has more than " + std::to_string(most_nodes_) +
                              " values (with aliases expanded), expected fewer"};
  }
  static size_t sizeOf(const Node& node) {
    size_t size = 1;
    for (const Node& item : node.items) size += sizeOf(item);
    for (const Entry& entry : node.entries) size += 1 + sizeOf(entry.value);
    return size;
  }
  void open(const YAML::Mark& mark, Node::Kind kind, YAML::anchor_t anchor) {
    if (open_.size() >= kMaxDepth)
      throw Refused{
          mark, "lists and mappings are nested deeper than " + std::to_string(kMaxDepth) + " levels, expected fewer"};
    open_.push_back({make(mark, kind), anchor, std::nullopt, {}, std::nullopt});
  }
  /// Adds the keys of other mappings (merge key << of YAML 1.1). If a key is in both, this mapping's own value counts.
  void merge(Open& map) {
    std::vector<Entry>& entries = map.node.entries;
    const auto named = std::find_if(entries.begin(), entries.end(),
                                    [](const Entry& entry) { return entry.key.scalar == "<<" && !entry.key.quoted; });
    if (named == entries.end()) return;
    const Node merged = std::move(named->value);
    entries.erase(named);
    for (const Node& other : merged.isSequence() ? merged.items : std::vector<Node>{merged}) {
      if (!other.isMap())
        report(problems_, file_, other.line, other.column, "<<",
               describe(other) + ", expected a mapping to merge, such as an alias (*name) of one, or a list of them");
      for (const Entry& entry : other.entries)
        if (map.names.emplace(entry.key.scalar, Known{entry.key.line, entries.size()}).second) entries.push_back(entry);
    }
  }
  void closeLast() {
    Open done = std::move(open_.back());
    open_.pop_back();
    if (done.node.isMap()) merge(done);
    const YAML::Mark mark = YAML::Mark::null_mark();
    add(std::move(done.node), mark, done.anchor);
  }
  void add(Node node, const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != 0) {
      count(sizeOf(node), mark);
      anchors_.emplace(anchor, node);
    }
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.isSequence()) {
      open_.back().node.items.push_back(std::move(node));
    } else {
      addToMap(open_.back(), std::move(node));
    }
  }
  void addToMap(Open& map, Node node) {
    if (!map.key) {
      if (!node.isScalar() && !node.isNull()) {
        report(problems_, file_, node.line, node.column, "", "a key that is " + describe(node) + ", expected a name");
        node.scalar.assign(1, '?');
      } else if (const auto [first, is_new] = map.names.emplace(node.scalar, Known{node.line, map.node.entries.size()});
                 !is_new) {
        map.twice = first->second.entry;
      }
      map.key = std::move(node);
      return;
    }
    const bool merged = map.twice && reportTwice(*map.key, map.node.entries[*map.twice], node);
    if (!merged) map.node.entries.push_back({*std::move(map.key), std::move(node)});
    map.key.reset();
    map.twice.reset();
  }
  /// Reports a key that is given twice, with both values if they are short. Of two mappings, the second is merged into
  /// the first, so that the keys of both are judged. @return true if they were merged
  bool reportTwice(const Node& key, Entry& first, Node& second) {
    const bool texts = first.value.isScalar() && second.isScalar() && first.value.scalar != second.scalar;
    report(problems_, file_, key.line, key.column, key.scalar,
           "given twice (first in line " + std::to_string(first.key.line) + "), expected each key once" +
               (texts ? ": " + describe(first.value) + " or " + describe(second) : ""));
    if (!first.value.isMap() || !second.isMap()) return false;
    std::move(second.entries.begin(), second.entries.end(), std::back_inserter(first.value.entries));
    return true;
  }

  std::string file_;
  Problems& problems_;
  std::vector<Open> open_;
  std::unordered_map<YAML::anchor_t, Node> anchors_;
  std::optional<Node> root_;
  YAML::Mark last_quoted_ = YAML::Mark::null_mark();
  size_t nodes_ = 0, most_nodes_;
};

/// Returns the offset of the first byte at or after `from` that is not valid UTF-8, or npos. Overlong forms are
/// accepted, because nothing here decodes them.
size_t firstBadByte(const std::string& text, size_t from = 0) {
  for (size_t i = from; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    const size_t length = c < 0x80                ? 1
                          : c >= 0xC2 && c < 0xE0 ? 2
                          : c >= 0xE0 && c < 0xF0 ? 3
                          : c >= 0xF0 && c < 0xF5 ? 4
                                                  : 0;
    const bool control = c < 0x20 && c != '\n' && c != '\r' && c != '\t';
    if (length == 0 || control || i + length > text.size()) return i;
    for (size_t j = 1; j < length; ++j)
      if ((static_cast<unsigned char>(text[i + j]) & 0xC0) != 0x80) return i;
    i += length;
  }
  return std::string::npos;
}

/// Returns a text of Latin-1 with question marks for its letters that are not ASCII, so that the rest can be read; ""
/// for any other text.
std::string withoutLatin(std::string text) {
  constexpr unsigned char kFirstLetter = 0xA0;  // of Latin-1
  for (size_t bad = firstBadByte(text); bad != std::string::npos; bad = firstBadByte(text, bad)) {
    if (static_cast<unsigned char>(text[bad]) < kFirstLetter) return "";
    text[bad] = '?';
  }
  return text;
}

Place placeOf(const std::string& text, size_t offset, const std::string& file) {
  const std::string_view before = std::string_view(text).substr(0, offset);
  const size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(offset - line_start)};
}

Place placeOf(const YAML::Mark& mark, const std::string& file) {
  return {file, std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// The tree of a text, or the syntax error in it. Both are absent if the text was refused for another reason.
struct Attempt {
  std::optional<Node> root;
  std::optional<SyntaxError> error;
};

/// Reports a second document in the text.
void refuseSecond(YAML::Parser& parser, const std::string& text, const std::string& file, Problems& problems) {
  Problems ignored;
  Builder second(file, maxNodes(text.size()), ignored);
  if (!parser.HandleNextDocument(second)) return;
  const std::optional<Node> next = second.take();
  report(problems, file, next ? next->line : 1, next ? next->column : 1, "",
         "a second document begins here (after ---), expected one document in a file");
}

/// Parses a text of valid UTF-8.
Attempt attempt(const std::string& text, const std::string& file, Problems& problems) {
  Builder builder(file, maxNodes(text.size()), problems);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) {
      report(problems, file, 1, 1, "", kEmpty);
      return {};
    }
    Attempt made{builder.take(), std::nullopt};
    // If a quote is never closed, the parser takes the end of the text for the closing quote.
    const Place quoted = placeOf(builder.lastQuoted(), file);
    if (const auto open = findOpenQuote(text, quoted)) return {std::nullopt, SyntaxError{quoted, "", open}};
    refuseSecond(parser, text, file, problems);
    return made;
  } catch (const Refused& refused) {
    report(problems, placeOf(refused.mark, file), "", refused.what);
  } catch (const YAML::Exception& error) {
    return {std::nullopt, SyntaxError{placeOf(error.mark, file), error.msg, std::nullopt}};
  } catch (const std::exception& error) {
    report(problems, file, 1, 1, "", std::string("not YAML: ") + error.what());
  }
  return {};
}

/// Reads a text of valid UTF-8 up to its first syntax error. @param repairs how many unknown aliases may be replaced by
/// those that were probably meant
std::optional<Node> parseRepaired(const std::string& text, const std::string& file, Problems& problems, int repairs) {
  const size_t before = problems.size();
  Attempt made = attempt(text, file, problems);
  if (!made.error) return std::move(made.root);
  const SyntaxError& error = *made.error;
  const std::string meant = withCorrectedAlias(text, error.place, error.words);
  const bool again = repairs > 0 && !meant.empty();
  if (again) problems.resize(before);  // the corrected text will give the same problems again
  problems.push_back(error.problem ? *error.problem : findSyntaxError(text, error.place, error.words));
  return again ? parseRepaired(meant, file, problems, repairs - 1) : std::nullopt;
}

/// Reads a text of valid UTF-8, and goes on after syntax errors.
std::optional<Node> parseOn(const std::string& text, const std::string& file, Problems& problems) {
  std::optional<Recovery> recovery;
  for (;;) {
    Problems found;
    Attempt made = attempt(recovery ? recovery->text() : text, file, found);
    if (made.error && !recovery) recovery.emplace(text, file);
    if (made.error && recovery->recover(*made.error)) continue;
    if (recovery) {
      if (made.root) recovery->toFile(*made.root);
      recovery->toFile(found);
      // It is empty only without what was left out.
      std::erase_if(found, [](const Problem& one) { return one.what == kEmpty; });
      append(problems, recovery->problems());
    }
    append(problems, std::move(found));
    return std::move(made.root);
  }
}

using Parse = std::optional<Node> (*)(const std::string& text, const std::string& file, Problems& problems);

/// Refuses files of other kinds and other encodings, and parses the rest.
std::optional<Node> parseAny(const std::string& text, const std::string& file, Parse parse, Problems& problems) {
  if (const std::string foreign = text.empty() ? "" : foreignFile(text, file); !foreign.empty()) {
    report(problems, file, 1, 1, "", foreign);
    return std::nullopt;
  }
  const size_t bad = firstBadByte(text);
  if (bad == std::string::npos) return parse(text, file, problems);
  report(problems, placeOf(text, bad, file), "",
         "a byte that is not text (code " + std::to_string(static_cast<unsigned char>(text[bad])) +
             "), expected YAML in UTF-8");
  const std::string readable = withoutLatin(text);
  return readable.empty() ? std::nullopt : parse(readable, file, problems);
}

}  // namespace

std::optional<Node> parseText(const std::string& text, const std::string& file, Problems& problems) {
  constexpr int kRepairs = 8;
  return parseAny(
      text, file,
      [](const std::string& some, const std::string& of, Problems& found) {
        return parseRepaired(some, of, found, kRepairs);
      },
      problems);
}

std::optional<Node> readOn(const std::string& text, const std::string& file, Problems& problems) {
  return parseAny(text, file, parseOn, problems);
}

std::optional<std::string> readFile(const std::filesystem::path& file, size_t max_bytes, Problems& problems) {
  auto text = readRegular(file.string(), max_bytes);
  if (text) return *std::move(text);
  const bool absent = text.error().starts_with("there is no such file");
  report(problems, file.string(), 0, 0, "", text.error() + (absent ? neighbourMeant(file, file) : ""));
  return std::nullopt;
}

std::optional<Node> parseFile(const std::filesystem::path& file, Problems& problems) {
  const std::optional<std::string> text = readFile(file, kMaxFileBytes, problems);
  return text ? parseText(*text, file.string(), problems) : std::nullopt;
}

std::optional<Node> readFileOn(const std::filesystem::path& file, Problems& problems) {
  const std::optional<std::string> text = readFile(file, kMaxFileBytes, problems);
  return text ? readOn(*text, file.string(), problems) : std::nullopt;
}

}  // namespace hapticd::document
