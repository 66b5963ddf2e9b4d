// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "commands_fixture.hpp"

namespace hapticd::test {
namespace {

using ImportCommands = Commands;

TEST_F(ImportCommands, ImportScalesCentresAndKeepsTheCredit) {
  const std::string patch = put("patch.bpt", "# By somebody\n1\n1 1\n0 0 0\n0 0 2\n4 0 0\n4 0 2\n");
  const Outcome outcome = run("import " + patch + " --scale 0.5 --center -o " + (dir_ / "model.yaml").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_EQ(get("model.yaml"),
            "# By somebody\nformat: hapticd-model/1\nsurfaces:\n  - name: patch0\n    degree: [1, 1]\n"
            "    knots: [[0, 0, 1, 1], [0, 0, 1, 1]]\n"
            "    points: [[-1, 0, -0.5], [-1, 0, 0.5],\n             [1, 0, -0.5], [1, 0, 0.5]]\n");
  EXPECT_TRUE(has(outcome.text, "model.yaml: 1 surface, 2 x 0 x 1 m")) << outcome.text;
  const Outcome large = run("import " + patch + " --scale 5 -o " + (dir_ / "large.yaml").string());
  EXPECT_TRUE(has(large.text,
                  "large.yaml: 22.4 m large from corner to corner; if the imported file counts millimetres, "
                  "add --scale 0.001"))
      << large.text;
  // check warns of the same model, by the same measure and with the same limit.
  const Outcome limit = run("import " + patch + " --scale 1.2 -o " + (dir_ / "limit.yaml").string());
  EXPECT_TRUE(has(limit.text, "limit.yaml: 5.37 m large from corner to corner")) << limit.text;
  EXPECT_EQ(run("import " + patch + " -o /nowhere/at/all.yaml").exit_code, 2) << "as to run";
  const Outcome alone = run("import " + patch + " --scene " + (dir_ / "alone.yaml").string());
  EXPECT_EQ(alone.exit_code, 2) << alone.text;
  EXPECT_TRUE(has(alone.text, "so --out is required")) << alone.text;
  const Outcome part = run("import " + patch + " -o " + (dir_ / "patch.hpart").string());
  EXPECT_EQ(part.exit_code, 2);
  EXPECT_TRUE(has(part.text, "Bezier patches become a model file, expected a name that ends in .yaml or .json"));
}

/// A bow whose middle control points are twice as high as it is.
TEST_F(ImportCommands, ImportFitsTheSurfaceAndNotItsControlPoints) {
  const std::string bow = put("bow.bpt", "1\n2 1\n0 0 0\n0 0 1\n1 8 0\n1 8 1\n2 0 0\n2 0 1\n");
  const Outcome outcome = run("import " + bow + " --fit 0.1 --center -o " + (dir_ / "bow.yaml").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_TRUE(has(outcome.text, "1 surface, 0.05 x 0.1 x 0.025 m")) << outcome.text;
  EXPECT_TRUE(has(get("bow.yaml"), "[0, 0.15")) << get("bow.yaml");  // the highest control point
}

TEST_F(ImportCommands, ImportKeepsItsInputsAndFilesOfOtherKinds) {
  const std::string text = "1\n1 1\n0 0 0\n0 0 2\n4 0 0\n4 0 2\n", scene = "format: hapticd-scene/1\n";
  const std::string patch = put("patch.bpt", text), other = put("scene.yaml", scene);
  std::filesystem::create_symlink("patch.bpt", dir_ / "link.yaml");
  std::filesystem::create_hard_link(dir_ / "patch.bpt", dir_ / "twin.yaml");
  for (const char* out : {"patch.bpt", "link.yaml", "twin.yaml"}) {
    const Outcome outcome = run("import " + patch + " -o " + (dir_ / out).string());
    EXPECT_EQ(outcome.exit_code, 2) << out;
    EXPECT_TRUE(has(outcome.text, "is the input itself, expected another file")) << outcome.text;
  }
  EXPECT_EQ(get("patch.bpt"), text);
  const Outcome outcome = run("import " + patch + " -o " + other);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has(outcome.text, "exists already and is not a model file, so it would be lost")) << outcome.text;
  EXPECT_EQ(get("scene.yaml"), scene);
  const std::string model = (dir_ / "model.yaml").string();
  for (int times = 0; times < 2; ++times) EXPECT_EQ(run("import " + patch + " -o " + model).exit_code, 0);
}

TEST_F(ImportCommands, ImportSaysWhereAPatchFileIsWrong) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "bad.bpt: is empty"},
      {"# a comment alone\n", "the file ends too early; expected the number of patches"},
      {"1\n3 3\n0 0 0\n", "the file ends too early; expected a coordinate"},
      {"1\n99 3\n", "bad.bpt:2:1: '99' stands here; expected a degree"},
      {"1\n1 1\n0 0 0\n0 x 2\n", "bad.bpt:4:3: 'x' stands here; expected a coordinate"},
      {"1\n1 1\n0 0 0\n0 0 2\n4 0 0\n4 0 2\n7\n", "bad.bpt:7:1: '7' stands here; expected the end"},
      {"999999999\n", "expected the number of patches, 1 to 100000"},
  };
  for (const auto& [text, reason] : cases) {
    const Outcome outcome = run("import " + put("bad.bpt", text) + " -o " + (dir_ / "x.yaml").string());
    EXPECT_EQ(outcome.exit_code, 2) << text;
    EXPECT_TRUE(has(outcome.text, reason)) << outcome.text;
  }
}

