#pragma once
// The mesh of root patches made from a scene: vertices welded, neighbours across edges known. Hides OpenMesh from the other
// files.

#include "meshing/scene.h"
#include "meshing/welded_faces.h"

#include <array>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

namespace alvor {

/// Number of strata of a patch, each of which holds one origin of rays.
inline constexpr int strata_per_patch = 16;

/// A triangle or a planar convex quad: one face of the base mesh, and the root of a quadtree.
struct RootPatch {
  std::array<Vec3, 4> corners;          ///< counter-clockwise; metres; corners[3] unused for a triangle
  std::array<std::uint32_t, 4> vertex;  ///< the welded vertex at each corner
  int corner_count = 3;                 ///< 3 or 4
  std::uint32_t material = 0;
  InputFaces input;        ///< the face of the scene it came from, or the two triangles
  Vec3 normal;             ///< unit; points to the front
  double area = 0;         ///< m2
  int strata_along_u = 4;  ///< see PatchShape

  static constexpr std::uint32_t no_twin = ~0u;
  /// The root in the same place that faces the other way: the other side of a two-sided face, or another face with the same
  /// corners. Its corners are this root's in the order 0, n-1, ..., 1, so its (u, v) is our (v, u).
  std::uint32_t twin = no_twin;
  bool is_back = false;    ///< the added back side of a two-sided face
  bool is_behind = false;  ///< rays hit the twin's geometry, not this root's; or nobody's, if it is hidden
  bool is_hidden = false;  ///< see SceneObject

  /// Returns the position at (u, v). Quad: bilinear, with (0,0), (1,0), (1,1), (0,1) at corners 0..3. Triangle: corner0 + u
  /// (corner1 - corner0) + v (corner2 - corner0).
  Vec3 at(double u, double v) const;
};

/// The root patch across an edge of a root patch. Edge e runs from corner e to corner (e + 1) % corner_count.
struct Neighbour {
  std::uint32_t root = 0;
  int edge = 0;         ///< the neighbour's edge; it runs the opposite way
  bool smooth = false;  ///< same plane or a bend below 25 degrees; false at a crease
};

/// Counts of the changes that welding made to the scene, for warnings.
struct WeldReport {
  std::size_t welded_vertices = 0;
  std::size_t degenerate_faces = 0;    ///< left out: zero area or fewer than three distinct vertices
  std::size_t split_faces = 0;         ///< polygons cut into several roots: more than four corners, concave or not planar
  std::size_t non_manifold_faces = 0;  ///< kept without neighbours: an edge already had two faces
  DuplicateFaces duplicates;           ///< left out: in the same place as another face
};

/// Returns one sentence for each kind of problem that welding found. Faces are numbered as in the scene.
std::vector<std::string> warnings_of(const WeldReport& report);

/// Thrown when the stop token ended the construction of a mesh.
struct BuildStopped : std::exception {
  const char* what() const noexcept override { return "building the mesh was given up"; }
};

/// Thrown for more roots than patch ids can number (PatchId::most_roots).
struct TooManyRoots : std::runtime_error {
  explicit TooManyRoots(std::size_t roots);
};

struct BaseMeshOptions {
  /// Joins two triangles that an exporter cut from one quad. Applies only to scenes made of triangles alone.
  bool join_triangles = true;
  /// Each face becomes one root as it is: the faces are the roots of an earlier mesh without the added backs. They have three or
  /// four corners, and no two vertices are in one place.
  bool faces_are_roots = false;
  /// Checked during construction; the constructor throws BuildStopped when it is set.
  std::stop_token stop = {};
};

class BaseMesh;
/// The meshes of scenes that edits have added as objects, by SceneObject::from_scene. None is null.
using AddedMeshes = std::map<std::string, std::shared_ptr<const BaseMesh>>;

/// Immutable once built; safe to read from any thread.
class BaseMesh {
 public:
  /// Builds the mesh. Requires: !find_fault(scene). Vertices closer than 1e-9 of the extent of all faces are welded. Roots keep
  /// the order of the scene's faces; a quad joined from two triangles takes the place of the first. A two-sided face gives two
  /// roots: its back comes after all fronts. If all faces are degenerate, there are no roots.
  /// Throws TooManyRoots.
  explicit BaseMesh(const Scene& scene, const BaseMeshOptions& options = {});
  /// Returns this mesh with the materials, lights and medium of `scene`, and its objects where their `motion` puts them. Roots
  /// keep their numbers; those of objects that edits added (SceneObject::is_added()) come after them, object by object, in the
  /// order of the roots that they are copies of, of this mesh or of one of `added`; those of objects that do not move together
  /// are no neighbours, and no twins. Faces that come to lie in one place are not joined. Requires: !find_fault(scene); no edit
  /// has changed this mesh's scene; `scene` differs from it only in what edits change (edited_scene()); `added` has the meshes of
  /// all scenes that it was made with. Throws TooManyRoots.
  BaseMesh edited_as(const Scene& scene, const AddedMeshes& added = {}) const;
  /// Returns this mesh with the further roots of `other`, which come after all, hidden. Requires: `other` follows from the same
  /// scene by edits (edited_as()), and has at least as many roots.
  BaseMesh with_hidden_roots_of(const BaseMesh& other) const;

