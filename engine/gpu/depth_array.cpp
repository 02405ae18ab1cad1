#include "gpu/depth_array.h"

#include "gpu/api.h"
#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "spirv/radar_shaders.h"

namespace radar::gpu {

namespace {

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
// Maximum number of cached framebuffers, one per range of layers; batches of one shape need a few dozen.
constexpr size_t kKeptTargets = 512;

ImageView layerView(const Device::Impl& device, VkImage image, uint32_t first, uint32_t count) {
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = image,
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                                   .format = kDepthFormat,
                                   .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, first, count}};
  return {device, info};
}

}  // namespace

RenderPass depthRenderPass(const Device::Impl& device) {
  const VkAttachmentDescription attachment{.format = kDepthFormat,
                                           .samples = VK_SAMPLE_COUNT_1_BIT,
                                           .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                           .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                           .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                           .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                           .finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                     .pDepthStencilAttachment = &reference};
  constexpr VkPipelineStageFlags kDepthStages =
      VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkSubpassDependency dependencies[] = {
      {.srcSubpass = VK_SUBPASS_EXTERNAL,
       .dstSubpass = 0,
       .srcStageMask = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
       .dstStageMask = kDepthStages,
       .srcAccessMask = 0,
       .dstAccessMask = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
      {.srcSubpass = 0,
       .dstSubpass = VK_SUBPASS_EXTERNAL,
       .srcStageMask = kDepthStages,
       .dstStageMask = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
       .srcAccessMask = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
       .dstAccessMask = VK_ACCESS_SHADER_READ_BIT}};
  const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                    .attachmentCount = 1,
                                    .pAttachments = &attachment,
                                    .subpassCount = 1,
                                    .pSubpasses = &subpass,
                                    .dependencyCount = 2,
                                    .pDependencies = dependencies};
  return {device, info};
}

Sampler texelSampler(const Device::Impl& device) {
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .magFilter = VK_FILTER_NEAREST,
                                 .minFilter = VK_FILTER_NEAREST,
                                 .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  return {device, info};
}

const Shader& depthShader(const Device::Impl& device) {
  return device.choosesLayers ? shaders::kDepth : shaders::kDepthOfOneLayer;
}

DepthArray::DepthArray(const Owner& owner, const char* name, VkRenderPass renderPass, uint32_t side, uint32_t layers)
    : device_(&owner.device()), renderPass_(renderPass), side_(side), layers_(layers), identity_(newIdentity()) {
  const Device::Impl& device = owner;
  const std::string what = std::string(name) + ", " + std::to_string(side) + " x " + std::to_string(side) + " x " +
                           std::to_string(layers) + " of D32";
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = kDepthFormat,
                               .extent = {side, side, 1},
                               .mipLevels = 1,
                               .arrayLayers = layers,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
  image_ = {device, info, what.c_str()};
  const VkImage image = image_.get();
  MemoryRequest request{.preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, .isImage = true, .name = what.c_str()};
  device.vk.GetImageMemoryRequirements(device.device(), image, &request.requirements);
  memory_ = Memory(owner, request);
  check(device.vk.BindImageMemory(device.device(), image, memory_.get(), memory_.offset()), "vkBindImageMemory",
        what.c_str());
  view_ = layerView(device, image, 0, layers);
}

void DepthArray::recordFirstUse(const Commands& commands) {
  if (targets_.size() > kKeptTargets) targets_.clear();
  if (used_) return;
  used_ = true;
  undefinedToSampledDepth(commands, image_.get());
}

void DepthArray::beginPass(const Commands& commands, uint32_t first, uint32_t count, uint32_t side) {
  auto [entry, fresh] = targets_.try_emplace({first, count});
  Target& target = entry->second;
  if (fresh) {
    target.view = layerView(*device_, image_.get(), first, count);
    const VkImageView attachment = target.view.get();
    const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = renderPass_,
                                       .attachmentCount = 1,
                                       .pAttachments = &attachment,
                                       .width = side_,
                                       .height = side_,
                                       .layers = count};
    target.framebuffer = {*device_, info, nullptr, count, "layers"};
  }
  const VkClearValue clear{.depthStencil = {1.0f, 0}};
  const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                    .renderPass = renderPass_,
                                    .framebuffer = target.framebuffer.get(),
                                    .renderArea = {{0, 0}, {side, side}},
                                    .clearValueCount = 1,
                                    .pClearValues = &clear};
  commands->CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  const VkViewport viewport{0, 0, static_cast<float>(side), static_cast<float>(side), 0, 1};
  const VkRect2D scissor{{0, 0}, {side, side}};
  commands->CmdSetViewport(commands, 0, 1, &viewport);
  commands->CmdSetScissor(commands, 0, 1, &scissor);
}

void DepthArray::recordCopy(const Commands& commands, uint32_t layer, uint32_t width, uint32_t height, VkBuffer target,
                            VkDeviceSize offset) {
  sampledDepthToCopy(commands, image_.get());
  const VkBufferImageCopy region{.bufferOffset = offset,
                                 .imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, layer, 1},
                                 .imageExtent = {width, height, 1}};
  commands->CmdCopyImageToBuffer(commands, image_.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, 1, &region);
  used_ = false;
}

}  // namespace radar::gpu
