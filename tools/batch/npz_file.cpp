#include "batch/npz_file.h"

#include <unistd.h>
#include <zlib.h>

#include <minizip/unzip.h>
#include <minizip/zip.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <regex>
#include <stdexcept>

#include "import/input_error.h"

namespace radar::tools {

namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::string_view kMagic = "\x93NUMPY";
constexpr size_t kPiece = 1 << 26;  // bytes handed over at once

struct CloseArchive {
  void operator()(void* archive) const { unzClose(archive); }
};

std::string shapeText(std::span<const uint64_t> shape) {
  std::string text = "(";
  for (const uint64_t length : shape) text += std::to_string(length) + (shape.size() == 1 ? "," : ", ");
  if (shape.size() > 1) text.resize(text.size() - 2);
  return text + ")";
}

// The product of numbers, or none if it does not fit.
bool multiply(uint64_t& product, uint64_t factor) {
  return !__builtin_mul_overflow(product, factor, &product);
}

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

}  // namespace

std::string npyHeader(const std::string& descr, std::span<const uint64_t> shape, size_t least) {
  std::string text = "{'descr': " + descr + ", 'fortran_order': False, 'shape': " + shapeText(shape) + ", }";
  // Version 1.0; padded so that the numbers begin at a multiple of 64 bytes.
  const size_t before = kMagic.size() + 4;
  const size_t whole = std::max(least, (before + text.size()) / 64 * 64 + 64);
  text.append(whole - before - text.size() - 1, ' ');
  text += '\n';
  std::string header(kMagic);
  header.append({1, 0, static_cast<char>(text.size() & 255), static_cast<char>(text.size() >> 8)});
  return header + text;
}

uint64_t NpyArray::count() const {
  uint64_t product = 1;
  for (const uint64_t length : shape) product *= length;
  return product;
}

std::string inWords(const NpyArray& array) {
  const std::string type = array.kind == 'f'   ? "float"
                           : array.kind == 'i' ? "int"
                           : array.kind == 'u' ? "uint"
                                               : "bool";
  return type + (array.kind == 'b' ? "" : std::to_string(8 * array.size)) + " of shape " + shapeText(array.shape);
}

NpzFile::NpzFile(const std::filesystem::path& file) : file_(file.string()), mapped_(file, "an .npz file") {
  const std::unique_ptr<void, CloseArchive> archive(unzOpen64(file.c_str()));
  if (!archive) throw InputError(file_, "", "expected an .npz file, which is a ZIP archive");
  for (int next = unzGoToFirstFile(archive.get()); next != UNZ_END_OF_LIST_OF_FILE;
       next = unzGoToNextFile(archive.get())) {
    unz_file_info64 info{};
    char name[256] = {};
    if (next != UNZ_OK ||
        unzGetCurrentFileInfo64(archive.get(), &info, name, sizeof name - 1, nullptr, 0, nullptr, 0) != UNZ_OK) {
      throw InputError(file_, "", "expected an .npz file, got a ZIP archive whose list of files is damaged");
    }
    const std::string member = name;
    if (!member.ends_with(".npy")) throw InputError(file_, member, "expected only arrays, each a file .npy");
    const std::string array = member.substr(0, member.size() - 4);
    if (arrays_.contains(array)) throw InputError(file_, array, "expected each array once");
    if (unzOpenCurrentFile(archive.get()) != UNZ_OK || (info.flag & 1) != 0) {
      throw InputError(file_, array, "expected an array, stored or deflated");
    }
    std::string_view bytes;
    if (info.compression_method == 0) {
      const uint64_t start = unzGetCurrentFileZStreamPos64(archive.get());
      const std::string_view all = mapped_.bytes();
      if (start > all.size() || info.uncompressed_size > all.size() - start) {
        throw InputError(file_, array, "expected an array, got one that is cut off");
      }
      bytes = all.substr(start, info.uncompressed_size);
      const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
      if (sum != info.crc) throw InputError(file_, array, "expected an undamaged array, got one of another CRC-32");
    } else {
      unpacked_.push_back(std::make_unique<std::string>(readMember(archive.get(), array, info.uncompressed_size)));
      bytes = *unpacked_.back();
    }
    arrays_.emplace(array, arrayFrom(array, bytes));
  }
}

std::string NpzFile::readMember(void* archive, const std::string& name, uint64_t size) const {
  std::string bytes;
  while (bytes.size() < size) {
    // Room as it is needed, whatever the archive claims.
    const size_t before = bytes.size(), most = std::min<uint64_t>(size - before, kPiece);
    bytes.resize(before + most);
    const int read = unzReadCurrentFile(archive, bytes.data() + before, static_cast<unsigned>(most));
    if (read <= 0) throw InputError(file_, name, "expected an array, got one that is damaged or cut off");
    bytes.resize(before + static_cast<size_t>(read));
  }
  if (unzCloseCurrentFile(archive) != UNZ_OK) {
    throw InputError(file_, name, "expected an undamaged array, got one of another CRC-32");
  }
  return bytes;
}

