// SPDX-License-Identifier: MIT
#include "control/request.hpp"

#include <gtest/gtest.h>

namespace hapticd::control {
namespace {

TEST(Request, TakesWhatTheManualSays) {
  for (const char* line :
       {R"({"do":"status"})", R"({"do":"list"})", R"({"do":"dump"})", R"({"do":"stop"})", R"({"do":"reload"})",
        R"({"do":"enable","model":"a"})", R"({"do":"disable","model":"a"})", R"({"do":"remove","model":"a"})",
        R"({"do":"add","file":"/a.yaml"})", R"({"do":"add","file":"/a.yaml","model":"b"})", R"({"do":"hold"})",
        R"({"do":"clear","device":"arm"})", R"({"do":"geometry","model":"a"})",
        R"({"do":"geometry","model":"a","tolerance":0.001})", R"({"do":"vertices","model":"a"})",
        R"({"do":"vertices","model":"a","after":3})", R"({"do":"feature","model":"a","number":7})"})
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

TEST(Request, SaysWhatIsWrongAndWhatWasExpected) {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "JSON object"},
      {"[]", "JSON object"},
      {"{", "JSON object"},
      {R"({"do":"dance"})", "expected one of status"},
      {R"({"do":1})", "expected one of"},
      {R"({"do":"enable"})", "\"model\" is missing"},
      {R"({"do":"enable","model":""})", "text of 1"},
      {R"({"do":"enable","model":3})", "text of 1"},
      {R"({"do":"enable","model":"a\u0000b"})", "zero bytes"},
      {R"({"do":"status","modle":"a"})", "not part of"},
      {R"({"do":"set","model":"a","parameter":"k","value":"1"})", "\"value\": expected a number"},
      {R"({"do":"set","model":"a","parameter":"k","value":1e999})", "JSON object"},
      {R"({"do":"set","model":"a","parameter":"k","value":1,"consent":1})", "true or false"},
      {R"({"do":"move","model":"a","position":[1,2]})", "list of 3"},
      {R"({"do":"move","model":"a","position":[1,2,11]})", "within 10"},
      {R"({"do":"move","model":"a","position":[1,2,null]})", "list of 3"},
      {R"({"do":"move","model":"a","position":[0,0,0],"orientation":[1,1,0,0]})", "unit quaternion"},
      {R"({"do":"move","model":"a","position":[0,0,0],"seconds":0})", "from 0.05"},
      {R"({"do":"add","file":"a.yaml"})", "absolute path"},
      {R"({"do":"geometry"})", "\"model\" is missing"},
      {R"({"do":"geometry","model":"a","tolerance":0})", "\"tolerance\": expected a number"},
      {R"({"do":"vertices"})", "\"model\" is missing"},
      {R"({"do":"feature","model":"a"})", "\"number\" is missing"},
      {R"({"do":"feature","model":"a","number":-1})",
       "\"number\": expected a whole number from 0 to 4294967295, got -1"},
      {R"({"do":"feature","model":"a","number":5e9})", "\"number\": expected a whole number"},
      {R"({"do":"feature","model":"a","number":1.5})", "\"number\": expected a whole number"},
      {R"({"do":"vertices","model":"a","after":-1})", "\"after\": expected a whole number"},
      {R"({"do":"vertices","model":"a","after":0.5})", "\"after\": expected a whole number"},
      {R"({"do": status})", "column 8 is not valid JSON"},
      {R"({"do":"dsable","model":"a"})", "got \"dsable\" (did you mean \"disable\"?)"},
      {R"({"do":"enable","modle":"a"})", "expected model (did you mean \"model\"?)"},
      {R"({"do":"move","model":"a","position":[1,2,11],"seconds":1000})",
       "within 10 m of 0, got [1,2,11]; \"seconds\": expected a number from 0.05 to 600 s, got 1000"},
      {R"({"a":{"a":{"a":{"a":{"a":{"a":{"a":{"a":{"a":{"a":1}}}}}}}}}})", "JSON object"}};
  for (const auto& [line, part] : wrong) {
    const auto request = parseRequest(line);
    ASSERT_FALSE(request) << line;
    EXPECT_NE(request.error().find(part), std::string::npos) << line << ": " << request.error();
  }
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
  EXPECT_NE(parseRequest(large).error().find("longer than"), std::string::npos);
}

}  // namespace
}  // namespace hapticd::control
