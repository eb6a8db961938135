#pragma once
// Embree's scene, and what every file that traces rays in it needs. The only file that includes Embree's headers; only files of
// this room may include it.

#include "meshing/vec3.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>

namespace alvor {

/// Makes the processor treat denormal numbers as zero, because they slow traversal down; restores the caller's mode at the end.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON); }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

/// An Embree device and a scene of it, released together.
class EmbreeScene {
 public:
  explicit EmbreeScene(RTCSceneFlags flags = RTC_SCENE_FLAG_NONE) : device_(rtcNewDevice(nullptr)) {
    if (!device_) throw std::runtime_error("Embree: no device");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Adds polygons of N corners each under the geometry id `id`.
  /// `filter` is called for the hits of rays on them, with `owner` as its geometryUserPtr, and for occlusions `occlusion_filter`.
  template <std::size_t N>
  void add(unsigned id, std::span<const std::array<float, 3>> vertices, std::span<const std::array<std::uint32_t, N>> polygons,
           RTCFilterFunctionN filter = nullptr, RTCFilterFunctionN occlusion_filter = nullptr, void* owner = nullptr) {
    if (polygons.empty()) return;
    const auto type = N == 4 ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE;
    RTCGeometry geometry = rtcNewGeometry(device_, type);
    copy_to(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices);
    copy_to(geometry, RTC_BUFFER_TYPE_INDEX, N == 4 ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, polygons);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, occlusion_filter);
    rtcSetGeometryUserData(geometry, owner);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, id);
    rtcReleaseGeometry(geometry);
  }
  void commit() {
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree: the scene could not be built");
  }
  RTCScene get() const { return scene_; }

 private:
  template <class T>
  void copy_to(RTCGeometry geometry, RTCBufferType buffer, RTCFormat format, std::span<const T> items) {
    void* to = rtcSetNewGeometryBuffer(geometry, buffer, 0, format, sizeof(T), items.size());
    if (!to) throw std::runtime_error("Embree: out of memory");
    std::memcpy(to, items.data(), items.size_bytes());
  }

  RTCDevice device_;
  RTCScene scene_;
};

inline std::array<float, 3> to_float(Vec3 p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Returns a context that lets Embree expect rays in unlike directions.
inline RTCIntersectContext incoherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

}  // namespace alvor