  /// Returns a mesh of some roots, in this order, with the objects and lights that are there, and faces numbered as
  /// PresentObjects does. Requires: none of the roots is hidden, or named twice.
  BaseMesh with_roots(std::span<const std::uint32_t> order) const;

  std::span<const RootPatch> roots() const { return roots_; }
  std::span<const Material> materials() const { return materials_; }
  const Material& material_of(std::uint32_t root) const { return materials_[roots_[root].material]; }
  /// Returns whether light that meets the other side of a root leaves its front, too. Then its twin is its other side.
  bool is_translucent(std::uint32_t root) const { return material_of(root).is_translucent(); }
  bool has_textures() const { return !texture_points_.empty(); }
  bool has_colours() const { return !corner_colours_.empty(); }
  /// Returns whether the reflectance of any root changes over it.
  bool has_varying_reflectance() const { return has_textures() || has_colours(); }
  /// Returns the colour at each corner of a root. Requires: has_colours().
  const std::array<RgbF, 4>& corner_colours(std::uint32_t root) const { return corner_colours_[root]; }
  /// Returns where on its material's texture each corner of a root lies. Requires: the material has a texture.
  const std::array<TexturePoint, 4>& texture_points(std::uint32_t root) const { return texture_points_[root]; }
  std::optional<Neighbour> across(std::uint32_t root, int edge) const;
  const Rgb& absorption() const { return absorption_; }      ///< absorption coefficient of the medium, see Scene
  std::span<const Light> lights() const { return lights_; }  ///< those that are not faces
  std::span<const SceneObject> objects() const { return objects_; }
  UpAxis up() const { return up_; }
  Quantity quantity() const { return quantity_; }
  const WeldReport& weld_report() const { return report_; }

  Vec3 centre() const { return centre_; }    ///< centre of the bounding box of the roots, metres
  double extent() const { return extent_; }  ///< longest side of the bounding box, metres; > 0 unless there are no roots

 private:
  void find_bounds();
  bool counts_for_bounds(const RootPatch& root) const;
  bool is_within_frame() const;
  void add_root(const Scene& scene, const WeldedFace& face, const std::array<std::uint32_t, 4>& piece);
  void add_roots(const Scene& scene, const WeldedFace& face);
  void find_corner_values(const Scene& scene, std::span<const std::uint32_t> welded, const std::stop_token& stop);
  void pair_back_to_back(bool corners_stay);
  void find_neighbours(const std::stop_token& stop);
  void add_backs();
  void separate_objects(bool are_to_move);
  void append_objects(std::span<const SceneObject> objects, const AddedMeshes& added);
  void append_copy(std::span<const SceneObject> objects, const SceneObject& copy,
                   std::span<const std::vector<std::uint32_t>> roots_of, std::uint32_t& next_vertex);
  void append_mesh(const BaseMesh& added, std::uint32_t first_face, std::uint32_t& next_vertex);
  void append_root(const BaseMesh& from, std::uint32_t root);
  std::uint32_t first_free_vertex() const;

  std::vector<RootPatch> roots_;
  std::vector<std::array<TexturePoint, 4>> texture_points_;  // by root; none if no root has a texture
  std::vector<std::array<RgbF, 4>> corner_colours_;          // by root; none if no face has colours
  std::vector<Material> materials_;
  Rgb absorption_;
  std::vector<Light> lights_;
  std::vector<SceneObject> objects_;
  UpAxis up_;
  Quantity quantity_;
  std::vector<std::array<std::optional<Neighbour>, 4>> neighbours_;
  WeldReport report_;
  Vec3 centre_;
  double extent_ = 0;
};

}  // namespace alvor