NpyArray NpzFile::arrayFrom(const std::string& name, std::string_view member) const {
  const auto refuse = [&](const std::string& problem) { throw InputError(file_, name, problem); };
  const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<uint8_t>(member[i])); };
  if (!member.starts_with(kMagic) || member.size() < 12) refuse("expected an array in numpy's format .npy");
  const bool isShort = byte(6) == 1;
  const size_t start = isShort ? 10 : 12;
  const size_t length =
      isShort ? byte(8) + 256 * byte(9) : byte(8) + 256 * (byte(9) + 256 * (byte(10) + 256 * byte(11)));
  constexpr size_t kLongest = 4096;
  if (length > kLongest || member.size() < start + length) refuse("expected an array of plain numbers");
  std::string header(member.substr(start, length));
  header.resize(header.find_last_not_of(" \n") + 1);
  static const std::regex kHeader(
      R"(\{ *'descr': *'([<>|=])([a-zA-Z])([0-9]{1,4})', *'fortran_order': *(True|False), *'shape': *\(([0-9, ]*)\),? *\})");
  std::smatch parts;
  if (!std::regex_match(header, parts, kHeader))
    refuse("expected an array of plain numbers, got " + header.substr(0, 200));
  NpyArray array;
  array.kind = *parts[2].first;
  array.size = static_cast<size_t>(std::stoul(parts[3]));
  if (!isPlain(array.kind, array.size)) {
    refuse("expected float32, float64, integers or booleans, got the type " + parts[2].str() + parts[3].str());
  }
  if (parts[1] == ">") refuse("expected little-endian numbers, got big-endian ones");
  const std::string shape = parts[5];
  for (const char *at = shape.data(), *end = at + shape.size(); at != end;) {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    uint64_t value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) refuse("expected a shape, got (" + shape + ")");
    array.shape.push_back(value);
    at = next;
  }
  if (parts[4] == "True" && array.shape.size() > 1) {
    refuse("expected an array in C order, row by row, got Fortran's order (numpy.ascontiguousarray)");
  }
  uint64_t expected = array.size;
  for (const uint64_t extent : array.shape) {
    if (!multiply(expected, extent)) refuse("expected a shape that fits memory, got (" + shape + ")");
  }
  array.bytes = member.substr(start + length);
  if (array.bytes.size() != expected) {
    refuse("expected " + std::to_string(expected) + " bytes of numbers, got " + std::to_string(array.bytes.size()));
  }
  return array;
}

NpzWriter::NpzWriter(const std::filesystem::path& file) : file_(file), unfinished_(file) {
  unfinished_ += ".unfinished-" + std::to_string(getpid());
  archive_ = zipOpen64(unfinished_.c_str(), APPEND_STATUS_CREATE);
  require(archive_ != nullptr);
}

NpzWriter::~NpzWriter() {
  if (archive_) zipClose(archive_, nullptr);
  std::error_code ignored;
  if (!unfinished_.empty()) std::filesystem::remove(unfinished_, ignored);
}

void NpzWriter::require(bool succeeded) const {
  if (!succeeded) throw std::runtime_error(file_.string() + ": expected a place to write to, got an error");
}

void NpzWriter::add(const std::string& name, const std::string& descr, std::span<const uint64_t> shape,
                    std::span<const std::byte> numbers) {
  const std::string header = npyHeader(descr, shape);
  zip_fileinfo info{};
  info.tmz_date = {.tm_sec = 0, .tm_min = 0, .tm_hour = 0, .tm_mday = 1, .tm_mon = 0, .tm_year = 1980};
  constexpr int kZip64 = 1;
  require(zipOpenNewFileInZip64(archive_, (name + ".npy").c_str(), &info, nullptr, 0, nullptr, 0, nullptr, 0, 0,
                                kZip64) == ZIP_OK);
  require(zipWriteInFileInZip(archive_, header.data(), static_cast<unsigned>(header.size())) == ZIP_OK);
  for (; !numbers.empty(); numbers = numbers.subspan(std::min(kPiece, numbers.size()))) {
    const auto piece = static_cast<unsigned>(std::min(kPiece, numbers.size()));
    require(zipWriteInFileInZip(archive_, numbers.data(), piece) == ZIP_OK);
  }
  require(zipCloseFileInZip(archive_) == ZIP_OK);
}

void NpzWriter::finish() {
  const int closed = zipClose(archive_, nullptr);
  archive_ = nullptr;
  require(closed == ZIP_OK);
  std::error_code error;
  std::filesystem::rename(unfinished_, file_, error);
  require(!error);
  unfinished_.clear();
}

}  // namespace radar::tools
