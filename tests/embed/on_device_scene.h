// A scene's copy on the device, overwritten with a host's geometry.
#pragma once

#include "embed/host_geometry.h"
#include "gpu/barrier.h"
#include "gpu/submission.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace radar::test {

struct OnDeviceScene {
  OnDeviceScene(const Scene& scene, const HostGeometry& geometry) : copy(test::device().impl()) {
    CHECK(validate(geometry, scene).empty());
    const Device::Impl& device = test::device().impl();
    HostGeometryPass pass(device, copy);
    gpu::Upload upload(device);
    pass.stage(geometry, scene.impl());
    copy.stage(scene.impl(), {}, upload);
    gpu::Submission submission(device, false);
    const gpu::Commands commands = submission.begin();
    upload.record(commands);
    gpu::uploadToRead(commands);
    gpu::transferToComputeReadWrite(commands);
    pass.record(commands, scene.impl());
    submission.submitAndWait();
    CHECK(pass.boundsViolation().empty());
  }
  GpuScene copy;
};

}  // namespace radar::test
