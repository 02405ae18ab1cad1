#include <cstdio>
#include <vector>

#include <radar/radar.h>
#include <vulkan/vulkan.h>

int main() {
  // Stands for a renderer's own set-up: an instance, a device with the required features, and a queue.
  VkInstance instance;
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo instanceInfo{};
  instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  instanceInfo.pApplicationInfo = &application;
  if (vkCreateInstance(&instanceInfo, nullptr, &instance) != VK_SUCCESS) return 1;
  radar::HostDevice host = radar::hostOf(instance, VK_NULL_HANDLE, vkGetInstanceProcAddr);
  radar::Requirements needed = radar::requirements(host);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = host.queueFamily;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo deviceInfo{};
  deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  deviceInfo.pNext = needed.chain();
  deviceInfo.queueCreateInfoCount = 1;
  deviceInfo.pQueueCreateInfos = &queue;
  if (vkCreateDevice(host.physicalDevice, &deviceInfo, nullptr, &host.device) != VK_SUCCESS) return 1;
  vkGetDeviceQueue(host.device, host.queueFamily, 0, &host.queue);

  // The engine uses that device and must be destroyed before it.
  {
    const radar::Device device = radar::Device::adopt(host);
    radar::Scene scene;
    const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    const uint32_t triangle[] = {0, 1, 2};
    const radar::MeshId mesh = scene.addMesh(corners, triangle);
    const radar::ObjectId wall = scene.addObject({.mesh = mesh});
    radar::Sweeper sweeper(device, scene);
    for (int frame = 0; frame < 3; ++frame) {
      scene.setTransform(wall, {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5.0 + frame}});
      const std::vector<radar::Query> queries{{.mesh = mesh, .direction = {0, 0, 1}, .distance = 10}};
      for (const radar::Result& result : sweeper.run(queries).results) std::printf("free for %g\n", result.t);
    }
  }
  vkDestroyDevice(host.device, nullptr);
  vkDestroyInstance(instance, nullptr);
}
