// Enumerants and physical layout follow "SPIR-V Specification", Khronos, sections 3 and 2.3.
#include "gpu/spirv.h"

#include <algorithm>
#include <map>

#include "radar/device.h"

namespace radar::gpu {

namespace {

using Instruction = std::span<const uint32_t>;

enum Op : uint32_t {
  kOpName = 5,
  kOpEntryPoint = 15,
  kOpTypeVoid = 19,
  kOpTypeInt = 21,
  kOpTypeFloat = 22,
  kOpTypeVector = 23,
  kOpTypeImage = 25,
  kOpTypeSampledImage = 27,
  kOpTypeArray = 28,
  kOpTypeRuntimeArray = 29,
  kOpTypeStruct = 30,
  kOpTypePointer = 32,
  kOpTypeFunction = 33,
  kOpConstant = 43,
  kOpVariable = 59,
  kOpDecorate = 71,
  kOpMemberDecorate = 72
};
enum Decoration : uint32_t { kArrayStride = 6, kBinding = 33, kDescriptorSet = 34, kOffset = 35 };
enum Storage : uint32_t { kUniformConstant = 0, kUniform = 2, kPushConstant = 9, kStorageBuffer = 12 };
constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5, kVertex = 0, kGlCompute = 5, kDimBuffer = 5, kSampled = 1;

struct Extent {
  uint32_t bytes, alignment;
};

class Module {
 public:
  Module(std::span<const uint32_t> spirv, const char* name, VkShaderStageFlagBits stage);
  ShaderInterface reflect() const;

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error("shader \"" + name_ + "\": " + what); }
  uint32_t word(Instruction instruction, size_t i) const;
  static uint32_t op(Instruction instruction) { return instruction[0] & 0xffff; }
  std::string text(Instruction instruction, size_t from) const;
  void add(Instruction instruction);

  Instruction type(uint32_t id) const;
  uint32_t decoration(uint32_t id, Decoration which, const char* what) const;
  uint32_t memberOffset(uint32_t structId, uint32_t member) const;
  std::string nameOf(uint32_t variable, uint32_t typeId) const;
  Extent extentOf(uint32_t typeId) const;
  uint32_t sizeOf(uint32_t structId) const;
  Descriptor descriptorOf(Instruction variable, uint32_t typeId) const;
  void describeStorage(Descriptor& descriptor, uint32_t typeId) const;
  VkDescriptorType imageType(uint32_t typeId, const std::string& what) const;

