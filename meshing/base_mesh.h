#pragma once
// The welded mesh of root patches that a scene becomes, with neighbours known across edges. OpenMesh lives behind it.

#include "meshing/scene.h"
#include "meshing/welded_faces.h"

#include <array>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace alvor {

/// A triangle or a planar convex quad, one per base-mesh face: the root of a quadtree.
struct RootPatch {
  std::array<Vec3, 4> corners;          ///< counter-clockwise; metres; corners[3] unused for a triangle
  std::array<std::uint32_t, 4> vertex;  ///< welded vertex of each corner
  int corner_count = 3;                 ///< 3 or 4
  std::uint32_t material = 0;
  InputFaces input;  ///< the face of the scene, or the two triangles of it, that it came from
  Vec3 normal;       ///< unit, to the front
  double area = 0;   ///< m2

  static constexpr std::uint32_t no_twin = ~0u;
  /// The other side of a two-sided face, or another face with the same corners the other way round. Its corners are ours in the
  /// order 0, n-1, ..., 1, so (u, v) is (v, u).
  std::uint32_t twin = no_twin;
  bool is_back = false;    ///< the twin that looks against the face's orientation
  bool is_behind = false;  ///< rays meet its twin in its place

  /// Position at (u, v): bilinear for a quad with (0,0), (1,0), (1,1), (0,1) at corners 0..3; for a triangle
  /// corner0 + u (corner1 - corner0) + v (corner2 - corner0).
  Vec3 at(double u, double v) const;
};

/// What lies across an edge of a root patch. Edge e runs from corner e to corner (e + 1) % corner_count.
struct Neighbour {
  std::uint32_t root = 0;
  int edge = 0;         ///< runs the other way: its start is our end
  bool smooth = false;  ///< same plane or gently curved (below 25 degrees); false is a crease
};

/// What welding changed, for warnings.
struct WeldReport {
  std::size_t welded_vertices = 0;
  std::size_t degenerate_faces = 0;    ///< dropped: zero area or fewer than three distinct vertices
  std::size_t split_faces = 0;         ///< polygons cut into several roots: more than four corners, concave or not planar
  std::size_t non_manifold_faces = 0;  ///< joined without neighbours, because an edge already had two faces
  DuplicateFaces duplicates;           ///< dropped: in the place of another
};

/// One sentence each about what welding found odd, faces numbered as in the scene.
std::vector<std::string> warnings_of(const WeldReport& report);

/// Building a mesh was given up because its stop token asked for it.
struct BuildStopped : std::exception {
  const char* what() const noexcept override { return "building the mesh was given up"; }
};

struct BaseMeshOptions {
  /// Makes one root of two triangles that an exporter cut from a quad, in scenes of triangles only.
  bool join_triangles = true;
  /// Asked now and then; the constructor then throws BuildStopped.
  std::stop_token stop = {};
};

/// Immutable once built; safe to read from any thread.
class BaseMesh {
 public:
  /// Requires: !find_fault(scene). Vertices closer than 1e-9 of the extent of all faces are welded. The mesh may have no roots,
  /// if all faces are degenerate. Roots keep the order of the faces, a quad made of two triangles that of the first; a two-sided
  /// face becomes two roots, the backs after all fronts.
  explicit BaseMesh(const Scene& scene, const BaseMeshOptions& options = {});

  std::span<const RootPatch> roots() const { return roots_; }
  std::span<const Material> materials() const { return materials_; }
  const Material& material_of(std::uint32_t root) const { return materials_[roots_[root].material]; }
  std::optional<Neighbour> across(std::uint32_t root, int edge) const;
  const Rgb& absorption() const { return absorption_; }  ///< of the medium, see Scene
  UpAxis up() const { return up_; }
  const WeldReport& weld_report() const { return report_; }

  Vec3 centre() const { return centre_; }    ///< of the bounding box of the roots, metres
  double extent() const { return extent_; }  ///< longest side of that box, metres; > 0 unless there are no roots

 private:
  void add_roots(const Scene& scene, const WeldedFace& face);
  void pair_back_to_back();
  void find_neighbours(const std::stop_token& stop);
  void add_backs();

  std::vector<RootPatch> roots_;
  std::vector<Material> materials_;
  Rgb absorption_;
  UpAxis up_;
  std::vector<std::array<std::optional<Neighbour>, 4>> neighbours_;
  WeldReport report_;
  Vec3 centre_;
  double extent_ = 0;
};

}  // namespace alvor
