// SPDX-License-Identifier: MIT
#include "control/request.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace hapticd::control {
namespace {

TEST(Request, TakesWhatTheManualSays) {
  for (const char* line :
       {R"({"do":"status"})", R"({"do":"list"})", R"({"do":"dump"})", R"({"do":"stop"})", R"({"do":"reload"})",
        R"({"do":"enable","model":"a"})", R"({"do":"disable","model":"a"})", R"({"do":"remove","model":"a"})",
        R"({"do":"add","file":"/a.yaml"})", R"({"do":"add","file":"/a.yaml","model":"b"})", R"({"do":"hold"})",
        R"({"do":"clear","device":"arm"})", R"({"do":"geometry","model":"a"})",
        R"({"do":"geometry","model":"a","tolerance":0.001})", R"({"do":"geometry","model":"a","triangles":1000})",
        R"({"do":"vertices","model":"a"})", R"({"do":"vertices","model":"a","after":3})",
        R"({"do":"feature","model":"a","number":7})", R"({"do":"mark","text":"trial 7 begins"})"})
    EXPECT_TRUE(parseRequest(line)) << line;
  const auto set = parseRequest(R"({"do":"set","model":"a","parameter":"k","value":600,"consent":true})");
  ASSERT_TRUE(set);
  EXPECT_EQ(set->value, 600);
  EXPECT_TRUE(set->consent);
  const auto move = parseRequest(R"({"do":"move","model":"a","position":[1,2,3],"orientation":[0,1,0,0],"seconds":2})");
  ASSERT_TRUE(move);
  EXPECT_EQ(move->position[2], 3);
  EXPECT_EQ(move->orientation[1], 1);
  EXPECT_EQ(*move->seconds, 2);
}

/// Requests that are refused, each with a part of the answer.
using Wrong = std::vector<std::pair<const char*, const char*>>;

void expectRefused(const Wrong& wrong) {
  for (const auto& [line, part] : wrong) {
    const auto request = parseRequest(line);
    ASSERT_FALSE(request) << line;
    EXPECT_NE(request.error().find(part), std::string::npos) << line << ": " << request.error();
  }
}

TEST(Request, SaysWhatIsWrongAndWhatWasExpected) {
  expectRefused({
      {"", "JSON object"},
      {"[]", "the line is an array: expected one JSON object"},
      {"null", "the line is null: expected"},
      {"{", "JSON object"},
      {R"({"do":"dance"})", "expected one of status"},
      {R"({"do":1})", "expected one of"},
      {R"({"do":"mark"})", "\"text\" is missing in \"mark\", expected 1 to 95 bytes of UTF-8"},
      {R"({"do":"mark","text":7})", "\"text\": expected 1 to 95 bytes of UTF-8 in one line"},
      {R"({"do":"mark","text":"a\u0000b"})", "\"text\": expected 1 to 95 bytes of UTF-8 in one line"},
      {R"({"do":"enable"})", "\"model\" is missing in \"enable\", expected the name of a model"},
      {R"({"do":"move","model":"a"})", "\"position\" is missing in \"move\", expected a list of 3 numbers [x, y, z]"},
      {R"({"do":"enable","model":""})", "expected the name of a model, 1 to 4096 bytes of text"},
      {R"({"do":"enable","model":3})", "expected the name of a model, 1 to 4096 bytes of text, got 3"},
      {R"({"do":"enable","model":"a\u0000b"})", "zero bytes"},
      {R"({"do":"status","modle":"a"})", "\"modle\" is not a key of \"status\", expected no other key"},
      {R"({"do":"set","model":"a","parameter":"k","value":"1"})", "\"value\": expected a number without quotes"},
      {R"({"do":"set","model":"a","parameter":"k","value":null})", "or a word in quotes such as \"true\", got null"},
      {R"({"do":"set","model":"a","parameter":"k","value":1e999})", "JSON object"},
      {R"({"do":"set","model":"a","parameter":"k","value":1,"consent":1})", "true or false"},
      {R"({"do":"move","model":"a","position":[1,2]})",
       "a list of 3 numbers [x, y, z] from -10 to 10 m, world frame, got [1,2]"},
      {R"({"do":"move","model":"a","position":[1,2,11]})", "from -10 to 10 m"},
      {R"({"do":"move","model":"a","position":[1,2,null]})", "list of 3"},
      {R"({"do":"move","model":"a","position":[0,0,0],"orientation":[1,1,0,0]})", "unit quaternion"},
      {R"({"do":"move","model":"a","position":[0,0,0],"seconds":0})", "from 0.05"},
      {R"({"do":"add","file":"a.yaml"})", "absolute path"},
      {R"({"do":"geometry"})", "\"model\" is missing"},
      {R"({"do":"geometry","model":"a","tolerance":0})", "\"tolerance\": expected a number"},
      {R"({"do":"geometry","model":"a","triangles":999})", "\"triangles\": expected a whole number from 1000"},
      {R"({"do":"geometry","model":"a","triangles":1000.5})", "\"triangles\": expected a whole number from 1000"},
      {R"({"do":"vertices"})", "\"model\" is missing"},
      {R"({"do":"feature","model":"a"})", "\"number\" is missing"},
      {R"({"do":"feature","model":"a","number":-1})",
       "\"number\": expected the number of a surface or feature, a whole number from 0 to 4294967295, got -1"},
      {R"({"do":"feature","model":"a","number":5e9})", "a whole number from 0"},
      {R"({"do":"feature","model":"a","number":1.5})", "a whole number from 0"},
      {R"({"do":"vertices","model":"a","after":-1})", "\"after\": expected a whole number"},
      {R"({"do":"vertices","model":"a","after":0.5})", "\"after\": expected a whole number"},
      {R"({"do": status})", "the line is not valid JSON at byte 8"},
      {R"({"a":{"a":{"a":{"a":{"a":{"a":{"a":{"a":{"a":{"a":1}}}}}}}}}})", "JSON object"},
  });
}

TEST(Request, SuggestsTheWordThatWasMeantAndNamesEveryFault) {
  expectRefused({
      {R"({"do":"dsable","model":"a"})", "got \"dsable\" (did you mean \"disable\"?)"},
      {R"({"do":"enable","modle":"a"})",
       "\"modle\" is not a key of \"enable\" (did you mean \"model\"?), expected the keys model"},
      {R"({"do":"move","model":"a","position":[1,2,11],"seconds":1000})",
       "got [1,2,11]; \"seconds\": expected a number from 0.05 to 600 s, got 1000"},
  });
}

/// One reader of JSON takes the first of two keys, another the last: what was checked might not be what is done.
TEST(Request, RefusesAKeyThatStandsThereTwice) {
  const auto twice = parseRequest(R"({"do":"status","do":"stop"})");
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().find("\"do\" is given twice"), std::string::npos) << twice.error();
  EXPECT_FALSE(parseRequest(R"({"do":"set","model":"a","parameter":"k","value":1,"value":2})"));
  EXPECT_TRUE(parseRequest(R"({"do":"set","model":"a","parameter":"k","value":1})"));
}

TEST(Request, RefusesMoreThanItReads) {
  const std::string deep(40000, '[');
  EXPECT_FALSE(parseRequest(deep));
  const std::string large = R"({"do":"enable","model":")" + std::string(kMaxRequestBytes, 'x') + "\"}";
  EXPECT_NE(parseRequest(large).error().find("expected at most 65536"), std::string::npos);
}

/// The answer names a few of the wrong keys only: its size must not grow with the request.
TEST(Request, NamesAFewOfManyWrongKeys) {
  std::string line = R"({"do":"status")";
  for (int i = 0; i < 4000; ++i) line += ",\"k" + std::to_string(i) + "\":0";
  const auto request = parseRequest(line + "}");
  ASSERT_FALSE(request);
  EXPECT_LT(request.error().size(), 400u);
  EXPECT_NE(request.error().find("3995 others"), std::string::npos) << request.error();
}

}  // namespace
}  // namespace hapticd::control
