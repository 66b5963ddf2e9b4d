// SPDX-License-Identifier: MIT
#include "host/catalog.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "hapticd/abi.h"
#include "host/library.hpp"

namespace hapticd::host {
namespace {

const std::filesystem::path kGood = TEST_MODULES "/good", kBad = TEST_MODULES "/bad";

SearchPath only(const std::vector<std::filesystem::path>& dirs) {
  return {dirs, dirs};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Catalog, DescribesEveryKindOfParameterWithoutLoadingTheFileHere) {
  Catalog catalog(only({kGood}));
  auto found = catalog.shape("test_shape");
  ASSERT_TRUE(found) << found.error();
  const ClassInfo& info = **found;
  EXPECT_EQ(info.id, "org.hapticd.test.shape");
  EXPECT_EQ(info.version, "1.2.3");
  ASSERT_EQ(info.params.size(), 12u);
  const ParamInfo& stiffness = info.params[static_cast<size_t>(info.indexOf("stiffness"))];
  EXPECT_EQ(stiffness.unit, "N/m");
  EXPECT_EQ(stiffness.max, 20000);
  EXPECT_EQ(stiffness.def, 500);
  const ParamInfo& sides = info.params[static_cast<size_t>(info.indexOf("sides"))];
  EXPECT_EQ(sides.choices, (std::vector<std::string>{"front", "back", "both"}));
  EXPECT_EQ(info.params[static_cast<size_t>(info.indexOf("axis"))].def_text, "[0, 1, 0]");
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) EXPECT_FALSE(has(line, "test_shape.so")) << line;
}

TEST(Catalog, DescribesNoOtherFileThanTheOneOfThatName) {
  Catalog catalog(only({kBad, kGood}));
  ASSERT_TRUE(catalog.shape("test_shape"));
  EXPECT_EQ(catalog.described(), 1u);
}

TEST(Catalog, FindsClassesByIdToo) {
  Catalog catalog(only({kGood}));
  EXPECT_TRUE(catalog.shape("org.hapticd.test.shape"));
  EXPECT_TRUE(catalog.device("org.hapticd.test.device"));
}

TEST(Catalog, SuggestsTheNearestNameAndShowsTheSearchPath) {
  Catalog catalog(only({kGood, "/nowhere/at/all"}));
  const auto found = catalog.shape("tset_shape");
  ASSERT_FALSE(found);
  EXPECT_TRUE(has(found.error(), "did you mean \"test_shape\"?")) << found.error();
  EXPECT_TRUE(has(found.error(), kGood.string())) << found.error();
  EXPECT_TRUE(has(found.error(), "/nowhere/at/all (No such file or directory)")) << found.error();
}

TEST(Catalog, KeepsPluginsAndModulesApart) {
  Catalog catalog(only({kGood}));
  EXPECT_FALSE(catalog.device("test_shape"));
  EXPECT_FALSE(catalog.shape("test_device"));
}

TEST(Catalog, TurnsABadFileIntoAMessageAboutThatFile) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"crash", "crashed: Segmentation fault"}, {"exits", "ended the process with code 0"},
      {"wrong_major", "built for version 2.0"}, {"no_entry", "exports no hsp_plugin_entry"},
      {"broken_table", "has 'a' twice"},        {"wrong_default", "a: its default is outside of its range"},
      {"no_id", "class 'no_id' has no id"},     {"odd_name", "a name that is not plain text"},
  };
  Catalog catalog(only({kBad}));
  for (const auto& [name, reason] : cases) {
    const auto found = catalog.shape(name);
    ASSERT_FALSE(found) << name;
    EXPECT_TRUE(has(found.error(), reason)) << found.error();
    EXPECT_TRUE(has(found.error(), name + ".so")) << found.error();
  }
}

