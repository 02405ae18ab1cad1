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

}  // namespace

SampledSubmitter::SampledSubmitter(const gpu::Owner& owner, GpuScene& resident, uint64_t pictureBytes, bool timestamps)
    : owner_(owner),
      pictureBytes_(pictureBytes),
      resident_(resident),
      upload_(owner),
      submission_(owner, timestamps),
      run_(owner, {gpu::depthShader(owner), shaders::kReduce, shaders::kIdentify, shaders::kNominate}),
      solver_(owner, resident),
      renderPass_(gpu::depthRenderPass(owner)),
      sampler_(gpu::texelSampler(owner)),
      views_(owner, "views", BufferDomain::device, kUploaded),
      draws_(owner, "draws", BufferDomain::device, kUploaded),
      items_(owner, "items", BufferDomain::device, kUploaded),
      candidates_(owner, "candidates", BufferDomain::device),
      ranks_(owner, "ranks", BufferDomain::device),
      answers_(owner, "answers", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_SRC_BIT),
      readback_(owner, "readback", BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

SampledSubmitter::Pictures& SampledSubmitter::picturesFor(const SampledBatch& batch) {
  const auto found = pictures_.find(batch.resolution);
  if (found != pictures_.end() && found->second.range.layers() >= batch.layers) return found->second;
  if (found != pictures_.end()) pictures_.erase(found);  // before its successor is allocated
  const auto bytes = [](uint64_t side, uint64_t layers) { return 2 * side * side * layers * sizeof(float); };
  uint64_t kept = bytes(batch.resolution, batch.layers);
  for (const auto& [side, pictures] : pictures_) kept += bytes(side, pictures.range.layers());
  if (kept > 2 * pictureBytes_) pictures_.clear();
  gpu::DepthArray range(owner_, "R", renderPass_.get(), batch.resolution, batch.layers);
  gpu::DepthArray mask(owner_, "M", renderPass_.get(), batch.resolution, batch.layers);
  return pictures_.emplace(batch.resolution, Pictures{std::move(range), std::move(mask)}).first->second;
}

void SampledSubmitter::stage(const SampledBatch& batch, const Scene::Impl& scene) {
  const auto views = static_cast<uint32_t>(batch.views.size());
  // A device without doubles leaves all pairs to the CPU.
  const uint32_t pairs = views * gpu::kPairsPerView;
  solver_.reserve(views, views, pairs, pairs);
  views_.reserve(views);
  draws_.reserve(batch.draws.size());
  items_.reserve(batch.items.size());
  candidates_.reserve(views * gpu::kCells);
  ranks_.reserve(views * gpu::kCells);
  answers_.reserve(views);
  upload_.begin();
  staged_ = resident_.stage(scene, {}, upload_);
  solver_.begin(views, upload_);
  upload_.add(batch.sweeps.data(), bytesOf(batch.sweeps), solver_.lists().sweeps);
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

SampledSubmitter::Readback SampledSubmitter::readbackOf(const SampledBatch& batch, bool scopes) {
  const VkDeviceSize views = batch.views.size();
  const VkDeviceSize picture = scopes ? VkDeviceSize{batch.views[0].width} * batch.views[0].height * sizeof(float) : 0;
  Readback parts{};
  parts.contacts = PairSolver::kFirstResult;
  parts.answers = parts.contacts + views * sizeof(Result);
  parts.range = parts.answers + views * sizeof(gpu::Answer);
  parts.mask = parts.range + picture;
  parts.end = parts.mask + picture;
  return parts;
}

void SampledSubmitter::submit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes) {
  try {
    recordAndSubmit(batch, scene, scopes);
  } catch (...) {
    pictures_.clear();  // the images' layouts are unknown
    throw;
  }
}

// Draws R and M, and solves the pairs that they propose.
void SampledSubmitter::record(const gpu::Commands& commands, const SampledBatch& batch, Pictures& pictures) {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& scene = resident_.buffers();
  const VkBuffer vertices = scene.vertices.get();
  const VkDeviceSize zero = 0;
  run_.bindForDraws(commands, gpu::depthShader(owner_), {{kSlotDraws, draws_}});
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
        {kSlotStates, solver_.lists().states},
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
  run_(commands, shaders::kNominate, views,
       {{kSlotMeshes, scene.meshes},
        {kSlotDraws, draws_},
        {kSlotItems, items_},
        {kSlotCandidates, candidates_},
        {kSlotAnswers, answers_},
        {kSlotCounts, solver_.lists().counts},
        {kSlotRefinedPairs, solver_.lists().refinedPairs}});
  computeWriteToComputeReadWrite(commands);
  const uint32_t pairs = gpu::groupsFor(uint64_t{views} * kPairsPerView, kContactGroup);
  solver_.record(
      commands, [this](const char* name) { submission_.stage(name); }, pairs, false, false);
}

void SampledSubmitter::recordAndSubmit(const SampledBatch& batch, const Scene::Impl& scene, bool scopes) {
  Pictures& pictures = picturesFor(batch);
  stage(batch, scene);
  run_.begin();
  const Readback parts = readbackOf(batch, scopes);
  readback_.reserve(parts.end);

  const gpu::Commands commands = submission_.begin();
  gpu::computeToOverwrite(commands);  // a recording that shares the scene's copy may still be searching it
  submission_.stage("upload");
  upload_.record(commands);
  solver_.recordReset(commands);
  pictures.range.recordFirstUse(commands);
  pictures.mask.recordFirstUse(commands);
  gpu::uploadToRead(commands);
  gpu::transferToComputeReadWrite(commands);

  record(commands, batch, pictures);
  gpu::computeWriteToCopy(commands);

  submission_.stage("readback");
  const PairSolver::Lists& lists = solver_.lists();
  const VkBufferCopy counts{0, 0, sizeof(gpu::SearchCounts)},
      contacts{0, parts.contacts, parts.answers - parts.contacts},
      answers{0, parts.answers, parts.range - parts.answers};
  commands->CmdCopyBuffer(commands, lists.counts.get(), readback_.get(), 1, &counts);
  commands->CmdCopyBuffer(commands, lists.results.get(), readback_.get(), 1, &contacts);
  commands->CmdCopyBuffer(commands, answers_.get(), readback_.get(), 1, &answers);
  if (scopes) {
    const auto [layer, width, height] = std::tuple(batch.views[0].layer, batch.views[0].width, batch.views[0].height);
    pictures.range.recordCopy(commands, layer, width, height, readback_.get(), parts.range);
    pictures.mask.recordCopy(commands, layer, width, height, readback_.get(), parts.mask);
  }
  gpu::writtenToHost(commands);
  submission_.submit();
}

SampledAnswers SampledSubmitter::collect(const SampledBatch& batch, std::vector<StageTime>& stages,
                                         StoredScopes* scopes) {
  submission_.wait();
  resident_.commit(std::move(staged_));
  submission_.addTimes(stages);
  const Readback parts = readbackOf(batch, scopes != nullptr);
  const auto* const read = readback_.mapped();
  if (scopes != nullptr) {
    const auto floatsAt = [&](VkDeviceSize at) { return reinterpret_cast<const float*>(read + at); };
    scopes->range.assign(floatsAt(parts.range), floatsAt(parts.mask));
    scopes->mask.assign(floatsAt(parts.mask), floatsAt(parts.end));
  }
  const auto& counts = *reinterpret_cast<const gpu::SearchCounts*>(read);
  const size_t views = batch.views.size();
  return {{reinterpret_cast<const gpu::Answer*>(read + parts.answers), views},
          {reinterpret_cast<const Result*>(read + parts.contacts), views},
          solver_.unresolved(counts),
          counts.refinedPairs};
}

}  // namespace radar
