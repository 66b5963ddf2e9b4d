// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "kernels/part/crc32c.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/names.hpp"
#include "kernels/part/sections.hpp"
#include "sample_parts.hpp"

namespace hapticd::brep {
namespace {

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const PartError& error) {
    return error.what();
  }
  return "";
}

TEST(Crc32c, GivesThePublishedCheckValues) {
  EXPECT_EQ(crc32c(bytesOf("123456789")), 0xe3069283u);
  EXPECT_EQ(crc32c(bytesOf(std::string(32, '\0'))), 0x8a9136aau);    // RFC 3720, B.4
  EXPECT_EQ(crc32c(bytesOf(std::string(32, '\xff'))), 0x62a8ab43u);  // likewise
}

TEST(PartFile, ComesBackAsItWasWritten) {
  Part part = samples::cappedCylinder(10, 20);
  part.source = {"can.step", std::string(64, 'a'), "mm", true, 0.001, "centred"};
  part.names = {"can", "lid \xc3\xa9"};
  part.warnings = {"a warning"};
  part.losses = {{"face 2", "no pcurve", 0.25, 2}};
  part.tolerance = 1e-7;
  part.bodies[0].name = 1;
  const std::string file = writePart(part);
  const Part back = readPart(bytesOf(file), "can.hpart");
  EXPECT_EQ(writePart(back), file);
  EXPECT_EQ(back.names, part.names);
  EXPECT_EQ(back.losses[0].face, 2u);
  EXPECT_EQ(back.surfaces.size(), 3u);
  EXPECT_EQ(back.source.unit, "mm");
  EXPECT_TRUE(back.source.unit_assumed);
  EXPECT_EQ(back.source.scale, 0.001);
  EXPECT_EQ(back.source.placed, "centred");
}

/// Names come from the files of other programs and are shown in terminals.
TEST(PartFile, ControlCharactersOfNamesBecomeSpaces) {
  Part part = samples::cappedCylinder(10, 20);
  part.names = {"a\x1b[2Jb\n\x7f",
                "caf\xc3\xa9 \xc2\x9b"
                "2J \xc2\xb0"};
  part.losses = {{"face\r2", "no\tpcurve", 0.25, 2}};
  const std::string file = writePart(part);
  const Part back = readPart(bytesOf(file), "can.hpart");
  EXPECT_EQ(back.names, (std::vector<std::string>{"a [2Jb  ", "caf\xc3\xa9   2J \xc2\xb0"}));
  EXPECT_EQ(back.losses[0].what + back.losses[0].reason, "face 2no pcurve");
}

TEST(PartFile, SaysWhatIsWrongWithOtherFiles) {
  const std::string file = writePart(samples::cappedCylinder(10, 20));
  const auto error = [](const std::string& bytes) {
    return errorOf([&] { readPart(std::as_bytes(std::span(bytes)), "x.hpart"); });
  };
  EXPECT_EQ(error(""),
            "x.hpart: not a part file (.hpart, format hapticd-part/1), expected one that hapticd import wrote: hapticd "
            "import FILE -o PART.hpart");
  EXPECT_NE(error(file.substr(0, 30)).find("the header is cut off"), std::string::npos);
  EXPECT_NE(error(file.substr(0, file.size() - 8)).find("may be incomplete"), std::string::npos);
  std::string damaged = file;
  damaged[file.size() - 1] ^= 1;
  EXPECT_NE(error(damaged).find("its checksum differs"), std::string::npos);
}

TEST(PartFile, CutAnywhereIsAnErrorAndNothingWorse) {
  const std::string file = writePart(samples::cappedCylinder(10, 20));
  for (std::size_t length = 0; length < file.size(); ++length)
    EXPECT_NE(errorOf([&] { readPart(bytesOf(file).first(length), "x"); }), "") << length;
}

/// Returns the error of checkPart() for a sample after `spoil` has changed it; "" if there is none.
std::string spoilt(const std::function<void(Part&)>& spoil) {
  Part part = samples::cappedCylinder(10, 20);
  spoil(part);
  return errorOf([&] { checkPart(part); });
}

