#include "batch/columns.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <regex>

#include "import/input_error.h"

namespace radar::tools {

namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::string_view kMagic = "\x93NUMPY";

bool isPlain(char kind, size_t size) {
  switch (kind) {
    case 'f':
      return size == 4 || size == 8;
    case 'b':
      return size == 1;
    default:
      return (kind == 'i' || kind == 'u') && (size == 1 || size == 2 || size == 4 || size == 8);
  }
}

// Whole numbers between commas and blanks; none if one does not fit.
std::vector<uint64_t> numbersIn(const std::string& text) {
  std::vector<uint64_t> numbers;
  for (const char *at = text.data(), *end = at + text.size(); at != end;) {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    const auto [next, error] = std::from_chars(at, end, numbers.emplace_back());
    if (error != std::errc()) return {};
    at = next;
  }
  return numbers;
}

// The header's text, without what pads it, and the bytes after it; nothing if there is none.
std::pair<std::string, std::string_view> split(std::string_view file) {
  const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<uint8_t>(file[i])); };
  if (!file.starts_with(kMagic) || file.size() < 12) return {};
  const bool isShort = byte(6) == 1;
  const size_t start = isShort ? 10 : 12;
  const size_t length =
      isShort ? byte(8) + 256 * byte(9) : byte(8) + 256 * (byte(9) + 256 * (byte(10) + 256 * byte(11)));
  constexpr size_t kLongest = 8192;
  if (length > kLongest || file.size() < start + length) return {};
  std::string header(file.substr(start, length));
  header.resize(header.find_last_not_of(" \n") + 1);
  return {header, file.substr(start + length)};
}

}  // namespace

std::string npyHeader(const std::string& type, uint64_t rows, size_t least) {
  std::string text = "{'descr': " + type + ", 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
  // Version 1.0; padded so that the numbers begin at a multiple of 64 bytes.
  const size_t before = kMagic.size() + 4;
  const size_t whole = std::max(least, (before + text.size()) / 64 * 64 + 64);
  text.append(whole - before - text.size() - 1, ' ');
  text += '\n';
  std::string header(kMagic);
  header.append({1, 0, static_cast<char>(text.size() & 255), static_cast<char>(text.size() >> 8)});
  return header + text;
}

uint64_t Column::width() const {
  uint64_t product = 1;
  for (const uint64_t length : shape) product *= length;
  return product;
}

template <class Value>
Value Column::at(uint64_t row, uint64_t part) const {
  Value value;
  std::memcpy(&value, first + row * stride + part * sizeof value, sizeof value);
  return value;
}

double Column::real(uint64_t row, uint64_t part) const {
  return size == 4 ? at<float>(row, part) : at<double>(row, part);
}

uint64_t Column::whole(uint64_t row, uint64_t part) const {
  const auto widen = [](int64_t value) { return value < 0 ? ~uint64_t{0} : static_cast<uint64_t>(value); };
  const bool isSigned = kind == 'i';
  switch (size) {
    case 1:
      return isSigned ? widen(at<int8_t>(row, part)) : at<uint8_t>(row, part);
    case 2:
      return isSigned ? widen(at<int16_t>(row, part)) : at<uint16_t>(row, part);
    case 4:
      return isSigned ? widen(at<int32_t>(row, part)) : at<uint32_t>(row, part);
    default:
      return isSigned ? widen(at<int64_t>(row, part)) : at<uint64_t>(row, part);
  }
}

std::string Column::type() const {
  std::string text = kind == 'f' ? "float" : kind == 'i' ? "int" : kind == 'u' ? "uint" : "bool";
  if (kind != 'b') text += std::to_string(8 * size);
  for (size_t i = 0; i < shape.size(); ++i) text += (i == 0 ? " of shape (" : ", ") + std::to_string(shape[i]);
  return text + (shape.empty() ? "" : shape.size() == 1 ? ",)" : ")");
}

Columns::Columns(const std::filesystem::path& file) : name_(file.string()), mapped_(file, "an .npy file") {
  const auto refuse = [&](const std::string& column, const std::string& problem) {
    throw InputError(name_, column, problem);
  };
  const auto& [header, rows] = split(mapped_.bytes());
  if (header.empty()) refuse("", "expected an array in numpy's format .npy");
  static const std::regex kHeader(
      R"(\{ *'descr': *\[(.*)\], *'fortran_order': *(?:True|False), *'shape': *\(([0-9]+),\),? *\})");
  static const std::regex kColumn(R"(\('([^']*)', '([<>|=])([a-zA-Z])([0-9]{1,4})'(?:, \(([0-9, ]+)\))?\)(?:, *|$))");
  std::smatch parts;
  if (!std::regex_match(header, parts, kHeader)) {
    refuse("", "expected a structured array of one dimension, got " + header.substr(0, 200));
  }
  const std::string columns = parts[1], length = parts[2];
  const std::vector<uint64_t> shape = numbersIn(length);
  uint64_t stride = 0;
  for (auto at = columns.begin(); at != columns.end(); at = parts[0].second) {
    if (!std::regex_search(at, columns.end(), parts, kColumn, std::regex_constants::match_continuous)) {
      refuse("", "expected columns of plain numbers, got " + std::string(at, columns.end()).substr(0, 200));
    }
    Column column{.name = parts[1], .kind = *parts[3].first, .size = std::stoul(parts[4])};
    const bool isPadding = column.name.empty() && column.kind == 'V';
    if (!isPadding && !isPlain(column.kind, column.size)) {
      refuse(column.name,
             "expected float32, float64, integers or booleans, got the type " + parts[3].str() + parts[4].str());
    }
    if (parts[2] == ">") refuse(column.name, "expected little-endian numbers, got big-endian ones");
    if (find(column.name)) refuse(column.name, "expected each column once");
    column.shape = numbersIn(parts[5]);
    if (parts[5].matched && column.shape.empty()) refuse(column.name, "expected a shape, got (" + parts[5].str() + ")");
    column.first = rows.data() + std::min<uint64_t>(stride, rows.size());
    uint64_t bytes = column.size;
    for (const uint64_t extent : column.shape) {
      if (__builtin_mul_overflow(bytes, extent, &bytes)) refuse(column.name, "expected a shape that fits memory");
    }
    if (__builtin_add_overflow(stride, bytes, &stride)) refuse(column.name, "expected a shape that fits memory");
    if (!isPadding) all_.push_back(std::move(column));
  }
  for (Column& column : all_) column.stride = stride;
  uint64_t expected = 0;
  if (shape.empty() || __builtin_mul_overflow(shape[0], stride, &expected) || rows.size() != expected) {
    refuse("", "expected " + length + " rows of " + std::to_string(stride) + " bytes, got " +
                   std::to_string(rows.size()) + " bytes");
  }
  rows_ = shape[0];
}

const Column* Columns::find(std::string_view name) const {
  const auto found = std::ranges::find(all_, name, &Column::name);
  return found == all_.end() ? nullptr : &*found;
}

}  // namespace radar::tools
