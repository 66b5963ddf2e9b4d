// SPDX-License-Identifier: MIT
/// The JSON Schema of a wire format, for editors. readWire() checks the rules that the schema cannot express, such as
/// that the fields fit into the report and that each joint has one position.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace hapticd::codec {

inline constexpr char kSchemaBegin[] = R"json({
  "type": "object", "additionalProperties": false, "required": ["rate", "input", "output"],
  "properties": {
    "exchange": {"enum": ["stream", "poll"], "default": "stream", "description": "stream: the arm sends by itself; poll: it answers each command"},
    "rate": {"type": "number", "minimum": 50, "maximum": 20000, "description": "reports a second [Hz]"},
    "watchdog": {"type": "number", "minimum": 0, "maximum": 10, "default": 0, "description": "after this time the hardware cuts its motors [s]; 0: it does not"},
    "endpoints": {"type": "object", "additionalProperties": false, "required": ["in", "out"], "properties": {
      "in": {"type": "integer", "minimum": 129, "maximum": 143}, "out": {"type": "integer", "minimum": 1, "maximum": 15}}},
    "framing": {"type": "object", "additionalProperties": false, "description": "reports inside a stream of bytes", "properties": {
      "header": {"type": "integer", "minimum": 0, "maximum": 1023, "description": "bytes to skip at the head of each packet"},
      "packet": {"type": "integer", "minimum": 8, "maximum": 1024, "default": 64},
      "start": {"type": "integer", "minimum": 0, "maximum": 255}, "end": {"type": "integer", "minimum": 0, "maximum": 255},
      "escape": {"type": "object", "additionalProperties": false, "required": ["mark"], "properties": {
        "mark": {"type": "integer", "minimum": 0, "maximum": 255}, "xor": {"type": "integer", "minimum": 1, "maximum": 255, "default": 32},
        "bytes": {"type": "array", "maxItems": 16, "items": {"type": "integer", "minimum": 0, "maximum": 255}},
        "codes": {"type": "array", "minItems": 1, "maxItems": 8, "items": {"type": "array", "minItems": 2, "maxItems": 2,
          "items": {"type": "integer", "minimum": 0, "maximum": 255}}}}}}},
    "startup": {"type": "array", "maxItems": 64, "items": {"type": "object", "additionalProperties": false, "properties": {
      "control": {"type": "object", "additionalProperties": false, "required": ["type", "request"], "properties": {
        "type": {"type": "integer", "minimum": 0, "maximum": 127}, "request": {"type": "integer", "minimum": 0, "maximum": 255},
        "value": {"type": "integer", "minimum": 0, "maximum": 65535}, "index": {"type": "integer", "minimum": 0, "maximum": 65535}}},
      "send": {"type": "array", "items": {"type": "integer", "minimum": 0, "maximum": 255}},
      "expect": {"type": "array", "items": {"type": "integer", "minimum": 0, "maximum": 255}},
      "tries": {"type": "integer", "minimum": 1, "maximum": 1000}, "wait": {"type": "number", "minimum": 0, "maximum": 10},
      "timeout": {"type": "number", "minimum": 0.001, "maximum": 10}}}},
)json";

inline constexpr char kReportBegin[] =
    R"json({"type": "object", "additionalProperties": false, "required": ["size", "fields"], "properties": {
      "id": {"type": "integer", "minimum": 1, "maximum": 255}, "size": {"type": "integer", "minimum": 1, "maximum": 1023, "description": "bytes without the report id"},
      "fields": {"type": "array", "items": {"type": "object", "additionalProperties": false, "required": ["is", "type"], "properties": {
        "is": {"enum": [)json";
inline constexpr char kInputMeanings[] =
    R"json("position", "velocity", "torque", "button", "sequence", "counter", "starts", "time", "fault", "calibrated", "firmware", "constant", "checksum")json";
inline constexpr char kOutputMeanings[] =
    R"json("torque", "reference", "enable", "follow", "calibrate", "sequence", "counter", "firmware", "constant", "checksum")json";
inline constexpr char kReportEnd[] = R"json(]},
        "joint": {"type": "integer", "minimum": 1, "maximum": 16}, "button": {"type": "integer", "minimum": 1, "maximum": 32, "description": "counted from 1; limits.enable.button counts from 0"},
        "at": {"type": "integer", "minimum": 0, "maximum": 1022, "description": "first byte, counted after the report id"},
        "bit_offset": {"type": "integer", "minimum": 0, "maximum": 8183, "description": "bits to skip from there: little endian from the lowest, big endian from the highest"},
        "type": {"type": "string", "pattern": "^(u([1-9]|[1-5][0-9]|6[0-4])|i([2-9]|[1-5][0-9]|6[0-4])|f32|f64|nibbles?)$", "description": "uN or iN: unsigned or signed integer of N bits, such as u16; f32 or f64: floating point; nibble or nibbles: one or four characters of the Falcon with four bits each"},
        "endian": {"enum": ["little", "big"], "default": "little"},
        "bit": {"type": "integer", "minimum": 0, "maximum": 63}, "inverted": {"type": "boolean", "default": false},
        "scale": {"type": "number"}, "offset": {"type": "number"}, "scale_degrees": {"type": "number"}, "offset_degrees": {"type": "number"},
        "limit": {"type": "number", "minimum": 0, "description": "largest raw number that is sent"}, "wraps": {"type": "boolean", "default": false},
        "value": {"type": "number"}, "modulo": {"type": "integer", "minimum": 2, "maximum": 4294967296, "description": "a counter runs from 0 to modulo - 1"},
        "method": {"type": "string", "pattern": "^(sum8?|xor8?|crc[0-9a-z-]*)$", "description": "sum, xor, crc with its numbers, or a published CRC by name: crc8, crc16-modbus, crc32"},
        "from": {"type": "integer", "minimum": 0}, "to": {"type": "integer", "minimum": 1}, "word": {"type": "integer", "minimum": 1, "maximum": 8},
        "polynomial": {"type": "integer", "minimum": 0}, "initial": {"type": "integer", "minimum": 0}, "final_xor": {"type": "integer", "minimum": 0},
        "reflected": {"type": "boolean", "default": false}, "negated": {"type": "boolean", "default": false},
        "over_id": {"type": "boolean", "default": false, "description": "the checksum begins with the report id"}}}}}})json";

/// Returns the texts as one.
template <std::size_t... kSizes>
constexpr auto joined(const char (&... texts)[kSizes]) {
  std::array<char, (0 + ... + (kSizes - 1)) + 1> whole{};
  auto end = whole.begin();
  ((end = std::copy_n(texts, kSizes - 1, end)), ...);
  return whole;
}

inline constexpr auto kWireSchemaText =
    joined(kSchemaBegin, "    \"input\": ", kReportBegin, kInputMeanings, kReportEnd,
           ",\n    \"output\": ", kReportBegin, kOutputMeanings, kReportEnd, "\n  }\n}");

/// The schema as one text, for the choices of an HSP_DATA in a parameter table (hsp_param::choices).
inline constexpr const char* kWireSchema[] = {kWireSchemaText.data()};

}  // namespace hapticd::codec