TEST_F(ImportCommands, ImportMakesAPartOfTriangles) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", part = (dir_ / "egg.hpart").string();
  const std::string mesh = put("egg.obj", triangle);
  const Outcome wrong = run("import " + mesh + " -o " + (dir_ / "egg.yaml").string());
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(has(wrong.text, "triangles become a part, expected a name that ends in .hpart")) << wrong.text;
  const Outcome made = run("import " + mesh + " --scale 0.1 -o " + part);
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_TRUE(has(made.text, "1 triangle, 3 points, 0.1 x 0.1 x 0 m, open")) << made.text;
  EXPECT_TRUE(has(made.text, "1 hole with 3 free edges")) << made.text;
  const Outcome info = run("part info " + part);
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_TRUE(has(info.text, "body 'egg': mesh, open, 1 triangle\n")) << info.text;
  EXPECT_TRUE(has(info.text, "size: 100 x 100 x 0 mm, least corner at (0, 0, 0) mm")) << info.text;
  EXPECT_TRUE(has(run("part info " + part + " --json").text, "\"box_m\"")) << info.text;
  EXPECT_EQ(run("part info " + mesh).exit_code, 2);
  EXPECT_EQ(run("import " + mesh + " --fit 0.2 --up z --center -o " + part).exit_code, 0);
  const Outcome placed = run("part info " + part);
  EXPECT_TRUE(has(placed.text, "fit into 0.2 m, turned, z is up, centred")) << placed.text;
}

