#include "embree_functions.hpp"

#include <dlfcn.h>

namespace fleetmap::sim {
namespace {

/// Looks functions up and remembers the first that is missing.
class Symbols {
 public:
  explicit Symbols(void* library) : library_(library) {}

  template <typename Function>
  void find(const char* name, Function& function) {
    function = reinterpret_cast<Function>(::dlsym(library_, name));
    if (function == nullptr && missing_.empty()) missing_ = name;
  }
  const std::string& missing() const { return missing_; }

 private:
  void* library_;
  std::string missing_;
};

}  // namespace

Result<EmbreeFunctions> load_embree(const std::string& library) {
  void* const loaded = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) {
    const char* const reason = ::dlerror();
    return failure("the twin casts its rays with Embree, which cannot be loaded (" +
                   std::string(reason != nullptr ? reason : library) +
                   "); install the package fleetmap-twin or libembree3-3");
  }
  EmbreeFunctions functions;
  Symbols symbols(loaded);
  symbols.find("rtcNewDevice", functions.new_device);
  symbols.find("rtcReleaseDevice", functions.release_device);
  symbols.find("rtcGetDeviceError", functions.device_error);
  symbols.find("rtcNewGeometry", functions.new_geometry);
  symbols.find("rtcSetNewGeometryBuffer", functions.set_new_geometry_buffer);
  symbols.find("rtcCommitGeometry", functions.commit_geometry);
  symbols.find("rtcReleaseGeometry", functions.release_geometry);
  symbols.find("rtcNewScene", functions.new_scene);
  symbols.find("rtcReleaseScene", functions.release_scene);
  symbols.find("rtcSetSceneFlags", functions.set_scene_flags);
  symbols.find("rtcAttachGeometry", functions.attach_geometry);
  symbols.find("rtcCommitScene", functions.commit_scene);
  symbols.find("rtcIntersect16", functions.intersect_16);
  if (!symbols.missing().empty()) {
    return failure(library + " lacks " + symbols.missing() +
                   " and is not Embree 3; install the package libembree3-3");
  }
  return functions;
}

}  // namespace fleetmap::sim
