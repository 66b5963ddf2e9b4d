// SPDX-License-Identifier: MIT
#include "base/shell_word.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace hapticd {
namespace {

/// Returns what a shell makes of the first word.
std::string readByShell(const std::string& word) {
  FILE* shell = popen(("printf %s " + word).c_str(), "r");
  std::string text;
  for (int c = 0; shell != nullptr && (c = std::fgetc(shell)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(shell != nullptr ? pclose(shell) : -1, 0);
  return text;
}

TEST(ShellWord, IsReadByAShellAsTheName) {
  for (const std::string name : {"part.hpart",
                                 "my part.hpart",
                                 "it's",
                                 "\"quoted\"",
                                 "$HOME",
                                 "a;b",
                                 "a&b",
                                 "*",
                                 "~",
                                 "back\\slash",
                                 "`ls`",
                                 "(1)",
                                 "#1",
                                 "line\nbreak",
                                 "\xc3\xa9t\xc3\xa9.yaml",
                                 "'",
                                 "!",
                                 "a=b",
                                 "[0]",
                                 "{a,b}"})
    EXPECT_EQ(readByShell(shellWord(name)), name);
}

TEST(ShellWord, LeavesUsualNamesAlone) {
  for (const std::string name :
       {"part.hpart", "../a/b_c-1.yaml", "/usr/lib/x.so", "16c0:0486", "\xc3\xa9t\xc3\xa9.yaml"})
    EXPECT_EQ(shellWord(name), name);
}

TEST(ShellWord, IsNeverAnOptionOrNothing) {
  EXPECT_EQ(shellWord("-o"), "./-o");
  EXPECT_EQ(shellWord(""), "''");
}

}  // namespace
}  // namespace hapticd