TEST(Catalog, GivesTheLoadersOwnReasonForAFileThatIsNoLibrary) {
  const auto dir = std::filesystem::temp_directory_path() / ("hapticd-catalog-" + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  std::ofstream(dir / "text.so") << "not a library";
  Catalog catalog(only({dir}));
  const auto found = catalog.shape("text");
  ASSERT_FALSE(found);
  EXPECT_TRUE(has(found.error(), "the loader says: ")) << found.error();
  std::filesystem::remove_all(dir);
}

TEST(Catalog, NeverLeavesTheSearchPathForAName) {
  Catalog catalog(only({kGood}));
  EXPECT_FALSE(catalog.shape("../good/test_shape"));
  EXPECT_FALSE(catalog.shape(""));
  EXPECT_FALSE(catalog.shape(std::string(5000, 'x')));
}

TEST(Catalog, ReadsAParameterTableOfASmallerMinorVersion) {
  Catalog catalog(only({kGood}));
  auto found = catalog.shape("small_minor");
  ASSERT_TRUE(found) << found.error();
  ASSERT_EQ((*found)->params.size(), 2u);
  EXPECT_EQ((*found)->params[1].id, "unused");
  EXPECT_EQ((*found)->params[1].def, 3);
  EXPECT_FALSE((*found)->params[0].def_text.has_value());
  EXPECT_EQ((*found)->doc, "An old  [2Jplugin.") << "control characters would reach the terminal";
  EXPECT_EQ((*found)->params[0].doc, "The depth that it reports.");
}

/// A folder with a plugin that can be replaced, as an installation or a rebuild does it.
struct Replaceable {
  const std::filesystem::path dir =
      std::filesystem::temp_directory_path() / ("hapticd-replace-" + std::to_string(::getpid()));
  const std::filesystem::path file = dir / "it.so";
  Replaceable() { std::filesystem::create_directories(dir); }
  ~Replaceable() { std::filesystem::remove_all(dir); }
  void put(const std::filesystem::path& from) const {
    std::filesystem::copy_file(from, dir / "new", std::filesystem::copy_options::overwrite_existing);
    std::filesystem::rename(dir / "new", file);
  }
};

TEST(Catalog, DescribesAFileAgainOnlyWhenItChanged) {
  const Replaceable plugin;
  plugin.put(kGood / "test_shape.so");
  int described = 0;
  Catalog catalog(only({plugin.dir}));
  catalog.describeBy([&described](const auto& file) {
    ++described;
    return describeInChild(file);
  });
  ASSERT_TRUE(catalog.shape("test_shape"));
  catalog.refresh();
  ASSERT_TRUE(catalog.shape("test_shape"));
  EXPECT_EQ(described, 1) << "the file is the same";
  plugin.put(kGood / "small_minor.so");
  EXPECT_TRUE(catalog.shape("test_shape")) << "until it is refreshed";
  catalog.refresh();
  EXPECT_FALSE(catalog.shape("test_shape"));
  EXPECT_TRUE(catalog.shape("small_minor"));
  EXPECT_EQ(described, 2);
}

TEST(Catalog, TriesAFileAgainThatFailed) {
  const Replaceable plugin;
  plugin.put(kBad / "crash.so");
  Catalog catalog(only({plugin.dir}));
  int described = 0;
  catalog.describeBy([&described](const auto& file) {
    ++described;
    return describeInChild(file);
  });
  EXPECT_FALSE(catalog.shape("it"));
  catalog.refresh();
  EXPECT_FALSE(catalog.shape("it"));
  EXPECT_EQ(described, 2);
}

/// The values of a scene are set by the index that a description gives: it must be the one of the code that takes them.
/// What was loaded once stays: a thread of it may live on.
TEST(Catalog, DescribesWhatIsLoadedWhateverTheFileHoldsByNow) {
  const Replaceable plugin;
  plugin.put(kGood / "test_shape.so");
  Catalog catalog(only({plugin.dir}));
  catalog.describeBy([](const auto&) -> Result<std::vector<ClassInfo>> { return Error{"nobody should ask"}; });
  auto loaded = Library::open(plugin.file);
  ASSERT_TRUE(loaded) << loaded.error();
  plugin.put(kGood / "small_minor.so");
  ASSERT_TRUE(catalog.shape("test_shape"));
  loaded->reset();
  catalog.describeBy(describeInChild);
  catalog.refresh();
  EXPECT_TRUE(catalog.shape("test_shape"));
  EXPECT_FALSE(catalog.shape("small_minor"));
}

TEST(SearchPath, PutsTheEnvironmentFirst) {
  ::setenv("HAPTICD_PLUGIN_PATH", "/one::/two", 1);
  const SearchPath path = SearchPath::standard();
  ::unsetenv("HAPTICD_PLUGIN_PATH");
  ASSERT_GE(path.plugins.size(), 3u);
  EXPECT_EQ(path.plugins[0], "/one");
  EXPECT_EQ(path.plugins[1], "/two");
  EXPECT_EQ(path.devices[0], "/one");
}

}  // namespace
}  // namespace hapticd::host