TEST(PartCheck, NamesTheRecordThatBreaksARule) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(spoilt([](Part&) {}), "");
  EXPECT_EQ(spoilt([](Part& p) { p.coedges[2].edge = 3; }),
            "edge 1: coedge 2 belongs to edge 3, expected a coedge of this edge");
  EXPECT_EQ(spoilt([&](Part& p) { p.surfaces[0].r[0] = nan; }),
            "surface 0: a radius is nan, expected a finite number of magnitude at most 1000000");
  EXPECT_EQ(spoilt([](Part& p) { p.surfaces[0].r[0] = -1; }),
            "surface 0: r0 is -1, expected above 0 and at most 1000000");
  EXPECT_EQ(spoilt([](Part& p) { p.faces[1].surface = 7; }), "face 1: surface 7, but the index must be below 3");
  EXPECT_EQ(spoilt([](Part& p) { p.loops[1].count = 0xfffffff0u; }),
            "loop 1: coedges: 4294967280 from index 4 on, but the part has only 6");
  EXPECT_EQ(spoilt([](Part& p) { p.edges[0].t1 = p.edges[0].t0; }),
            "edge 0: parameters from 0 to 0, expected finite numbers, the second greater than the first");
  EXPECT_EQ(spoilt([](Part& p) { p.coedges[0].next = 0; }),
            "edge 0: its list has more than the 2 coedges that coedge_count gives");
  EXPECT_EQ(spoilt([](Part& p) { p.instances[0].pose[0] = -1; }),
            "instance 0: the pose mirrors, expected a rotation (store a mirrored body as a separate body)");
  EXPECT_EQ(spoilt([](Part& p) { p.instances[0].parent = 0; }), "instance 0: parent 0, but the index must be below 0");
  EXPECT_EQ(spoilt([](Part& p) { p.edges[0].kind = EdgeKind::kPole; }),
            "edge 0: a pole has a curve, expected none: it is a single point");
  EXPECT_EQ(spoilt([](Part& p) { p.instances.clear(); }), "the part has no instances, expected at least one");
  EXPECT_EQ(spoilt([](Part& p) { p.bodies[0].face_count = 2; }),
            "bodies: together they have 2 faces, but the part has 3; each must belong to exactly one body");
}

/// Spoils single words of all records. The reader must either report an error or return a part that passes the check.
TEST(PartCheck, SurvivesAnyWordOfARecordSpoilt) {
  std::mt19937 random(1);
  const Part good = samples::cappedCylinder(10, 20);
  const std::uint32_t words[] = {0, 1, 2, 3, 0x7fffffffu, 0xffffffffu, 0x7ff80000u, 0x80000000u, 77};
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    Part part = good;
    const int section = static_cast<int>(random() % 13);
    int index = 0;
    forEachSection(part, [&](const char*, auto& records) {
      if (index++ != section || records.empty()) return;
      const std::size_t size = records.size() * sizeof records[0];
      std::memcpy(reinterpret_cast<char*>(records.data()) + random() % (size / 4) * 4, &words[random() % 9], 4);
    });
    if (!errorOf([&] { checkPart(part); }).empty())
      ++refused;
    else
      EXPECT_EQ(errorOf([&] { readPart(bytesOf(writePart(part)), "x"); }), "");
  }
  EXPECT_GT(refused, 5000);
}

TEST(PartNames, TellEachLossAndAllSplinesTogether) {
  Part part;
  EXPECT_TRUE(lossLines(part).empty());
  part.losses = {{"edge 1 of face 0 of 'nut'", kApproximated, 1e-11, 0},
                 {"face 2 of 'nut'", "it has no outline", 0.03, 2},
                 {"pcurve of edge 1 of face 0 of 'nut'", kApproximated, 2e-10, 0},
                 {"the part in the file 'lid.step'", "there is no such file", 0, kNone}};
  EXPECT_EQ(lossLines(part),
            (std::vector<std::string>{"lost: face 2 of 'nut': it has no outline (0.03 m)",
                                      "lost: the part in the file 'lid.step': there is no such file",
                                      "2 curves and surfaces became splines, and differ by at most 2e-07 mm (pcurve of "
                                      "edge 1 of face 0 of 'nut')"}));
}

}  // namespace
}  // namespace hapticd::brep
