// 3MF files that tests write: zip archives.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace radar::test {

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A zip archive: `deflated`, or stored; `streamed`: sizes are zero in front of a file's bytes, and 64-bit in the list.
inline std::string zipOf(const std::vector<std::pair<std::string, std::string>>& files, bool deflated, bool streamed) {
  std::string bytes, list;
  for (const auto& file : files) {
    const std::string &name = file.first, &content = file.second;
    std::string packed = content;
    if (deflated) {
      uLongf size = compressBound(content.size());
      packed.resize(size);
      compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(content.data()),
               content.size());
      packed = packed.substr(2, size - 6);  // without zlib's head and checksum
    }
    const auto check =
        static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())));
    const auto offset = static_cast<uint32_t>(bytes.size());
    const auto head = [&](std::string& to, bool isListed) {
      append(to, uint32_t(isListed ? 0x02014b50 : 0x04034b50));
      if (isListed) append(to, uint16_t(45));
      append(to, uint16_t(45));
      append(to, uint16_t(streamed ? 8 : 0));
      append(to, uint16_t(deflated ? 8 : 0));
      append(to, uint32_t(0));  // when
      append(to, isListed || !streamed ? check : 0u);
      append(to, streamed ? (isListed ? UINT32_MAX : 0u) : uint32_t(packed.size()));
      append(to, streamed ? (isListed ? UINT32_MAX : 0u) : uint32_t(content.size()));
      append(to, uint16_t(name.size()));
    };
    head(bytes, false);
    append(bytes, uint16_t(0));
    bytes += name + packed;
    head(list, true);
    append(list, uint16_t(streamed ? 20 : 0));
    list.append(10, '\0');  // no remark, where the archive begins, what kind of file
    append(list, offset);
    list += name;
    if (!streamed) continue;
    append(list, uint16_t(1));
    append(list, uint16_t(16));
    append(list, uint64_t(content.size()));
    append(list, uint64_t(packed.size()));
  }
  const auto at = static_cast<uint32_t>(bytes.size());
  bytes += list + "PK\5\6" + std::string(4, '\0');
  for (int i = 0; i < 2; ++i) append(bytes, static_cast<uint16_t>(files.size()));
  append(bytes, static_cast<uint32_t>(list.size()));
  append(bytes, at);
  return bytes + std::string(2, '\0');
}

/// A 3MF file of one model, with a thumbnail.
inline std::string archiveOf(const std::string& model, bool deflated = true, bool streamed = false) {
  return zipOf({{"_rels/.rels",
                 R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/Metadata/thumbnail.png" Id="r1" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
<Relationship Target="/3D/a.model" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)"},
                {"Metadata/thumbnail.png", "\x89PNG"},
                {"3D/a.model", model}},
               deflated, streamed);
}

}  // namespace radar::test
