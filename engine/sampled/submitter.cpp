#include "sampled/submitter.h"

#include <algorithm>
#include <tuple>

#include "gpu/barrier.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;
using gpu::bytesOf;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkBufferUsageFlags kComputed = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

}  // namespace

SampledSubmitter::SampledSubmitter(const Device::Impl& device, GpuScene& resident, uint64_t pictureBytes,
                                   bool timestamps)
    : device_(&device),
      pictureBytes_(pictureBytes),
      resident_(resident),
      upload_(device),
      submission_(device, timestamps),
      run_(device, {gpu::depthShader(device), shaders::kReduce, shaders::kIdentify, shaders::kSolve}),
      renderPass_(gpu::depthRenderPass(device)),
      sampler_(gpu::texelSampler(device)),
      views_(device, "views", BufferDomain::device, kUploaded),
      draws_(device, "draws", BufferDomain::device, kUploaded),
      items_(device, "items", BufferDomain::device, kUploaded),
      candidates_(device, "candidates", BufferDomain::device, kComputed),
      ranks_(device, "ranks", BufferDomain::device, kComputed),
      answers_(device, "answers", BufferDomain::device, kComputed),
      unresolvedPairs_(device, "unresolved pairs", BufferDomain::device, kComputed),
      readback_(device, "readback", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

SampledSubmitter::Pictures& SampledSubmitter::picturesFor(const SampledBatch& batch) {
  const auto found = pictures_.find(batch.resolution);
  if (found != pictures_.end() && found->second.range.layers() >= batch.layers) return found->second;
  if (found != pictures_.end()) pictures_.erase(found);  // before its successor is allocated
  const auto bytes = [](uint64_t side, uint64_t layers) { return 2 * side * side * layers * sizeof(float); };
  uint64_t kept = bytes(batch.resolution, batch.layers);
  for (const auto& [side, pictures] : pictures_) kept += bytes(side, pictures.range.layers());
  if (kept > 2 * pictureBytes_) pictures_.clear();
  gpu::DepthArray range(*device_, "R", renderPass_.get(), batch.resolution, batch.layers);
  gpu::DepthArray mask(*device_, "M", renderPass_.get(), batch.resolution, batch.layers);
  return pictures_.emplace(batch.resolution, Pictures{std::move(range), std::move(mask)}).first->second;
}

void SampledSubmitter::stage(const SampledBatch& batch, const Scene::Impl& scene) {
  views_.reserve(batch.views.size());
  draws_.reserve(batch.draws.size());
  items_.reserve(batch.items.size());
  candidates_.reserve(batch.views.size() * gpu::kCells);
  ranks_.reserve(batch.views.size() * gpu::kCells);
  answers_.reserve(batch.views.size());
  unresolvedPairs_.reserve(batch.views.size() * gpu::kUnresolvedPerView);
  upload_.begin();
  staged_ = resident_.stage(scene, {}, upload_);
  upload_.add(batch.views.data(), bytesOf(batch.views), views_);
  upload_.add(batch.draws.data(), bytesOf(batch.draws), draws_);
  upload_.add(batch.items.data(), bytesOf(batch.items), items_);
}

void SampledSubmitter::drawScopes(const gpu::Commands& commands, const SampledBatch& batch,
                                  const std::vector<DepthPass>& passes, gpu::DepthArray& target) const {
  for (const DepthPass& pass : passes) {
    target.beginPass(commands, pass.firstLayer, pass.layers, pass.resolution);
    for (uint32_t i = pass.firstCall; i < pass.firstCall + pass.calls; ++i) {
      const DrawCall& call = batch.calls[i];
      const gpu::MeshRecord& record = resident_.record(call.mesh);
      commands->CmdDrawIndexed(commands, 3 * call.run.count, call.count, 3 * (record.firstTriangle + call.run.first), 0,
                               call.firstDraw);
    }
    commands->CmdEndRenderPass(commands);
  }
}

// Where the parts of the readback lie.
SampledSubmitter::Readback SampledSubmitter::readbackOf(const SampledBatch& batch, bool scopes) {
  const VkDeviceSize views = batch.views.size();
  return {views * sizeof(gpu::Answer), views * gpu::kUnresolvedPerView * sizeof(gpu::SampledUnresolved),
          scopes ? VkDeviceSize{batch.views[0].width} * batch.views[0].height * sizeof(float) : 0};
}

void SampledSubmitter::submit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes) {
  try {
    recordAndSubmit(batch, scene, scopes);
  } catch (...) {
    pictures_.clear();  // the images' layouts are unknown
    throw;
  }
}

