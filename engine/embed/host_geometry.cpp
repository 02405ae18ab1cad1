#include "embed/host_geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "embed/host_format.h"
#include "gpu/barrier.h"
#include "math/rounding.h"
#include "shaders/contact/interop.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
// Longer lengths are out of range anyway.
constexpr double kLongest = 1e38;

bool repeats(std::vector<uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

// The float with this number in the order of floats: see normalise.comp.
float floatOf(uint32_t inOrder) {
  return std::bit_cast<float>((inOrder & 0x80000000u) != 0 ? inOrder & 0x7fffffffu : ~inOrder);
}

}  // namespace

std::string validate(const HostGeometry& geometry, const Scene& scene) {
  std::vector<MeshId> meshes;
  for (const DeformedMesh& deformed : geometry.meshes) {
    std::string name = "mesh " + std::to_string(deformed.mesh);
    if (!scene.hasMesh(deformed.mesh)) return name + " does not exist";
    if (deformed.positions.buffer == VK_NULL_HANDLE) return name + ": expected a buffer of positions";
    if (std::string wrong = validate(deformed.positions); !wrong.empty()) return name.append(": ").append(wrong);
    meshes.push_back(deformed.mesh);
  }
  if (repeats(std::move(meshes))) return "meshes: expected each at most once";
  for (const MovedObjects& moved : geometry.objects) {
    if (moved.transforms == VK_NULL_HANDLE) return "objects: expected a buffer of transforms";
    if (const uint64_t least = extentOf(moved.layout); moved.stride < least) {
      return "objects: stride: expected at least " + std::to_string(least) + " bytes, got " +
             std::to_string(moved.stride);
    }
  }
  return {};
}

gpu::DeformedSensor deformedSensor(uint32_t sensor, const Query& query, const Motion& motion) {
  gpu::DeformedSensor out{.sensor = sensor, .mesh = query.mesh};
  if (query.ignoreLeaving && query.slack) out.slack = roundUp(std::min(2 * *query.slack, kLongest));
  out.clearance = roundUp(std::min(query.clearance, kLongest));
  out.tolerance = roundUp(std::min(query.tolerance.value_or(kLongest), kLongest));
  const double way = motion.wayUntil(motion.distance);
  out.exponent = way > 0 ? std::ilogb(way) : 0;
  const double mantissa = std::ldexp(way, -out.exponent);
  out.way = roundUp(mantissa);
  out.certain = motion.isStep ? roundDown((1 - 0x1p-48) * mantissa) : out.way;
  out.stopBefore = query.anyHit ? std::min(out.certain, roundDown(mantissa)) : -1;
  if (motion.isStep) out.perWay = way > 0 ? roundDown((1 - 0x1p-20) / mantissa) : -1;
  return out;
}

HostGeometryPass::HostGeometryPass(const Device::Impl& device, const GpuScene& resident)
    : device_(&device),
      resident_(resident),
      run_(device, {shaders::kDeform, shaders::kBound, shaders::kNormalise, shaders::kMove, shaders::kRefit,
                    shaders::kFit, shaders::kPlace, shaders::kReach, shaders::kInvalidate}),
      upload_(device),
      words_(device, "host words", BufferDomain::device, kUploaded),
      refitNodes_(device, "nodes to refit", BufferDomain::device, kUploaded),
      numbers_(device, "host vertex numbers", BufferDomain::device, kUploaded),
      unboundedMeshes_(device, "unbounded meshes", BufferDomain::device, kUploaded),
      fitNodes_(device, "nodes to fit", BufferDomain::device, kUploaded),
      moved_(device, "moved objects", BufferDomain::device, kUploaded),
      extents_(device, "extents", BufferDomain::device, kUploaded | VK_BUFFER_USAGE_TRANSFER_SRC_BIT),
      readback_(device, "recorded extents", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      sensors_(device, "deformed sensors", BufferDomain::device, kUploaded),
      violation_(device, "bounds violation", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  violation_.reserve(1);
}

// Lists what to copy from the host's buffers; returns where `words_` will have the positions of each mesh, then the
// transforms of each group of objects.
std::vector<uint32_t> HostGeometryPass::copyFrom(const HostGeometry& geometry, const Scene::Impl& scene) {
  sources_.clear();
  VkDeviceSize end = 0;
  std::vector<uint32_t> firstBytes;
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  const auto copy = [&](VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
    firstBytes.push_back(static_cast<uint32_t>(end));
    if (bytes == 0) return;
    sources_.push_back({buffer, {first, end, bytes}});
    end = gpu::roundedUp(end + bytes, 8);
    if (end + sizeof(uint32_t) > limit) {
      throw Error("record: the host's geometry exceeds the " + std::to_string(limit) +
                  " bytes of the device's maxStorageBufferRange");
    }
  };
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.meshes[deformed.mesh];
    const HostPositions& from = deformed.positions;
    const uint32_t least = mesh.firstHostVertex, span = mesh.hostVertex(mesh.vertexCount() - 1) - least + 1;
    copy(from.buffer, from.first + from.stride * least, spanOf(from, span));
  }
  for (const MovedObjects& moved : geometry.objects) {
    copy(moved.transforms, moved.first, spanOf(moved.stride, moved.objects.size(), extentOf(moved.layout)));
  }
  // And the word after the last that a shader may load.
  words_.reserve(end / sizeof(uint32_t) + 1);
  return firstBytes;
}

