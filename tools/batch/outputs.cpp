#include "batch/outputs.h"

#include "batch/atomic_file.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

bool areSame(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  // Where one does not exist yet.
  const auto placeOf = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(targetOf(file), error), error);
  };
  return placeOf(a) == placeOf(b);
}

}  // namespace

const Outputs::Output* Outputs::find(const std::filesystem::path& file) const {
  if (isStream(file)) return nullptr;
  for (const Output& output : outputs_) {
    if (areSame(output.file, file)) return &output;
  }
  return nullptr;
}

void Outputs::add(const std::string& option, const std::filesystem::path& file) {
  const std::filesystem::path target = targetOf(file), folder = target.has_parent_path() ? target.parent_path() : ".";
  std::error_code error;
  if (!isStream(file) && !std::filesystem::is_directory(folder, error)) {
    throw InputError(option, file.string(),
                     "expected a file in a folder that exists, got no folder " + folder.string());
  }
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(option, file.string(), "expected a file, got a folder");
  }
  if (const Output* other = find(file)) {
    throw InputError(option, file.string(), "expected a file of its own, got that of " + other->option);
  }
  outputs_.push_back({option, file});
}

void Outputs::addIn(const std::string& option, const std::filesystem::path& folder,
                    const std::vector<std::string>& names) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return;
  for (const std::string& name : names) add(option, folder / name);
}

void Outputs::requireNone(const std::filesystem::path& read) const {
  const Output* output = find(read);
  if (output == nullptr) return;
  throw InputError(output->option, output->file.string(),
                   "expected another file than those that are read, got " + read.string());
}

}  // namespace radar::tools
