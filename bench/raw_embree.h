#pragma once

// Plain Embree over the elements of a mesh, the baseline of the benchmarks.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// The front elements of a mesh as Embree quadrilaterals. `configuration` is the argument of
/// rtcNewDevice.
struct RawScene {
  RTCDevice device;
  RTCScene scene;

  explicit RawScene(const PatchMesh& mesh, const char* configuration = nullptr)
      : device(rtcNewDevice(configuration)), scene(rtcNewScene(device)) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertex_count()));
    for (int i = 0; i < mesh.vertex_count(); ++i) {
      for (int c = 0; c < 3; ++c) v[3 * i + c] = static_cast<float>(mesh.position(i)[c]);
    }
    int fronts = 0;
    for (int e = 0; e < mesh.element_count(); ++e) fronts += mesh.is_back[mesh.patch[e]] == 0;
    auto* index = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 16, fronts));
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.is_back[mesh.patch[e]] != 0) continue;
      const auto& c = mesh.corners[e];  // a repeated last corner makes an Embree triangle
      for (int k = 0; k < 4; ++k) *index++ = static_cast<unsigned>(c[k] < 0 ? c[2] : c[k]);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~RawScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  RawScene(const RawScene&) = delete;
  RawScene& operator=(const RawScene&) = delete;
};

}  // namespace lightwell