void HostGeometryPass::reserve(const GeometryList& list) {
  refitNodes_.reserve(list.refitNodes.size());
  numbers_.reserve(list.vertexNumbers.size());
  unboundedMeshes_.reserve(list.unboundedMeshes.size());
  fitNodes_.reserve(list.fitNodes.size());
  moved_.reserve(list.moved.size());
  extents_.reserve(list.unboundedMeshes.size());
  readback_.reserve(list.unboundedMeshes.size());
}

void HostGeometryPass::stage(const HostGeometry& geometry, const Scene::Impl& scene) {
  run_.begin();
  upload_.begin();
  sensorCount_ = 0;
  const bool isEmpty = geometry.meshes.empty() && std::ranges::all_of(geometry.objects, [](const MovedObjects& moved) {
                         return moved.objects.empty();
                       });
  if (isEmpty) {
    list_ = {};
    return;
  }
  const std::vector<uint32_t> firstBytes = copyFrom(geometry, scene);
  if (!list_.isOf(geometry, firstBytes, scene)) {
    list_ = {};
    isUploaded_ = false;
    GeometryList list = listOf(geometry, firstBytes, scene);
    reserve(list);
    list_ = std::move(list);
  }
  if (isUploaded_) return;
  const auto add = [&](const auto& elements, const gpu::Buffer& to) {
    upload_.add(elements.data(), gpu::bytesOf(elements), to);
  };
  add(list_.refitNodes, refitNodes_);
  add(list_.vertexNumbers, numbers_);
  add(list_.unboundedMeshes, unboundedMeshes_);
  add(list_.fitNodes, fitNodes_);
  add(list_.moved, moved_);
}

void HostGeometryPass::stageSensors(std::span<const gpu::DeformedSensor> sensors) {
  if (sensors.empty()) return;
  sensors_.reserve(sensors.size());
  upload_.add(sensors.data(), sensors.size_bytes(), sensors_);
  sensorCount_ = static_cast<uint32_t>(sensors.size());
}

void HostGeometryPass::record(const gpu::Commands& commands, const Scene::Impl& scene) {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& to = resident_.buffers();
  upload_.record(commands);
  for (const Source& source : sources_) {
    commands->CmdCopyBuffer(commands, source.buffer, words_.get(), 1, &source.region);
  }
  commands->CmdFillBuffer(commands, violation_.get(), 0, sizeof(BoundsViolation), kNobody);
  const auto unbounded = static_cast<uint32_t>(list_.unboundedMeshes.size());
  if (unbounded != 0) commands->CmdFillBuffer(commands, extents_.get(), 0, VK_WHOLE_SIZE, kNobody);
  transferToComputeReadWrite(commands);
  for (const GeometryList::Deformed& d : list_.meshes) {
    run_(commands, shaders::kDeform, groupsFor(d.vertices, kHostGroup),
         DeformPush{.count = d.vertices,
                    .mesh = d.mesh,
                    .firstByte = d.firstByte,
                    .stride = d.stride,
                    .format = d.component,
                    .numbers = d.numbers,
                    .isBounded = d.isBounded ? 1u : 0u},
         {{kSlotVertices, to.vertices},
          {kSlotMeshes, to.meshes},
          {kSlotBoundsViolation, violation_},
          {kSlotVertexNumbers, numbers_},
          {kSlotWords, words_}});
  }
  if (unbounded != 0) {
    computeWriteToComputeReadWrite(commands);
    uint32_t extent = 0;
    for (const GeometryList::Deformed& d : list_.meshes) {
      if (d.isBounded) continue;
      run_(commands, shaders::kBound, groupsFor(d.triangles, kHostGroup * kBoundRun),
           BoundPush{resident_.record(d.mesh).firstTriangle, d.triangles, extent++},
           {{kSlotVertices, to.vertices}, {kSlotTriangles, to.triangles}, {kSlotExtents, extents_}});
    }
    computeWriteToComputeReadWrite(commands);
    run_(commands, shaders::kNormalise, groupsFor(unbounded, kHostGroup), NormalisePush{unbounded},
         {{kSlotMeshes, to.meshes}, {kSlotUnbounded, unboundedMeshes_}, {kSlotExtents, extents_}});
    computeWriteToComputeReadWrite(commands);
  }
  if (!list_.moved.empty()) {
    MovePush push{.count = static_cast<uint32_t>(list_.moved.size())};
    setAnchor(push, scene.objectTree());
    run_(commands, shaders::kMove, groupsFor(push.count, kHostGroup), push,
         {{kSlotMeshes, to.meshes},
          {kSlotObjects, to.objects},
          {kSlotPlacements, to.placements},
          {kSlotObjectNodes, to.objectNodes},
          {kSlotMoved, moved_},
          {kSlotBoundsViolation, violation_},
          {kSlotWords, words_}});
  }
  computeWriteToComputeReadWrite(commands);
  for (size_t depth = list_.levels.size(); depth-- > 0;) {
    for (const GeometryList::Level& level : list_.levels[depth]) {
      run_(commands, shaders::kRefit, groupsFor(level.count, kHostGroup),
           RefitPush{level.first, level.count, level.mesh},
           {{kSlotVertices, to.vertices},
            {kSlotTriangles, to.triangles},
            {kSlotMeshes, to.meshes},
            {kSlotMeshNodes, to.meshNodes},
            {kSlotRefitNodes, refitNodes_}});
    }
    computeWriteToComputeReadWrite(commands);
  }
  for (size_t depth = list_.fitEnds.size(); depth-- > 0;) {
    const uint32_t first = depth == 0 ? 0 : list_.fitEnds[depth - 1], count = list_.fitEnds[depth] - first;
    run_(commands, shaders::kFit, groupsFor(count, kHostGroup), FitPush{first, count},
         {{kSlotObjectNodes, to.objectNodes}, {kSlotFitNodes, fitNodes_}});
    computeWriteToComputeReadWrite(commands);
  }
}

