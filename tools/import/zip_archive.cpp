#include "import/zip_archive.h"

#include <zlib.h>

#include <cstring>
#include <new>

#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr uint64_t kMostBytes = uint64_t(1) << 31;
constexpr size_t kEnd = 22, kEndLocator = 20, kListed = 46, kLocal = 30;

}  // namespace

template <class Number>
Number ZipArchive::at(uint64_t offset) const {
  if (offset > bytes_.size() || bytes_.size() - offset < sizeof(Number)) {
    refuse("", "expected a zip archive, got one that ends early");
  }
  Number number{};
  std::memcpy(&number, bytes_.data() + offset, sizeof number);
  return number;
}

void ZipArchive::refuse(const std::string& place, const std::string& problem) const {
  throw InputError(*file_, printable(place), problem);
}

ZipArchive::ZipArchive(const std::string& file, std::string_view bytes) : file_(&file), bytes_(bytes) {
  const size_t end = bytes.rfind("PK\5\6");
  if (end == bytes.npos) refuse("", "expected a zip archive, got another file, or one that is cut off");
  uint64_t count = at<uint16_t>(end + 10), next = at<uint32_t>(end + 16);
  if (end >= kEndLocator && bytes.substr(end - kEndLocator, 4) == "PK\6\7") {
    const auto end64 = at<uint64_t>(end - kEndLocator + 8);
    count = at<uint64_t>(end64 + 32);
    next = at<uint64_t>(end64 + 48);
  }
  for (; count > 0; --count) {
    if (at<uint32_t>(next) != 0x02014b50) refuse("", "expected a zip archive's list of files, got other bytes");
    Entry entry{at<uint32_t>(next + 42), at<uint32_t>(next + 20), at<uint32_t>(next + 24),
                at<uint16_t>(next + 10), at<uint16_t>(next + 8),  at<uint32_t>(next + 16)};
    const uint64_t name = at<uint16_t>(next + 28), extra = at<uint16_t>(next + 30), remark = at<uint16_t>(next + 32);
    at<char>(next + kListed + name + extra);  // the archive's end follows
    const uint64_t extraEnd = next + kListed + name + extra;
    for (uint64_t field = next + kListed + name; field + 4 <= extraEnd; field += 4 + at<uint16_t>(field + 2)) {
      if (at<uint16_t>(field) != 1) continue;  // 64-bit numbers in place of those that are all ones
      uint64_t number = field + 4;
      for (uint64_t* value : {&entry.size, &entry.packed, &entry.offset}) {
        if (*value != UINT32_MAX) continue;
        *value = at<uint64_t>(number);
        number += sizeof(uint64_t);
      }
    }
    entries_[std::string(bytes.substr(next + kListed, name))] = entry;
    next = extraEnd + remark;
  }
}

std::string ZipArchive::read(const std::string& name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) refuse("", "expected a file \"" + printable(name) + "\" in it, got none");
  const Entry& entry = found->second;
  if (entry.flags & 1) refuse(name, "expected a file that is not encrypted");
  if (entry.method != 0 && entry.method != Z_DEFLATED) {
    refuse(name, "expected a file that is stored or deflated, got method " + std::to_string(entry.method));
  }
  if (entry.size > kMostBytes) refuse(name, "expected at most 2 GiB, got " + std::to_string(entry.size) + " bytes");
  at<char>(entry.offset);
  const uint64_t data = entry.offset + kLocal + at<uint16_t>(entry.offset + 26) + at<uint16_t>(entry.offset + 28);
  if (data > bytes_.size() || entry.packed > bytes_.size() - data || entry.packed > UINT32_MAX) {
    refuse(name, "expected " + std::to_string(entry.packed) + " bytes, the archive ends");
  }
  constexpr uint64_t kMostFromByte = 1032;  // of deflate
  if (entry.size / kMostFromByte > entry.packed) refuse(name, "expected a file that can be inflated");
  const std::string_view packed = bytes_.substr(data, entry.packed);
  std::string content(entry.size, '\0');
  if (entry.method == 0) {
    content = packed;
  } else {
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(content.data());
    stream.avail_out = static_cast<uInt>(content.size());
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    const int end = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (end != Z_STREAM_END || stream.avail_out != 0) refuse(name, "expected a file that can be inflated");
  }
  if (content.size() != entry.size ||
      crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()) != entry.check) {
    refuse(name, "expected a file with the checksum that the archive gives");
  }
  return content;
}

}  // namespace radar::tools