TEST_F(ImportCommands, ImportKeepsColoursAndReadsNoFileOfMaterialsOutsideOfTheFolder) {
  const std::string part = (dir_ / "egg.hpart").string();
  const auto imported = [&](const std::string& library) {
    const std::string text =
        "mtllib " + library + "\nv 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nusemtl red\nf 1 2 4\n";
    const Outcome made = run("import " + put("egg.obj", text) + " -o " + part);
    EXPECT_EQ(made.exit_code, 0) << made.text;
    return made.text;
  };
  const std::string red = "newmtl red\nKd 1 0 0\n";
  put("a.mtl", red);
  EXPECT_TRUE(has(imported("a.mtl"), "2 triangles, 4 points, 0.1 x 0.1 x 0.1 m, open"));
  EXPECT_TRUE(has(imported("a.mtl"), "  colours: 1 triangle\n"));
  EXPECT_TRUE(has(run("part info " + part).text, "body 'egg': mesh, open, 2 triangles, 1 with a colour\n"));
  EXPECT_TRUE(has(run("part info " + part + " --json").text, "\"coloured_triangles\": 1"));
  EXPECT_TRUE(
      has(run("import " + (dir_ / "egg.obj").string() + " --json -o " + part).text, "\"coloured_triangles\": 1"));
  EXPECT_TRUE(has(
      imported("b.mtl"),
      "the file of materials 'b.mtl': there is no such file, expected the path of a file; its colours are missing\n"));
  EXPECT_FALSE(has(run("part info " + part).text, "with a colour"));
  EXPECT_TRUE(has(run("part info " + part).text, "the file of materials 'b.mtl': there is no such file"))
      << "the part keeps the note";
  for (const std::string& name : {std::string("../a.mtl"), (dir_ / "a.mtl").string()})
    EXPECT_TRUE(has(imported(name), "' is not read, because it is not in the folder of the mesh: put it there"))
        << name;
  std::filesystem::create_directory(dir_ / "c.mtl");
  EXPECT_TRUE(has(imported("c.mtl"), "'c.mtl': is a folder, expected a file; its colours")) << imported("c.mtl");
  std::filesystem::create_symlink("d.mtl", dir_ / "d.mtl");
  EXPECT_TRUE(has(imported("d.mtl"), "'d.mtl': cannot be read: Too many levels of symbolic links; its colours"))
      << imported("d.mtl");
  std::filesystem::resize_file(put("e.mtl", red), 17u << 20);
  EXPECT_TRUE(has(imported("e.mtl"), "'e.mtl': is larger than 16")) << imported("e.mtl");
}

/// A part may be larger than any model file, which has a limit of 32 MiB.
TEST_F(ImportCommands, ALargePartIsNoModelFileThatIsTooLarge) {
  const std::string part = (dir_ / "egg.hpart").string();
  ASSERT_EQ(run("import " + put("egg.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") + " -o " + part).exit_code, 0);
  std::filesystem::resize_file(part, 40u << 20);  // what follows the sections is not read
  const auto scene = [&](const std::string& plugin, const std::string& file) {
    return put("scene.yaml", "hapticd: 1\nmodels:\n  - {name: egg, plugin: " + plugin +
                                 ", parameters: {geometry: " + (dir_ / file).string() + "}}\n");
  };
  const Outcome checked = run("check " + scene("nurbs_rigid", "egg.hpart"), kShipped);
  EXPECT_EQ(checked.exit_code, 0) << checked.text;
  const std::string path = put("path.csv", "t,x,y,z\n0,0.2,0.2,0.1\n0.001,0.2,0.2,0.05\n");
  const std::string traced = "trace " + scene("nurbs_rigid", "egg.hpart") + " --out - --probe " + path;
  EXPECT_TRUE(has(run(traced, kShipped).text, "0.001,egg,0,")) << run(traced, kShipped).text;
  EXPECT_EQ(run("explain " + scene("nurbs_rigid", "egg.hpart"), kShipped).exit_code, 0);
  EXPECT_EQ(run("part info " + part).exit_code, 0);
  const Outcome soft = run("check " + scene("mat_deformable", "egg.hpart"), kShipped);
  EXPECT_TRUE(has(soft.text, "a part, expected YAML: use it as the geometry of nurbs_rigid")) << soft.text;
  std::filesystem::resize_file(put("egg.yaml", "format: hapticd-model/1\n"), 40u << 20);
  const Outcome model = run("check " + scene("nurbs_rigid", "egg.yaml"), kShipped);
  EXPECT_TRUE(has(model.text, "egg.yaml:1:1: is larger than 32 MiB")) << model.text;
}