void HostGeometryPass::recordReach(const gpu::Commands& commands, const ContactPass& search, const Scene::Impl& scene) {
  using namespace gpu;  // the slots
  const ContactPass::Encoded to = search.encoded();
  if (sensorCount_ != 0) {
    PlacePush push{.count = sensorCount_};
    setAnchor(push, scene.objectTree());
    run_(commands, shaders::kPlace, groupsFor(sensorCount_, kHostGroup), push,
         {{kSlotMeshes, resident_.buffers().meshes},
          {kSlotObjectNodes, resident_.buffers().objectNodes},
          {kSlotSensors, to.sensors},
          {kSlotStates, to.states},
          {kSlotSweeps, to.sweeps},
          {kSlotDeformedSensors, sensors_}});
    computeWriteToComputeReadWrite(commands);
  }
  if (!unbounded().empty() && search.sensorCount() != 0) {
    run_(commands, shaders::kReach, groupsFor(search.sensorCount(), kHostGroup), ReachPush{search.sensorCount()},
         {{kSlotSensors, to.sensors}, {kSlotStates, to.states}, {kSlotObjectNodes, resident_.buffers().objectNodes}});
    computeWriteToComputeReadWrite(commands);
  }
}

void HostGeometryPass::recordInvalidate(const gpu::Commands& commands, const gpu::Array<Result>& results,
                                        uint32_t count) {
  gpu::computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kInvalidate, gpu::groupsFor(count, gpu::kHostGroup), gpu::InvalidatePush{count},
       {{gpu::kSlotResults, results}, {gpu::kSlotBoundsViolation, violation_}});
}

void HostGeometryPass::recordReadback(const gpu::Commands& commands) const {
  if (list_.unboundedMeshes.empty()) return;
  const VkBufferCopy all{0, 0, list_.unboundedMeshes.size() * sizeof(gpu::Extent)};
  commands->CmdCopyBuffer(commands, extents_.get(), readback_.get(), 1, &all);
}

std::map<MeshId, Box> HostGeometryPass::unboundedBoxes() const {
  std::map<MeshId, Box> boxes;
  for (size_t i = 0; i < list_.unboundedMeshes.size(); ++i) {
    const gpu::Extent& extent = readback_.mapped()[i];
    Box& box = boxes[list_.unboundedMeshes[i]];
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = floatOf(extent.lo[k]);
      box.hi[k] = floatOf(~extent.hi[k]);
    }
  }
  return boxes;
}

std::string HostGeometryPass::boundsViolation() const {
  if (empty()) return {};
  const gpu::BoundsViolation& violation = *violation_.mapped();
  for (const GeometryList::Deformed& deformed : list_.meshes) {
    if (violation.mesh != deformed.mesh) continue;
    const uint32_t number =
        deformed.numbers == kNone ? violation.vertex : list_.vertexNumbers[deformed.numbers + violation.vertex];
    return "mesh " + std::to_string(violation.mesh) + ": vertex " + std::to_string(deformed.firstHostVertex + number) +
           (deformed.isBounded ? " is outside its bounds or not finite" : " is not finite, or exceeds 2^120");
  }
  if (violation.object == kNone) return {};
  return "object " + std::to_string(violation.object) +
         (std::ranges::binary_search(unbounded(), violation.object)
              ? ": its transform is not finite, or floats cannot hold its box"
              : ": its mesh's box is outside its bounds, or its transform is not finite");
}

}  // namespace radar
