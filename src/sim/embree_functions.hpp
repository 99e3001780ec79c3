#pragma once

#include <embree3/rtcore.h>

#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// The functions of Embree 3 that cast rays. They are looked up when the first scene is made, so that the
/// program starts without the library on robots, which simulate nothing.
struct EmbreeFunctions {
  decltype(&rtcNewDevice) new_device = nullptr;
  decltype(&rtcReleaseDevice) release_device = nullptr;
  decltype(&rtcGetDeviceError) device_error = nullptr;
  decltype(&rtcNewGeometry) new_geometry = nullptr;
  decltype(&rtcSetNewGeometryBuffer) set_new_geometry_buffer = nullptr;
  decltype(&rtcCommitGeometry) commit_geometry = nullptr;
  decltype(&rtcReleaseGeometry) release_geometry = nullptr;
  decltype(&rtcNewScene) new_scene = nullptr;
  decltype(&rtcReleaseScene) release_scene = nullptr;
  decltype(&rtcSetSceneFlags) set_scene_flags = nullptr;
  decltype(&rtcAttachGeometry) attach_geometry = nullptr;
  decltype(&rtcCommitScene) commit_scene = nullptr;
  decltype(&rtcIntersect16) intersect_16 = nullptr;
};

/// Embree's library as Debian 12 names it.
inline constexpr const char* kEmbreeLibrary = "libembree3.so.3";

/// Loads `library`, which stays loaded until the program ends. Fails with the package that brings it, or with
/// the function that it lacks.
Result<EmbreeFunctions> load_embree(const std::string& library = kEmbreeLibrary);

}  // namespace fleetmap::sim
