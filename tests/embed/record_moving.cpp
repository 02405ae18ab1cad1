#include <span>

#include <radar/recorder.h>

#include "after_shaders.h"

// Geometry that a renderer's compute shaders move: a character that they skin and crates that they push around a hall.
struct Moving {
  radar::MeshId body;
  VkBuffer skinned;     // the character's vertices, 32 bytes each, a float3 position first
  VkBuffer transforms;  // a VkTransformMatrixKHR for each crate
  radar::ObjectId firstCrate;
};

// Called while loading. `restPose` holds the character as it was modelled.
void addMoving(radar::Scene& scene, const radar::Device& device, const radar::HostMesh& restPose, radar::MeshId crate,
               Moving& moving) {
  moving.body = radar::addMesh(scene, device, restPose);
  scene.addObject({.mesh = moving.body});
  moving.firstCrate = scene.objectLimit();
  for (int i = 0; i < 20; ++i) scene.addObject({.mesh = crate});
}

// Called once per frame, after the compute shaders have been recorded. The queries see what these shaders write.
void recordMoving(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries,
                  const Moving& moving) {
  afterShaders(commands, radar::Recorder::kReads);
  const radar::DeformedMesh body{moving.body, {.buffer = moving.skinned, .stride = 32}};
  const radar::MovedObjects crates{.transforms = moving.transforms, .firstObject = moving.firstCrate, .count = 20};
  recorder.record(commands, queries, {.meshes = {&body, 1}, .objects = {&crates, 1}});
}
