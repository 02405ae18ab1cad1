#include "import/gltf_document.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <limits>

#include "import/regular_file.h"

namespace radar::tools {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "glTF";
constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

/// Of elements that no buffer holds: zeros.
constexpr uint32_t kMostZeros = uint32_t(1) << 27;

template <class Value>
Value load(const char* from) {
  Value value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

size_t sizeOf(uint32_t componentType) {
  switch (componentType) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

double decoded(const char* from, uint32_t componentType, bool isNormalised) {
  const auto whole = [&](auto value) {
    constexpr double kMost = std::numeric_limits<decltype(value)>::max();
    return isNormalised ? std::max(value / kMost, -1.0) : double(value);
  };
  switch (componentType) {
    case 5120:
      return whole(load<int8_t>(from));
    case 5121:
      return whole(load<uint8_t>(from));
    case 5122:
      return whole(load<int16_t>(from));
    case 5123:
      return whole(load<uint16_t>(from));
    case 5125:
      return whole(load<uint32_t>(from));
    default:
      return double(load<float>(from));
  }
}

size_t componentsOf(const std::string& type) {
  return type == "MAT4" ? 16 : type == "SCALAR" ? 1 : static_cast<size_t>(type.back() - '0');
}

struct Chunk {
  uint32_t kind;
  std::string_view bytes;
};

/// The chunk that begins at a byte, or nothing at the end. Goes on to the next one. Some writers leave a chunk's length
/// no multiple of 4: the next one follows at once.
std::optional<Chunk> takeChunk(const Text& text, std::string_view bytes, size_t& at) {
  if (at >= bytes.size()) return {};
  const std::string place = "byte " + std::to_string(at);
  if (bytes.size() - at < 8) text.refuse(place, "expected a chunk's length and kind, the file ends");
  const auto length = load<uint32_t>(&bytes[at]);
  const Chunk chunk{load<uint32_t>(&bytes[at + 4]), bytes.substr(at + 8, length)};
  if (chunk.bytes.size() < length) {
    text.refuse(place,
                "expected a chunk of " + std::to_string(length) + " bytes, got " + std::to_string(chunk.bytes.size()));
  }
  at += 8 + size_t(length);
  return chunk;
}

std::string decodedBase64(const JsonValue& place, std::string_view text) {
  std::string bytes;
  uint32_t bits = 0, count = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (const char digit : text) {
    const size_t value = kDigits.find(digit);
    if (value == kDigits.npos) place.expected("data in base64");
    bits = bits << 6 | static_cast<uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

std::string withoutPercents(const std::string& uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const bool isCode = uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
                        std::isxdigit(static_cast<unsigned char>(uri[i + 2]));
    if (isCode) value = static_cast<unsigned>(std::stoul(uri.substr(i + 1, 2), nullptr, 16));
    text += isCode ? static_cast<char>(value) : uri[i];
    if (isCode) i += 2;
  }
  return text;
}

/// Read here, or only about looks, sounds and motion.
bool isKnown(const std::string& extension) {
  if (extension == "KHR_mesh_quantization" || extension == "EXT_mesh_gpu_instancing") return true;
  for (const char* prefix : {"KHR_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                             "KHR_lights_", "EXT_lights_", "KHR_xmp", "KHR_technique"}) {
    if (extension.starts_with(prefix)) return true;
  }
  return false;
}

const char* compressionOf(const JsonValue& value) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    if (value.json().contains("extensions") && value.json()["extensions"].contains(name)) return name;
  }
  return nullptr;
}

}  // namespace

double GltfAccessor::at(size_t element, unsigned component) const {
  const char* from = data_ ? data_ + element * stride_ : nullptr;
  const auto found = std::ranges::lower_bound(sparseElements_, element);
  if (found != sparseElements_.end() && *found == element) {
    from = sparseData_ + static_cast<size_t>(found - sparseElements_.begin()) * sparseStride_;
  }
  return from ? decoded(from + component * sizeOf(componentType_), componentType_, isNormalised_) : 0;
}

GltfDocument::GltfDocument(Text text) : file_(text.file()) {
  std::string_view bytes = text.rest();
  if (bytes.starts_with(kMagic)) {
    if (bytes.size() < 12) text.refuse("", "expected 12 bytes that begin a binary file, the file ends");
    const auto version = load<uint32_t>(&bytes[4]), length = load<uint32_t>(&bytes[8]);
    if (version != 2) text.refuse("byte 4", "expected version 2, got " + std::to_string(version));
    if (length > bytes.size()) {
      text.refuse("",
                  "expected " + std::to_string(length) + " bytes, as byte 8 says, got " + std::to_string(bytes.size()));
    }
    bytes = bytes.substr(0, length);
    size_t at = 12;
    const std::optional<Chunk> json = takeChunk(text, bytes, at);
    if (!json || json->kind != kJsonChunk) text.refuse("byte 12", "expected a chunk of JSON, got none");
    if (const std::optional<Chunk> next = takeChunk(text, bytes, at); next && next->kind == kBinaryChunk) {
      binary_ = next->bytes;
    }
    bytes = json->bytes;
  }
  json_ = parseJson(file_, bytes);
  const JsonValue top = root(), asset = top.member("asset"), version = asset.member("version");
  if (!version.string().starts_with("2.")) version.expected("version 2.0");
  top.ifHas("extensionsRequired", [](const JsonValue& list) {
    list.forEach([](const JsonValue& name) {
      if (!isKnown(name.string())) name.expected("a required extension that is read here");
    });
  });
}

std::string_view GltfDocument::buffer(const JsonValue& number, const char* compression) {
  return use("buffers", number, [&](const JsonValue& buffer) -> std::string_view {
    const auto index = number.wholeNumber<uint32_t>();
    const JsonValue lengthValue = buffer.member("byteLength");
    const auto length = lengthValue.wholeNumber<uint64_t>();
    std::string_view bytes;
    if (buffer.has("uri")) {
      const JsonValue value = buffer.member("uri");
      const auto [found, isNew] = loaded_.try_emplace(index);
      if (isNew) {
        const std::string uri = value.string();
        const size_t comma = uri.find(',');
        if (uri.starts_with("data:")) {
          if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64")) value.expected("data in base64");
          found->second = decodedBase64(value, std::string_view(uri).substr(comma + 1));
        } else {
          const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
          std::error_code error;
          const bool isPlain = std::filesystem::exists(folder / uri, error);
          const std::filesystem::path path = folder / (isPlain ? uri : withoutPercents(uri));
          if (!std::filesystem::is_regular_file(path, error)) value.expected("data, or the name of a regular file");
          found->second = readRegularFile(path, "a buffer");
        }
      }
      bytes = found->second;
    } else if (index == 0 && binary_) {
      bytes = *binary_;
    } else if (compression) {
      buffer.refuse(std::string("expected a buffer that is not compressed with ") + compression + ", got no other");
    } else {
      buffer.refuse("expected a uri, or a second chunk of a binary file, got neither");
    }
    if (bytes.size() < length) {
      buffer.refuse("expected " + std::to_string(length) + " bytes, got " + std::to_string(bytes.size()));
    }
    return bytes.substr(0, length);
  });
}

GltfDocument::View GltfDocument::view(const JsonValue& number) {
  return use("bufferViews", number, [&](const JsonValue& view) {
    const JsonValue bufferNumber = view.member("buffer"), lengthValue = view.member("byteLength");
    const std::string_view bytes = buffer(bufferNumber, compressionOf(view));
    const auto length = lengthValue.wholeNumber<uint64_t>();
    uint64_t offset = 0;
    size_t stride = 0;
    view.ifHas("byteOffset", [&](const JsonValue& value) { offset = value.wholeNumber<uint64_t>(); });
    view.ifHas("byteStride", [&](const JsonValue& value) {
      stride = value.wholeNumber<uint8_t>();
      if (stride == 0) value.expected("a whole number from 1 to 255");
    });
    if (offset > bytes.size() || length > bytes.size() - offset) {
      view.refuse("expected bytes among the buffer's " + std::to_string(bytes.size()) + ", got " +
                  std::to_string(length) + " from " + std::to_string(offset));
    }
    return View{bytes.substr(offset, length), stride};
  });
}

namespace {

/// Where `count` elements begin in a view.
const char* elementsOf(const JsonValue& place, std::string_view bytes, size_t count, size_t stride, size_t size) {
  uint64_t offset = 0;
  place.ifHas("byteOffset", [&](const JsonValue& value) { offset = value.wholeNumber<uint64_t>(); });
  const uint64_t needed = count == 0 ? 0 : (count - 1) * stride + size;
  if (stride < size)
    place.refuse("expected a stride of " + std::to_string(size) + " bytes or more, got " + std::to_string(stride));
  if (offset > bytes.size() || needed > bytes.size() - offset) {
    place.refuse("expected elements among the view's " + std::to_string(bytes.size()) + " bytes, got " +
                 std::to_string(needed) + " from " + std::to_string(offset));
  }
  return bytes.data() + offset;
}

uint32_t componentTypeOf(const JsonValue& place) {
  const JsonValue value = place.member("componentType");
  const auto type = value.wholeNumber<uint32_t>();
  if (sizeOf(type) == 0) value.expected("5120, 5121, 5122, 5123, 5125 or 5126");
  return type;
}

}  // namespace

void GltfDocument::readSparse(const JsonValue& sparse, size_t elementSize, GltfAccessor& to) {
  const JsonValue countValue = sparse.member("count"), indices = sparse.member("indices"),
                  values = sparse.member("values"), indicesView = indices.member("bufferView"),
                  valuesView = values.member("bufferView");
  const auto count = countValue.wholeNumber<uint32_t>();
  const uint32_t type = componentTypeOf(indices);
  const char* elements = elementsOf(indices, view(indicesView).bytes, count, sizeOf(type), sizeOf(type));
  to.sparseData_ = elementsOf(values, view(valuesView).bytes, count, elementSize, elementSize);
  to.sparseStride_ = elementSize;
  for (size_t i = 0; i < count; ++i) {
    const double element = decoded(elements + i * sizeOf(type), type, false);
    if (!(element >= 0 && element < double(to.count_)) || (i > 0 && !(element > double(to.sparseElements_.back())))) {
      indices.refuse("expected ascending numbers of the " + std::to_string(to.count_) +
                     " elements, got another as number " + std::to_string(i));
    }
    to.sparseElements_.push_back(static_cast<uint32_t>(element));
  }
}

GltfAccessor GltfDocument::accessor(const JsonValue& number, const std::string& type, const char* compression) {
  return use("accessors", number, [&](const JsonValue& accessor) {
    const JsonValue typeValue = accessor.member("type"), countValue = accessor.member("count");
    if (typeValue.string() != type) typeValue.expected(type);
    GltfAccessor result;
    result.count_ = countValue.wholeNumber<uint32_t>();
    result.componentType_ = componentTypeOf(accessor);
    accessor.ifHas("normalized", [&](const JsonValue& value) { result.isNormalised_ = value.boolean(); });
    const size_t size = componentsOf(type) * sizeOf(result.componentType_);
    if (accessor.has("bufferView")) {
      const JsonValue viewNumber = accessor.member("bufferView");
      const View from = view(viewNumber);
      result.stride_ = from.stride == 0 ? size : from.stride;
      result.data_ = elementsOf(accessor, from.bytes, result.count_, result.stride_, size);
    } else if (compression) {
      accessor.refuse(std::string("expected elements that are not compressed with ") + compression + ", got no other");
    } else if (result.count_ > kMostZeros) {
      countValue.expected("at most " + std::to_string(kMostZeros) + " elements without a bufferView");
    }
    accessor.ifHas("sparse", [&](const JsonValue& sparse) { readSparse(sparse, size, result); });
    return result;
  });
}

bool isGltf1(std::string_view bytes) {
  if (bytes.starts_with(kMagic)) return bytes.size() >= 8 && load<uint32_t>(&bytes[4]) == 1;
  using Json = nlohmann::json;
  const auto isAsset = [](int depth, Json::parse_event_t event, const Json& key) {
    return depth != 1 || event != Json::parse_event_t::key || key == "asset";
  };
  const Json document = Json::parse(bytes, isAsset, false);
  if (!document.is_object() || !document.contains("asset") || !document["asset"].is_object()) return false;
  const Json& version = document["asset"].contains("version") ? document["asset"]["version"] : Json();
  return version.is_number() ? version == 1 : version.is_string() && version.get<std::string>().starts_with("1");
}

}  // namespace radar::tools