TEST_F(ImportCommands, CheckSaysWhatAPartCannotDo) {
  const std::string part = (dir_ / "egg.hpart").string();
  ASSERT_EQ(run("import " + put("egg.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") + " -o " + part).exit_code, 0);
  const auto check = [&](const std::string& plugin, const std::string& parameters) {
    return run("check " + put("scene.yaml", "hapticd: 1\nmodels:\n  - {name: egg, plugin: " + plugin +
                                                ", parameters: {geometry: egg.hpart" + parameters + "}}\n"),
               kShipped);
  };
  EXPECT_EQ(check("nurbs_rigid", "").exit_code, 0) << check("nurbs_rigid", "").text;
  EXPECT_TRUE(has(check("nurbs_rigid", ", method: dpt").text, "a part is searched as a whole in every tick"));
  EXPECT_TRUE(has(check("nurbs_rigid", ", instance: lid").text, "there is no 'lid', expected one of egg"));
  EXPECT_TRUE(has(check("nurbs_rigid", ", sides: front").text, "is not closed"));
  EXPECT_TRUE(has(check("nurbs_rigid", ", texture: {amplitude: 1e-4}").text,
                  "expected 0, or a geometry of surfaces (a CAD part or a model file)"));
  EXPECT_TRUE(has(check("push_button", "").text, "is a part, but this plugin needs a model file"));
}

TEST_F(ImportCommands, ANameThatSeveralInstancesHaveNeedsAPath) {
  const auto check = [&](const std::string& instance) {
    return run(
        "check " + put("scene.yaml", "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {geometry: " +
                                         std::string(HAPTICD_SOURCE_DIR "/config/models/as1.hpart, instance: ") +
                                         instance + "}}\n"),
        kShipped);
  };
  const std::string path = "as1/l-bracket-assembly_2/nut-bolt-assembly_3/nut_3";
  const Outcome several = check("nut_3");
  EXPECT_EQ(several.exit_code, 2);
  EXPECT_TRUE(has(several.text, "several are named 'nut_3', expected one of their paths")) << several.text;
  EXPECT_TRUE(has(several.text, path)) << several.text;
  EXPECT_EQ(check(path).exit_code, 0);
  EXPECT_EQ(check("rod_1").exit_code, 0);
}

/// One instance moves, and one model stands for all others.
TEST_F(ImportCommands, APartIsTakenWithoutSomeOfItsInstances) {
  const auto explain = [&](const std::string& geometry, const std::string& without) {
    return run("explain " + put("scene.yaml",
                                "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: "
                                "{geometry: " HAPTICD_SOURCE_DIR "/config/models/" +
                                    geometry + ", without: '" + without + "'}}\n"),
               kShipped);
  };
  const Outcome rest = explain("as1.hpart", "rod_1, l-bracket-assembly_2");
  EXPECT_EQ(rest.exit_code, 0) << rest.text;
  EXPECT_TRUE(has(rest.text, "as1/l-bracket-assembly_1/l-bracket_1")) << rest.text;
  EXPECT_FALSE(has(rest.text, "rod_1") || has(rest.text, "l-bracket-assembly_2")) << rest.text;
  EXPECT_TRUE(has(explain("as1.hpart", "plate_1, rod_2").text, "without: there is no 'rod_2' (did you mean"));
  EXPECT_TRUE(has(explain("box.yaml", "lid").text, "box.yaml is a model file, which has no instances"));
}

/// Regression: the walls of other instances were warned of, since without its instance a model is the whole part.
TEST_F(ImportCommands, AnUnknownInstanceGetsNoWarningsOfOthers) {
  for (const char* instance : {"piston", "[plate_1]"}) {
    const Outcome outcome =
        run("check " + put("scene.yaml",
                           "hapticd: 1\nmodels:\n  - {name: a, plugin: nurbs_rigid, parameters: {stiffness: "
                           "10, geometry: " HAPTICD_SOURCE_DIR "/config/models/as1.hpart, instance: " +
                               std::string(instance) + "}}\n"),
            kShipped);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_TRUE(has(outcome.text, "parameters.instance: ")) << outcome.text;
    EXPECT_FALSE(has(outcome.text, "a wall is")) << outcome.text;
  }
}

