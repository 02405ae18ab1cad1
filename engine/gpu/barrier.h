// Every barrier of the engine, named by its purpose. synchronization2, exact stages and accesses.
#pragma once

#include "gpu/api.h"

namespace radar::gpu {

/// Depth passes (vertices, indices, draws) and compute shaders (also as texels) read a batch's upload.
void uploadToRead(const Commands& commands);
/// Compute shaders read (also as texels) and write what was copied or filled.
void transferToComputeReadWrite(const Commands& commands);
/// The next compute shader reads (also as texels) or overwrites a compute shader's buffers.
void computeWriteToComputeReadWrite(const Commands& commands);
/// Copies overwrite what earlier compute shaders, also of earlier submissions, read or wrote.
void computeToOverwrite(const Commands& commands);
/// An indirect dispatch reads (also as texels) or overwrites a compute shader's buffers, one of which holds its
/// workgroup counts. After any later barrier from compute shaders the counts may be overwritten.
void computeWriteToIndirect(const Commands& commands);
/// Copies read a compute shader's buffers.
void computeWriteToCopy(const Commands& commands);
/// The host reads what was copied, after the fence.
void copyToHost(const Commands& commands);
/// The host reads what was copied or a compute shader wrote, after the fence.
void writtenToHost(const Commands& commands);
/// Copies read depth that a render pass left in SHADER_READ_ONLY layout; the layout becomes TRANSFER_SRC.
void sampledDepthToCopy(const Commands& commands, VkImage image);

/// Discards a depth image's contents; its layout becomes SHADER_READ_ONLY before compute shaders and all that waits for
/// them.
void undefinedToSampledDepth(const Commands& commands, VkImage image);
/// A full barrier, for profiling only.
void everythingToEverything(const Commands& commands);

}  // namespace radar::gpu
