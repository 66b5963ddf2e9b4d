// SPDX-License-Identifier: MIT
#include "record/hdf5.hpp"

#include <bit>
#include <type_traits>

namespace hapticd::record::hdf5 {

namespace {

static_assert(std::endian::native == std::endian::little, "rows are stored as they lie in memory");

// Message types of an object header.
constexpr uint8_t kDataspace = 1, kLinkInfo = 2, kDatatype = 3, kFillValue = 5, kLink = 6, kLayout = 8, kGroupInfo = 10,
                  kAttribute = 12, kContinuation = 16;

/// Appends little-endian numbers to a text.
class Bytes {
 public:
  template <class T>
  Bytes& n(T value) {
    static_assert(std::is_integral_v<T>);
    for (size_t i = 0; i < sizeof value; ++i) text_ += static_cast<char>(static_cast<uint64_t>(value) >> (8 * i));
    return *this;
  }
  Bytes& u8(uint32_t value) { return n(static_cast<uint8_t>(value)); }
  Bytes& u16(size_t value) { return n(static_cast<uint16_t>(value)); }
  Bytes& u32(uint64_t value) { return n(static_cast<uint32_t>(value)); }
  Bytes& u64(uint64_t value) { return n(value); }
  Bytes& text(const std::string& value) {
    text_ += value;
    return *this;
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string message(uint8_t type, const std::string& body) {
  return Bytes().u8(type).u16(body.size()).u8(0).text(body).take();
}

std::string withChecksum(std::string bytes) {
  const uint32_t sum = checksum(bytes);
  return Bytes().text(bytes).u32(sum).take();
}

/// Returns an object header of version 2. The flags are 2, which means that its size field has four bytes.
std::string objectHeader(const std::string& messages) {
  return withChecksum(Bytes().text("OHDR").u8(2).u8(2).u32(messages.size()).text(messages).take());
}

std::string textType(uint64_t length) {
  constexpr uint32_t kNullPaddedUtf8 = 0x11;
  return Bytes().u8(0x13).u8(kNullPaddedUtf8).u8(0).u8(0).u32(length).take();
}

std::string valueType(ColumnType type) {
  if (type == ColumnType::kText) return textType(kTextBytes);
  const uint32_t bytes = bytesOf(type), bits = 8 * bytes;
  if (type == ColumnType::kReal || type == ColumnType::kReal32) {
    // class 1, version 1: little-endian IEEE numbers with an implied first bit of the mantissa and the sign in the top
    // bit
    const bool wide = type == ColumnType::kReal;
    return Bytes()
        .u8(0x11)
        .u8(0x20)
        .u8(bits - 1)
        .u8(0)
        .u32(bytes)
        .u16(0)
        .u16(bits)
        .u8(wide ? 52 : 23)
        .u8(wide ? 11 : 8)
        .u8(0)
        .u8(wide ? 52 : 23)
        .u32(wide ? 1023 : 127)
        .take();
  }
  const uint32_t is_signed = type == ColumnType::kInt ? 8 : 0;
  return Bytes().u8(0x10).u8(is_signed).u8(0).u8(0).u32(bytes).u16(0).u16(bits).take();
}

/// Returns a compound type of version 3. Offsets of members have as many bytes as the row's size needs.
std::string compoundType(const RowLayout& layout) {
  const uint32_t size = layout.rowBytes();
  const int offset_bytes = size < 0x100 ? 1 : size < 0x10000 ? 2 : 3;
  Bytes type;
  type.u8(0x36).u16(layout.columns().size()).u8(0).u32(size);
  for (const Column& column : layout.columns()) {
    type.text(column.name).u8(0);
    for (int i = 0; i < offset_bytes; ++i) type.u8(column.offset >> (8 * i));
    type.text(valueType(column.type));
  }
  return type.take();
}

std::string scalarSpace() {
  return Bytes().u8(2).u8(0).u8(0).u8(0).take();
}

std::string attribute(const std::string& name, const std::string& value) {
  const std::string type = textType(std::max<size_t>(value.size(), 1)), space = scalarSpace();
  Bytes body;
  body.u8(3)
      .u8(0)
      .u16(name.size() + 1)
      .u16(type.size())
      .u16(space.size())
      .u8(1)
      .text(name)
      .u8(0)
      .text(type)
      .text(space);
  return message(kAttribute, body.text(value.empty() ? std::string(1, '\0') : value).take());
}

uint32_t rotate(uint32_t x, int by) {
  return std::rotl(x, by);
}

}  // namespace

uint32_t checksum(const std::string& bytes) {
  const auto* k = reinterpret_cast<const unsigned char*>(bytes.data());
  size_t length = bytes.size();
  uint32_t a = 0xdeadbeef + static_cast<uint32_t>(length), b = a, c = a;
  const auto word = [](const unsigned char* p, size_t count) {
    uint32_t value = 0;
    for (size_t i = 0; i < count && i < 4; ++i) value |= static_cast<uint32_t>(p[i]) << (8 * i);
    return value;
  };
  for (; length > 12; length -= 12, k += 12) {
    a += word(k, 4), b += word(k + 4, 4), c += word(k + 8, 4);
    a -= c, a ^= rotate(c, 4), c += b;
    b -= a, b ^= rotate(a, 6), a += c;
    c -= b, c ^= rotate(b, 8), b += a;
    a -= c, a ^= rotate(c, 16), c += b;
    b -= a, b ^= rotate(a, 19), a += c;
    c -= b, c ^= rotate(b, 4), b += a;
  }
  if (length == 0) return c;
  a += word(k, length);
  if (length > 4) b += word(k + 4, length - 4);
  if (length > 8) c += word(k + 8, length - 8);
  c ^= b, c -= rotate(b, 14);
  a ^= c, a -= rotate(c, 11);
  b ^= a, b -= rotate(a, 25);
  c ^= b, c -= rotate(b, 16);
  a ^= c, a -= rotate(c, 4);
  b ^= a, b -= rotate(a, 14);
  c ^= b, c -= rotate(b, 24);
  return c;
}

std::string superblock(uint64_t root_address, uint64_t end_of_file) {
  Bytes bytes;
  bytes.text(std::string("\x89HDF\r\n\x1a\n", 8)).u8(2).u8(8).u8(8).u8(0);
  return withChecksum(bytes.u64(0).u64(kNowhere).u64(end_of_file).u64(root_address).take());
}

std::string group(const std::vector<Link>& links, const std::vector<std::pair<std::string, std::string>>& attributes) {
  std::string messages = message(kLinkInfo, Bytes().u8(0).u8(0).u64(kNowhere).u64(kNowhere).take()) +
                         message(kGroupInfo, Bytes().u8(0).u8(0).take());
  for (const Link& link : links)
    messages += message(
        kLink,
        Bytes().u8(1).u8(0).u8(static_cast<uint32_t>(link.name.size())).text(link.name).u64(link.address).take());
  for (const auto& [name, value] : attributes) messages += attribute(name, value);
  return objectHeader(messages);
}

std::string textDataset(uint64_t address, uint64_t length) {
  constexpr uint32_t kNoFill = 0x0A;  // the data are written at once
  return objectHeader(message(kDataspace, scalarSpace()) + message(kDatatype, textType(length)) +
                      message(kFillValue, Bytes().u8(3).u8(kNoFill).take()) +
                      message(kLayout, Bytes().u8(3).u8(1).u64(address).u64(length).take()));
}

std::string TableHeader::bytes() const {
  constexpr uint32_t kGrowingFill = 0x0B;  // space is allocated when it is needed, and is zero until it is written
  return objectHeader(
      message(kDataspace, Bytes().u8(2).u8(1).u8(1).u8(1).u64(rows).u64(UINT64_MAX).take()) +
      message(kFillValue, Bytes().u8(3).u8(kGrowingFill).take()) +
      message(kLayout, Bytes().u8(3).u8(2).u8(2).u64(index_address).u32(chunk_rows).u32(row_bytes).take()) +
      message(kContinuation, Bytes().u64(description_address).u64(description_bytes).take()));
}

std::string tableDescription(const RowLayout& layout) {
  return withChecksum("OCHK" + message(kDatatype, compoundType(layout)));
}

uint64_t ChunkIndex::fullChild(size_t level) const {
  uint64_t rows = chunk_rows_;
  for (size_t i = 0; i < level; ++i) rows *= kFanOut;
  return rows;
}

std::string ChunkIndex::bytes(size_t level) const {
  const Node& node = levels_[level];
  const auto key = [&](Bytes& out, uint64_t row) { out.u32(chunk_bytes_).u32(0).u64(row).u64(0); };
  Bytes out;
  out.text("TREE").u8(1).u8(static_cast<uint32_t>(level)).u16(node.entries.size()).u64(node.left).u64(node.right);
  for (const auto& [row, child] : node.entries) {
    key(out, row);
    out.u64(child);
  }
  // the key after the last child is its upper bound; in a full node, it is the first key of the right neighbour
  key(out, node.right == kNowhere ? (chunks_ + 1) * chunk_rows_ : node.entries.back().first + fullChild(level));
  std::string text = out.take();
  text.resize(kNodeBytes, '\0');
  return text;
}

}  // namespace hapticd::record::hdf5
