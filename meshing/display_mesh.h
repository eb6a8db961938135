#pragma once
// Builds the triangle mesh that is drawn and written to files: no cracks, values at vertices.

#include "meshing/base_mesh.h"
#include "solution/leaf_value.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// A run of triangles that were drawn on one face of the scene, or on two triangles joined into a quad. Faces count as if objects
/// that edits have hidden had never been in the scene (PresentObjects).
struct FaceTriangles {
  InputFaces faces;
  std::uint32_t material = 0;  ///< of the scene
  std::uint32_t count = 0;     ///< of triangles

  friend bool operator==(const FaceTriangles&, const FaceTriangles&) = default;
};

/// Appends a run; it continues the last one if both are of the same faces and material.
void append_run(std::vector<FaceTriangles>& runs, const FaceTriangles& run);

/// A triangle mesh with irradiance and radiosity per vertex. Each triangle is (centre of a leaf, corner, next corner),
/// counter-clockwise, so the side opposite its first vertex lies on the leaf's outline. Triangles share a vertex only where the
/// surface is smooth and has one material, texture point and colour.
struct DisplayMesh {
  std::vector<Vec3> positions;    ///< metres
  std::vector<Vec3> normals;      ///< unit; point to the front
  std::vector<RgbF> irradiance;   ///< H, W/m2
  std::vector<RgbF> radiosity;    ///< B = E + rho H + transmitted, W/m2; rho: the material's mean, times the colour
  std::vector<RgbF> transmitted;  ///< tau H of the other side, W/m2; none if no material is translucent
  std::vector<float> errors;  ///< told error of H: one standard deviation of the mean of the bands, W/m2; none if none were told
  std::vector<TexturePoint> texture_points;  ///< of the vertices; none if no material has a texture
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<FaceTriangles> faces;  ///< whence the triangles come, in their order; none if that is not known
  UpAxis up = UpAxis::y;
  Quantity quantity = Quantity::radiometric;  ///< photometric: lx instead of W/m2
  std::vector<Light> lights;                  ///< of the scene, those that are not faces; none that is hidden
  std::vector<Material> materials;            ///< of the scene
  std::vector<SceneObject> objects;           ///< of the scene, those that are not hidden
};

/// Returns the told error at a point of a triangle, (1 - u - v) of its first vertex, u of its second and v of its third; squares
/// are interpolated. Requires: !mesh.errors.empty().
double error_at(const DisplayMesh& mesh, std::uint32_t triangle, double u, double v);

/// Returns the material of each triangle that light goes straight through, null for the others; nothing if there are none, or if
/// the mesh does not know its faces. The mesh must outlive it.
std::vector<const Material*> panes_of(const DisplayMesh& mesh);
/// Returns the material of each triangle that has a texture, as panes_of() does.
std::vector<const Material*> textured_of(const DisplayMesh& mesh);

/// Triangulates `leaves` (sorted by id, together covering every root of `mesh`), with a vertex at every hanging corner so that no
/// crack opens. A corner's irradiance is the mean of linear extrapolations from its smooth neighbours, clamped to the range of
/// their values. Leaves across a crease and leaves of exactly zero irradiance take no part. The two sides of a two-sided face are
/// drawn 4e-5 of the extent apart, so that a viewer can tell which is in front. `errors` are the told errors of the leaves, or
/// none; a corner's is the RMS of those around it.
DisplayMesh build_display_mesh(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors = {});

}  // namespace alvor
