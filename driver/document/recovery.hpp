// SPDX-License-Identifier: MIT
/// Reads on after a syntax error, so that one check reports all problems of a file. What is read so is never
/// used for a run, because the file has problems.
#pragma once
#include <optional>
#include <string>

#include "document/node.hpp"
#include "document/problem.hpp"
#include "document/repair.hpp"

namespace hapticd::document {

/// A syntax error as the parser reports it.
struct SyntaxError {
  Place place;
  std::string words;               ///< the parser's message
  std::optional<Problem> problem;  ///< what is wrong, if the parser noticed nothing
};

class Recovery {
 public:
  Recovery(const std::string& text, std::string file);

  const std::string& text() const { return text_; }  ///< as far as it is corrected
  /// Corrects the text, or leaves out a part of it, and keeps a problem that says what is wrong and how it is read on.
  /// Returns false if nothing helps; the problem is kept all the same.
  bool recover(const SyntaxError& error);
  /// Moves places of the corrected text to where they are in the file.
  void toFile(Problems& problems) const;
  void toFile(Node& node) const;
  const Problems& problems() const { return problems_; }  ///< the syntax errors so far

 private:
  Place inFile(Place place) const;
  std::optional<Repair> farthest(const std::vector<Repair>& repairs, const SyntaxError& error, int line);
  std::optional<Repair> corrected(const Place& place, const SyntaxError& error);
  std::optional<Repair> leftOut(int line, const SyntaxError& error);
  void use(Problem problem, const Repair& repair);

  std::string file_, text_;
  Lines given_, lines_;
  Problems problems_;
  std::vector<int> repaired_;  ///< lines that were corrected
  size_t parsed_ = 0;          ///< bytes that were parsed to find corrections
};

}  // namespace hapticd::document
