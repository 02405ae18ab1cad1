// A miniature host: it owns instance, device and queue; the engine borrows them and destroys nothing.
#include <catch2/catch.hpp>

#include "gpu/check.h"
#include "gpu/requirements.h"
#include "support/test_device.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using gpu::check;

struct Host {
  Host() {
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instanceInfo{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                            .pApplicationInfo = &application};
    check(vkCreateInstance(&instanceInfo, nullptr, &handles.instance), "vkCreateInstance");
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(handles.instance, &count, &handles.physicalDevice);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = 0,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    gpu::Features features;
    handles.doubles = gpu::factsOf(handles.physicalDevice).doubles;
    gpu::enableRequired(features, handles.doubles);
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features.core,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue};
    check(vkCreateDevice(handles.physicalDevice, &info, nullptr, &handles.device), "vkCreateDevice");
    vkGetDeviceQueue(handles.device, 0, 0, &handles.queue);
  }
  ~Host() {
    vkDestroyDevice(handles.device, nullptr);
    vkDestroyInstance(handles.instance, nullptr);
  }
  HostDevice handles;
};

}  // namespace

TEST_CASE("an adopted device answers like an opened one and is still the host's afterwards") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  Scene scene;
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  scene.addObject({mesh, {{1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 4}}, ~0u});
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 10, .mode = Mode::sampled};
  Sweeper own(test::device(), scene);
  const Result expected = own.run({&query, 1})[0];

  Host host;
  for (int i = 0; i < 2; ++i) {
    const Device device = Device::adopt(host.handles);
    Sweeper sweeper(device, scene);
    const Result result = sweeper.run({&query, 1})[0];
    CHECK(result.status == Status::hit);
    CHECK(result.t == expected.t);
  }
  CHECK(vkDeviceWaitIdle(host.handles.device) == VK_SUCCESS);
}

TEST_CASE("several sweepers share one device and one scene") {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  Scene scene;
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
  const ObjectId object = scene.addObject({mesh, {{1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 4}}, ~0u});
  Sweeper first(test::device(), scene), second(test::device(), scene);
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 10, .mode = Mode::sampled};
  CHECK(first.run({&query, 1})[0].t == second.run({&query, 1})[0].t);
  scene.setPose(object, {{1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 6}});
  CHECK(second.run({&query, 1})[0].t == first.run({&query, 1})[0].t);
}

TEST_CASE("a device that does not exist is refused with the number there are") {
  CHECK_THROWS_WITH(Device::open({.index = 1000}), Catch::Contains("device 1000 does not exist"));
}
