// Every barrier of the engine, named by its purpose. synchronization2, exact stages and accesses.
#pragma once

#include "gpu/api.h"

namespace radar::gpu {

/// A batch's upload is read by depth passes (vertices, indices, draws) and by compute shaders, there also as texels.
void uploadToRead(const Commands& commands);
/// What was copied, or filled, is read (also as texels) and written by compute shaders.
void transferToComputeReadWrite(const Commands& commands);
/// A compute shader's buffers are read (also as texels), or written again, by the next one.
void computeWriteToComputeReadWrite(const Commands& commands);
/// A compute shader's buffers are read (also as texels), or written again, by an indirect dispatch, and its workgroup
/// counts are in one of them. Any barrier from compute shaders then lets the counts be overwritten.
void computeWriteToIndirect(const Commands& commands);
/// A compute shader's buffers are copied.
void computeWriteToCopy(const Commands& commands);
/// What was copied is read by the host after the fence.
void copyToHost(const Commands& commands);
/// What was copied, or written by a compute shader, is read by the host after the fence.
void writtenToHost(const Commands& commands);
/// Depth that a render pass left in SHADER_READ_ONLY layout is copied; the layout changes to TRANSFER_SRC.
void sampledDepthToCopy(const Commands& commands, VkImage image);

/// A depth image's contents are given up; its layout becomes SHADER_READ_ONLY, before compute shaders and whatever
/// waits for them.
void undefinedToSampledDepth(const Commands& commands, VkImage image);
/// Profiling runs only: everything before has ended before anything after begins.
void everythingToEverything(const Commands& commands);

}  // namespace radar::gpu