TEST_F(ImportCommands, NamesInstanceAndFaceOfAFeature) {
  const std::string part = HAPTICD_SOURCE_DIR "/config/models/as1.hpart";
  EXPECT_TRUE(has(run("part info " + part).text,
                  "instance 'rod_1': body 1, features 16 to 19, 200 x 10 x 10 mm, middle at (90, 75, 60) mm"));
  EXPECT_EQ(
      run("part info " + part + " --feature 17").text,
      "as1/rod-assembly_1/rod_1: face 1\n  a cylinder of radius 5 mm, 200 x 5 x 10 mm large, middle at (90, "
      "72.5, 60) mm, axis through (90, 75, 60) mm along (1, 0, 0)\n  to turn about it in a scene:    joint: hinge, "
      "pivot: [0.09, 0.075, 0.06], axis: [1, 0, 0]\n");
  EXPECT_TRUE(has(run("part info " + part + " --feature 18").text, "middle at (90, 77.5, 60) mm")) << "the other half";
  const std::string face = run("part info " + part + " --feature 17").text;
  for (const char* name : {"as1/rod-assembly_1/rod_1: face 1", "rod_1: face 1"})
    EXPECT_EQ(run("part info " + part + " --feature '" + name + "'").text, face) << name;
  for (const char* none : {"160", "rod_1: face 4", "rod: face 1", "99999999999", "-1"}) {
    const Outcome missing = run("part info " + part + " --feature='" + none + "'");
    EXPECT_EQ(missing.exit_code, 2) << none;
    EXPECT_TRUE(has(missing.text, "has no feature '" + std::string(none) + "'")) << missing.text;
  }
  const std::string scene =
      put("rod.yaml", "hapticd: 1\nmodels:\n  - {name: rod, plugin: nurbs_rigid, parameters: {geometry: " + part +
                          ", instance: rod-assembly_1}}\n");
  const Outcome told = run("explain " + scene, kShipped);
  EXPECT_TRUE(has(told.text, "features 16 to 19: as1/rod-assembly_1/rod_1, faces")) << told.text;
  EXPECT_FALSE(has(told.text, "plate_1")) << told.text;
}

TEST_F(ImportCommands, ExplainNamesTheFacesThatWereTouchedInARecording) {
  const std::string file = (dir_ / "run.h5").string(), scene = HAPTICD_SOURCE_DIR "/config/scenes/as1.yaml";
  const Outcome ran = run("run " + scene + " --for 3 --virtual-time --record " + file, kShipped);
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  const Outcome told = run("explain " + file);
  EXPECT_TRUE(has(told.text, "touched\n  rod: as1/rod-assembly_1/rod_1: face ")) << told.text;
}

TEST_F(ImportCommands, CheckWarnsOfAWallThatAPressGoesThrough) {
  const std::string box =
      "v 0 0 0\nv 60 0 0\nv 60 40 0\nv 0 40 0\nv 0 0 2\nv 60 0 2\nv 60 40 2\nv 0 40 2\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::string part = (dir_ / "plate.hpart").string();
  ASSERT_EQ(run("import " + put("plate.obj", box) + " --scale 0.001 -o " + part).exit_code, 0);
  const auto check = [&](const char* stiffness) {
    return run("check " + put("scene.yaml", std::string("hapticd: 1\nmodels:\n  - {name: plate, plugin: nurbs_rigid, "
                                                        "parameters: {geometry: plate.hpart, stiffness: ") +
                                                stiffness + "}}\n"),
               kShipped);
  };
  const Outcome soft = check("800");
  EXPECT_EQ(soft.exit_code, 0) << soft.text;
  EXPECT_TRUE(has(soft.text, "a wall is 2 mm thick")) << soft.text;
  EXPECT_TRUE(has(soft.text, "the contact is held all the same, and stiffness: 1100 keeps the tip inside"))
      << soft.text;
  EXPECT_FALSE(has(check("1100").text, "thick")) << "what is advised is enough";
  EXPECT_TRUE(has(check("800, contact_hysteresis: 0.001").text, "contact_hysteresis is smaller: leave it out"));
  EXPECT_FALSE(has(check("6000").text, "thick"));
  EXPECT_FALSE(has(check("800, tip_radius: 0.003").text, "thick")) << "the tip stays in front of the plate";
  const Outcome ball = check("400, tip_radius: 0.0015");
  EXPECT_TRUE(has(ball.text, "the 1.5 mm of tip_radius, so the tip comes out behind; ")) << ball.text;
  EXPECT_TRUE(has(ball.text, "stiffness: 590 keeps the tip inside")) << ball.text;
  EXPECT_FALSE(has(check("590, tip_radius: 0.0015").text, "thick")) << "what is advised is enough";
}