  std::string name_;
  bool isVertex_;
  uint32_t ofStage_ = 0, others_ = 0;  // entry points
  std::map<uint32_t, std::string> names_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> decorations_;    // (id, decoration) -> its value
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> memberOffsets_;  // (struct, member)
  std::map<uint32_t, Instruction> types_;
  std::map<uint32_t, uint32_t> constants_;
  std::vector<Instruction> variables_;
};

Module::Module(std::span<const uint32_t> spirv, const char* name, VkShaderStageFlagBits stage)
    : name_(name), isVertex_(stage == VK_SHADER_STAGE_VERTEX_BIT) {
  if (spirv.size() < kHeaderWords || spirv[0] != kMagic) fail("not SPIR-V");
  for (size_t at = kHeaderWords; at < spirv.size();) {
    const uint32_t words = spirv[at] >> 16;
    if (words == 0 || words > spirv.size() - at) fail("the SPIR-V ends within an instruction");
    add(spirv.subspan(at, words));
    at += words;
  }
}

uint32_t Module::word(Instruction instruction, size_t i) const {
  if (i >= instruction.size()) fail("instruction " + std::to_string(op(instruction)) + " is too short");
  return instruction[i];
}

std::string Module::text(Instruction instruction, size_t from) const {
  word(instruction, from);
  const Instruction words = instruction.subspan(from);
  const char* begin = reinterpret_cast<const char*>(words.data());
  return {begin, std::find(begin, begin + words.size_bytes(), '\0')};
}

void Module::add(Instruction i) {
  switch (op(i)) {
    case kOpName:
      names_[word(i, 1)] = text(i, 2);
      break;
    case kOpEntryPoint:
      ++(word(i, 1) == (isVertex_ ? kVertex : kGlCompute) && text(i, 3) == "main" ? ofStage_ : others_);
      break;
    case kOpDecorate:
      decorations_[{word(i, 1), word(i, 2)}] = i.size() > 3 ? i[3] : 0;
      break;
    case kOpMemberDecorate:
      if (word(i, 3) == kOffset) memberOffsets_[{word(i, 1), word(i, 2)}] = word(i, 4);
      break;
    case kOpConstant:
      constants_[word(i, 2)] = word(i, 3);
      break;
    case kOpVariable:
      variables_.push_back(i);
      break;
    default:
      if (op(i) >= kOpTypeVoid && op(i) <= kOpTypeFunction) types_[word(i, 1)] = i;
  }
}

Instruction Module::type(uint32_t id) const {
  const auto found = types_.find(id);
  if (found == types_.end()) fail("type %" + std::to_string(id) + " is not supported");
  return found->second;
}

uint32_t Module::decoration(uint32_t id, Decoration which, const char* what) const {
  const auto found = decorations_.find({id, which});
  if (found == decorations_.end()) fail("%" + std::to_string(id) + " has no " + what);
  return found->second;
}

uint32_t Module::memberOffset(uint32_t structId, uint32_t member) const {
  const auto found = memberOffsets_.find({structId, member});
  if (found == memberOffsets_.end()) fail("a member of %" + std::to_string(structId) + " has no Offset");
  return found->second;
}

std::string Module::nameOf(uint32_t variable, uint32_t typeId) const {
  for (const uint32_t id : {variable, typeId}) {
    const auto found = names_.find(id);
    if (found != names_.end() && !found->second.empty()) return found->second;
  }
  return {};
}

// GLSL does not pad the end of a struct.
Extent Module::extentOf(uint32_t typeId) const {
  const Instruction t = type(typeId);
  switch (op(t)) {
    case kOpTypeInt:
    case kOpTypeFloat:
      return {word(t, 2) / 8, word(t, 2) / 8};
    case kOpTypeVector: {
      const Extent component = extentOf(word(t, 2));
      return {component.bytes * word(t, 3), component.alignment};
    }
    case kOpTypeArray: {
      const auto length = constants_.find(word(t, 3));
      if (length == constants_.end()) fail("the length of array %" + std::to_string(typeId) + " is not constant");
      return {decoration(typeId, kArrayStride, "ArrayStride") * length->second, extentOf(word(t, 2)).alignment};
    }
    case kOpTypeStruct: {
      Extent all{0, 1};
      for (uint32_t member = 0; member + 2 < t.size(); ++member) {
        const Extent one = extentOf(t[member + 2]);
        all.bytes = std::max(all.bytes, memberOffset(typeId, member) + one.bytes);
        all.alignment = std::max(all.alignment, one.alignment);
      }
      return all;
    }
    default:
      fail("type %" + std::to_string(typeId) + " (instruction " + std::to_string(op(t)) +
           ") in a block is not supported");
  }
}

// C++ pads a struct to a multiple of its alignment.
uint32_t Module::sizeOf(uint32_t structId) const {
  const Extent extent = extentOf(structId);
  return (extent.bytes + extent.alignment - 1) / extent.alignment * extent.alignment;
}

void Module::describeStorage(Descriptor& descriptor, uint32_t typeId) const {
  const Instruction block = type(typeId);
  const uint32_t lastType = word(block, std::max<size_t>(block.size() - 1, 2));
  if (op(type(lastType)) == kOpTypeRuntimeArray) {
    descriptor.stride = decoration(lastType, kArrayStride, "ArrayStride");
    descriptor.arrayOffset = memberOffset(typeId, static_cast<uint32_t>(block.size()) - 3);
  } else {
    descriptor.bytes = sizeOf(typeId);
  }
}

// SPIR-V before 1.6 may also declare a texel buffer as a sampled image.
VkDescriptorType Module::imageType(uint32_t typeId, const std::string& what) const {
  const Instruction t = type(typeId);
  const bool withSampler = op(t) == kOpTypeSampledImage;
  const Instruction image = withSampler ? type(word(t, 2)) : t;
  if (op(image) == kOpTypeImage && word(image, 7) == kSampled) {
    if (word(image, 3) == kDimBuffer) return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    if (withSampler) return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  }
  fail(what + " is not a storage buffer, a uniform texel buffer or an image with its sampler");
}

Descriptor Module::descriptorOf(Instruction variable, uint32_t typeId) const {
  const uint32_t id = word(variable, 2), storage = word(variable, 3);
  Descriptor descriptor{.binding = decoration(id, kBinding, "Binding"), .name = nameOf(id, typeId)};
  const std::string what = "binding " + std::to_string(descriptor.binding) + " (" + descriptor.name + ")";
  const uint32_t set = decoration(id, kDescriptorSet, "DescriptorSet");
  if (set != 0) fail(what + " is in descriptor set " + std::to_string(set) + ", not 0");
  const uint32_t kind = op(type(typeId));
  if (kind == kOpTypeArray || kind == kOpTypeRuntimeArray) fail(what + " is an array of descriptors");
  if (storage == kUniform) fail(what + " is a uniform buffer, or a storage buffer of SPIR-V before 1.3");
  if (storage == kStorageBuffer) {
    describeStorage(descriptor, typeId);
  } else {
    descriptor.type = imageType(typeId, what);
  }
  return descriptor;
}

ShaderInterface Module::reflect() const {
  if (ofStage_ != 1 || others_ != 0) {
    fail(std::string("expected one entry point, a ") + (isVertex_ ? "vertex" : "compute") + " shader's \"main\"");
  }
  ShaderInterface found;
  for (const Instruction& variable : variables_) {
    const uint32_t storage = word(variable, 3);
    const uint32_t typeId = word(type(word(variable, 1)), 3);
    if (storage == kPushConstant) found.pushBytes = sizeOf(typeId);
    if (storage == kUniform || storage == kUniformConstant || storage == kStorageBuffer) {
      found.descriptors.push_back(descriptorOf(variable, typeId));
    }
  }
  std::vector<Descriptor>& descriptors = found.descriptors;
  std::sort(descriptors.begin(), descriptors.end(), [](auto& a, auto& b) { return a.binding < b.binding; });
  const auto twice = std::adjacent_find(descriptors.begin(), descriptors.end(),
                                        [](auto& a, auto& b) { return a.binding == b.binding; });
  if (twice != descriptors.end()) {
    fail("binding " + std::to_string(twice->binding) + " is declared twice: " + twice->name + " and " +
         std::next(twice)->name);
  }
  return found;
}

}  // namespace

ShaderInterface reflectShader(std::span<const uint32_t> spirv, const char* name, VkShaderStageFlagBits stage) {
  return Module(spirv, name, stage).reflect();
}

}  // namespace radar::gpu