// Draws R and M, and solves by them.
void SampledSubmitter::record(const gpu::Commands& commands, const SampledBatch& batch, Pictures& pictures) {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& scene = resident_.buffers();
  const VkBuffer vertices = scene.vertices.get();
  const VkDeviceSize zero = 0;
  run_.bindForDraws(commands, gpu::depthShader(*device_), {{kSlotDraws, draws_}});
  commands->CmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
  commands->CmdBindIndexBuffer(commands, scene.indices.get(), 0, VK_INDEX_TYPE_UINT32);
  submission_.stage("range");
  drawScopes(commands, batch, batch.rangePasses, pictures.range);
  submission_.stage("mask");
  drawScopes(commands, batch, batch.maskPasses, pictures.mask);

  const auto views = static_cast<uint32_t>(batch.views.size()), items = static_cast<uint32_t>(batch.items.size());
  submission_.stage("reduce");
  run_(commands, shaders::kReduce, views,
       {{kSlotViews, views_},
        {kSlotCandidates, candidates_},
        {kSlotRanks, ranks_},
        {kSlotAnswers, answers_},
        {kSlotRange, pictures.range, sampler_.get()},
        {kSlotMask, pictures.mask, sampler_.get()}});
  computeWriteToComputeReadWrite(commands);
  submission_.stage("identify");
  run_(commands, shaders::kIdentify, items, IdentifyPush{items},
       {{kSlotVertices, scene.vertices},
        {kSlotTriangles, scene.triangles},
        {kSlotMeshes, scene.meshes},
        {kSlotViews, views_},
        {kSlotDraws, draws_},
        {kSlotItems, items_},
        {kSlotRanks, ranks_},
        {kSlotAnswers, answers_},
        {kSlotCandidates, candidates_}});
  computeWriteToComputeReadWrite(commands);
  submission_.stage("solve");
  run_(commands, shaders::kSolve, views,
       {{kSlotVertices, scene.vertices},
        {kSlotTriangles, scene.triangles},
        {kSlotMeshes, scene.meshes},
        {kSlotObjects, scene.objects},
        {kSlotViews, views_},
        {kSlotDraws, draws_},
        {kSlotItems, items_},
        {kSlotCandidates, candidates_},
        {kSlotAnswers, answers_},
        {kSlotSampledUnresolved, unresolvedPairs_}});
}

void SampledSubmitter::recordAndSubmit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes) {
  Pictures& pictures = picturesFor(batch);
  stage(batch, scene);
  run_.begin();
  const auto [answerBytes, openBytes, pictureBytes] = readbackOf(batch, scopes);
  const VkDeviceSize listBytes = answerBytes + openBytes;
  readback_.reserve(listBytes + 2 * pictureBytes);

  const gpu::Commands commands = submission_.begin();
  gpu::computeToOverwrite(commands);  // a recording that shares the scene's copy may still be searching it
  submission_.stage("upload");
  upload_.record(commands);
  pictures.range.recordFirstUse(commands);
  pictures.mask.recordFirstUse(commands);
  gpu::uploadToRead(commands);

  record(commands, batch, pictures);
  gpu::computeWriteToCopy(commands);

  submission_.stage("readback");
  const VkBufferCopy answerCopy{0, 0, answerBytes}, openCopy{0, answerBytes, openBytes};
  commands->CmdCopyBuffer(commands, answers_.get(), readback_.get(), 1, &answerCopy);
  commands->CmdCopyBuffer(commands, unresolvedPairs_.get(), readback_.get(), 1, &openCopy);
  if (scopes) {
    const auto [layer, width, height] = std::tuple(batch.views[0].layer, batch.views[0].width, batch.views[0].height);
    pictures.range.recordCopy(commands, layer, width, height, readback_.get(), listBytes);
    pictures.mask.recordCopy(commands, layer, width, height, readback_.get(), listBytes + pictureBytes);
  }
  gpu::copyToHost(commands);
  submission_.submit();
}

SampledAnswers SampledSubmitter::collect(const SampledBatch& batch, std::vector<StageTime>& stages,
                                         StoredScopes* scopes) {
  submission_.wait();
  resident_.commit(std::move(staged_));
  submission_.addTimes(stages);
  const auto [answerBytes, openBytes, pictureBytes] = readbackOf(batch, scopes != nullptr);
  if (scopes != nullptr) {
    const auto* at = reinterpret_cast<const float*>(readback_.mapped() + answerBytes + openBytes);
    scopes->range.assign(at, at + pictureBytes / sizeof(float));
    scopes->mask.assign(at + pictureBytes / sizeof(float), at + 2 * pictureBytes / sizeof(float));
  }
  const size_t views = batch.views.size();
  return {{reinterpret_cast<const gpu::Answer*>(readback_.mapped()), views},
          {reinterpret_cast<const gpu::SampledUnresolved*>(readback_.mapped() + answerBytes),
           views * gpu::kUnresolvedPerView}};
}

}  // namespace radar
