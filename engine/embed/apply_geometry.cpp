#include "embed/download.h"
#include "embed/host_format.h"
#include "embed/host_geometry.h"
#include "embed/host_transforms.h"
#include "math/float_environment.h"
#include "scene/scene.h"

namespace radar {

void applyGeometry(Scene& scene, const Device& device, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  device.impl().requireQueue("applyGeometry");
  if (std::string wrong = validate(geometry, scene); !wrong.empty()) throw Error("applyGeometry: " + wrong);
  Download download(device.impl());
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.impl().meshes[deformed.mesh];
    const HostPositions& from = deformed.positions;
    const uint32_t vertices = mesh.hostVertex(mesh.vertexCount() - 1) - mesh.firstHostVertex + 1;
    download.add(from.buffer, from.first + from.stride * mesh.firstHostVertex, spanOf(from, vertices));
  }
  for (const MovedObjects& moved : geometry.objects) {
    if (moved.objects.empty()) continue;
    download.add(moved.transforms, moved.first, spanOf(moved.stride, moved.objects.size(), extentOf(moved.layout)));
  }
  download.run();
  size_t range = geometry.meshes.size();
  std::vector<ObjectId> objects;
  std::vector<Transform> transforms;
  for (const MovedObjects& moved : geometry.objects) {
    if (moved.objects.empty()) continue;
    const std::byte* bytes = download.bytes(range++);
    for (size_t i = 0; i < moved.objects.size(); ++i) {
      objects.push_back(moved.objects[i]);
      transforms.push_back(readTransform(bytes + i * moved.stride, moved.layout));
    }
  }
  if (!objects.empty()) scene.setTransforms(objects, transforms);
  range = 0;
  std::vector<float> positions;
  for (const DeformedMesh& deformed : geometry.meshes) {
    const Mesh& mesh = scene.impl().meshes[deformed.mesh];
    const HostFormat format(deformed.positions.format);
    const std::byte* bytes = download.bytes(range++);
    positions.clear();
    for (uint32_t v = 0; v < mesh.vertexCount(); ++v) {
      const std::byte* at = bytes + deformed.positions.stride * (mesh.hostVertex(v) - mesh.firstHostVertex);
      for (int k = 0; k < 3; ++k) positions.push_back(format.load(at, k));
    }
    try {
      scene.setPositions(deformed.mesh, positions);
    } catch (const Error& error) {
      throw Error("applyGeometry: mesh " + std::to_string(deformed.mesh) + ": " + error.what());
    }
  }
}

}  // namespace radar
