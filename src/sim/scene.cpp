#include "fleetmap/sim/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "embree_functions.hpp"

namespace fleetmap::sim {
namespace {

/// Packets of 16 rays that lie side by side are 3 to 4 times faster than single rays or streams.
constexpr std::size_t kPacket = 16;
constexpr unsigned kNothing = RTC_INVALID_GEOMETRY_ID;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Status check(const Mesh& mesh) {
  if (mesh.empty()) return failure("the mesh has no triangles; nothing could be seen in it");
  if (mesh.materials.size() != mesh.triangles.size()) {
    return failure("the mesh has " + std::to_string(mesh.triangles.size()) + " triangles but " +
                   std::to_string(mesh.materials.size()) + " materials; each triangle needs one");
  }
  if (mesh.vertices.size() > kNothing || mesh.triangles.size() > kNothing) {
    return failure("the mesh has more than 4 billion vertices or triangles; cut it into smaller sites");
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) {
      return failure("vertex " + std::to_string(i) + " of the mesh is not finite; repair the mesh");
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex < mesh.vertices.size()) continue;
      return failure("triangle " + std::to_string(i) + " of the mesh names vertex " + std::to_string(vertex) +
                     " of " + std::to_string(mesh.vertices.size()) + "; repair the mesh");
    }
  }
  return {};
}

/// Rays that Embree accepts; it asserts on rays that are not finite.
bool usable(const Ray& ray) {
  const float length = ray.direction.squaredNorm();
  return length > 0.25f && length < 4.0f && std::isfinite(ray.origin.sum());
}

}  // namespace

struct Scene::State {
  explicit State(const EmbreeFunctions& functions) : embree(functions) {}

  EmbreeFunctions embree;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Material> materials;

  ~State() {
    if (scene != nullptr) embree.release_scene(scene);
    if (device != nullptr) embree.release_device(device);
  }

  void cast_packet(std::span<const Ray> rays, float min_range, float max_range, std::span<Hit> hits) const;
};

Scene::Scene(std::unique_ptr<State> state) : state_(std::move(state)) {}
Scene::~Scene() = default;

Result<std::shared_ptr<const Scene>> Scene::create(const Mesh& mesh) {
  if (const Status sound = check(mesh); !sound) return tl::unexpected(sound.error());
  const auto embree = load_embree();
  if (!embree) return tl::unexpected(embree.error());
  auto state = std::make_unique<State>(*embree);
  state->device = embree->new_device("threads=1");  // the tree does not depend on the number of cores
  if (state->device == nullptr) {
    return failure("Embree does not start on this computer (error " +
                   std::to_string(static_cast<int>(embree->device_error(nullptr))) +
                   "); it needs a CPU with SSE2");
  }
  RTCGeometry geometry = embree->new_geometry(state->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = embree->set_new_geometry_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                   sizeof(Eigen::Vector3f), mesh.vertices.size());
  void* triangles =
      embree->set_new_geometry_buffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                      sizeof(std::array<std::uint32_t, 3>), mesh.triangles.size());
  if (vertices != nullptr && triangles != nullptr) {
    // A vertex is three floats in a row.
    std::memcpy(vertices, static_cast<const void*>(mesh.vertices.data()),
                mesh.vertices.size() * sizeof(Eigen::Vector3f));
    std::memcpy(triangles, mesh.triangles.data(),
                mesh.triangles.size() * sizeof(std::array<std::uint32_t, 3>));
    embree->commit_geometry(geometry);
    state->scene = embree->new_scene(state->device);
    embree->set_scene_flags(state->scene,
                            RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
    embree->attach_geometry(state->scene, geometry);
    embree->commit_scene(state->scene);
  }
  embree->release_geometry(geometry);
  const RTCError error = embree->device_error(state->device);
  if (error != RTC_ERROR_NONE || state->scene == nullptr) {
    return failure("a mesh of " + std::to_string(mesh.triangles.size()) +
                   " triangles cannot be made ready for rays" +
                   (error == RTC_ERROR_OUT_OF_MEMORY
                        ? ": memory is used up; use a smaller or coarser site"
                        : " (Embree error " + std::to_string(static_cast<int>(error)) + ")"));
  }
  state->materials = mesh.materials;
  return std::shared_ptr<const Scene>(new Scene(std::move(state)));
}

void Scene::State::cast_packet(std::span<const Ray> rays, float min_range, float max_range,
                               std::span<Hit> hits) const {
  RTCRayHit16 packet;
  alignas(64) int valid[kPacket];
  for (std::size_t k = 0; k < kPacket; ++k) {
    const bool cast = k < rays.size() && usable(rays[k]);
    const Ray ray = cast ? rays[k] : Ray{Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX()};
    valid[k] = cast ? -1 : 0;
    packet.ray.org_x[k] = ray.origin.x();
    packet.ray.org_y[k] = ray.origin.y();
    packet.ray.org_z[k] = ray.origin.z();
    packet.ray.dir_x[k] = ray.direction.x();
    packet.ray.dir_y[k] = ray.direction.y();
    packet.ray.dir_z[k] = ray.direction.z();
    // Without native packets of 16 Embree goes by the range and not by `valid`.
    packet.ray.tnear[k] = cast ? min_range : kInfinity;
    packet.ray.tfar[k] = cast ? max_range : -kInfinity;
    packet.ray.time[k] = 0.0f;
    packet.ray.mask[k] = ~0u;
    packet.ray.id[k] = 0;
    packet.ray.flags[k] = 0;
    packet.hit.geomID[k] = kNothing;
    packet.hit.instID[0][k] = kNothing;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  embree.intersect_16(valid, scene, &context, &packet);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (packet.hit.geomID[k] == kNothing) {
      hits[k] = Hit{};
      continue;
    }
    const Eigen::Vector3f normal(packet.hit.Ng_x[k], packet.hit.Ng_y[k], packet.hit.Ng_z[k]);
    const float length = std::sqrt(normal.squaredNorm() * rays[k].direction.squaredNorm());
    const float along = std::abs(normal.dot(rays[k].direction));
    hits[k].distance = packet.ray.tfar[k];
    hits[k].cos_incidence = length > 0.0f ? std::min(along / length, 1.0f) : 0.0f;
    hits[k].material = materials[packet.hit.primID[k]];
  }
}

void Scene::cast(std::span<const Ray> rays, float min_range, float max_range, std::span<Hit> hits) const {
  const std::size_t count = std::min(rays.size(), hits.size());
  if (!(min_range >= 0.0f && min_range < max_range)) {
    std::fill_n(hits.begin(), count, Hit{});
    return;
  }
  for (std::size_t begin = 0; begin < count; begin += kPacket) {
    const std::size_t size = std::min(kPacket, count - begin);
    state_->cast_packet(rays.subspan(begin, size), min_range, max_range, hits.subspan(begin, size));
  }
}

}  // namespace fleetmap::sim