TEST_F(ImportCommands, AWallThatNoStiffnessMendsIsNoWarning) {
  const std::string foil =
      "v 0 0 0\nv 60 0 0\nv 60 40 0\nv 0 40 0\nv 0 0 .1\nv 60 0 .1\nv 60 40 .1\nv 0 40 .1\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::string part = (dir_ / "foil.hpart").string();
  ASSERT_EQ(run("import " + put("foil.obj", foil) + " --scale 0.001 -o " + part).exit_code, 0);
  const Outcome told = run("check " + put("scene.yaml",
                                          "hapticd: 1\nmodels:\n  - {name: foil, plugin: nurbs_rigid, parameters: "
                                          "{geometry: foil.hpart}}\n"),
                           kShipped);
  EXPECT_FALSE(has(told.text, "thick")) << told.text;
  const Outcome explained = run("explain " + (dir_ / "scene.yaml").string(), kShipped);
  EXPECT_TRUE(has(explained.text, "a wall is 0.1 mm thick")) << explained.text;
  EXPECT_TRUE(has(explained.text, "few arms render a stiffness that is enough, but the contact is held"))
      << explained.text;
}

TEST_F(ImportCommands, TheFirstSlipOfAnImportIsTold) {
  const std::string triangle = "# by hand\no a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto told = [&](const std::string& words) { return run("import " + words).text; };
  EXPECT_TRUE(has(told("nothere.stl"), "nothere.stl: there is no such file"));
  EXPECT_TRUE(has(told(put("x.stl", triangle)), "is a mesh (OBJ), by its first bytes, and its name ends in '.stl'"));
  for (const char* empty : {"empty.step", "empty.igs", "empty.brep", "empty.stl"})
    EXPECT_TRUE(has(told(put(empty, "")), std::string(empty) + ": is empty")) << empty;
  std::string binary(84 + 50, '\0');
  binary[80] = 1;  // the number of its triangles
  EXPECT_TRUE(has(told(put("binary.obj", binary)), "is a mesh (binary STL), by its first bytes"));
  EXPECT_TRUE(
      has(told("--medial " + put("x.step", "ISO-10303-21;\n") + " x.ma"), "--medial takes a closed surface of"));
  EXPECT_TRUE(
      has(told("--medial " HAPTICD_SOURCE_DIR "/config/models/dm1.hpart x.ma"), "not a part\n  fix: give it the mesh"));
  const std::string open = told("--medial " + put("x.obj", triangle) + " " + (dir_ / "x.ma").string());
  EXPECT_TRUE(has(open, "the surface is not closed: 3 edges are at a hole")) << open;
  EXPECT_TRUE(has(open, "without --medial, import lists the holes")) << open;
}

TEST_F(ImportCommands, AnInstanceOfAMeshFileIsNotCalledOneOfAModelFile) {
  put("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome told = run("check " + put("scene.yaml",
                                          "hapticd: 1\nmodels:\n  - {name: x, plugin: nurbs_rigid, parameters: "
                                          "{geometry: x.obj, instance: Brick}}\n"),
                           kShipped);
  EXPECT_TRUE(has(told.text, "a mesh (OBJ), expected YAML: convert it")) << told.text;
  EXPECT_FALSE(has(told.text, "is a model file")) << told.text;
}

}  // namespace
}  // namespace hapticd::test
