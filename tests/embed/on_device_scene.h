// A scene's copy on the device, overwritten with a host's geometry.
#pragma once

#include "embed/host_geometry.h"
#include "gpu/barrier.h"
#include "gpu/submission.h"
#include "support/buffer_words.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace radar::test {

class OnDeviceScene {
 public:
  explicit OnDeviceScene(const Scene& scene)
      : copy(test::device().impl()), scene_(scene), pass_(test::device().impl(), copy) {}
  OnDeviceScene(const Scene& scene, const HostGeometry& geometry) : OnDeviceScene(scene) { move(geometry); }

  /// A recording of so many searches.
  void move(const HostGeometry& geometry, uint32_t searches = 0) {
    CHECK(validate(geometry, scene_).empty());
    const Device::Impl& device = test::device().impl();
    gpu::Upload upload(device);
    pass_.stage(geometry, scene_.impl());
    GpuScene::Staged staged = copy.stage(scene_.impl(), pass_.overwritten(), upload);
    gpu::Submission submission(device, false);
    const gpu::Commands commands = submission.begin();
    upload.record(commands);
    gpu::uploadToRead(commands);
    gpu::transferToComputeReadWrite(commands);
    pass_.record(commands, scene_.impl(), searches);
    copy.commit(std::move(staged));
    pass_.confirm();
    submission.submitAndWait();
    CHECK(pass_.boundsViolation().empty());
  }
  /// Of the tree over objects, with those that are built behind the scene's.
  std::vector<gpu::ObjectNode> objectNodes() const {
    const std::shared_ptr<const GpuScene::Moved> moved = pass_.overwritten().moved;
    return elementsOf(copy.buffers().objectNodes, 0,
                      scene_.impl().objectTree().nodes().size() + (moved ? moved->built : 0));
  }

  GpuScene copy;

 private:
  const Scene& scene_;
  HostGeometryPass pass_;
};

}  // namespace radar::test
