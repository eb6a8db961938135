#pragma once
// The luminaires of a scene, as a schedule lists them.

#include "client/report/rooms.h"
#include "meshing/display_mesh.h"

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Lights that differ in their place and aim only.
struct LuminaireType {
  std::string name;  ///< of the first one
  LightKind kind = LightKind::luminaire;
  std::size_t count = 0;
  double lumens = 0;            ///< of one, lm, or W of light in a radiometric scene
  double electrical_watts = 0;  ///< of one; 0: not known
};

/// A material of a scene's surfaces.
struct SurfaceMaterial {
  std::string name;
  double reflectance = 0;  ///< luminous in photometric scenes, else the mean of the bands; without images
  double area = 0;         ///< m2, both sides of two-sided faces
};
/// Returns the materials of all faces, the largest area first.
std::vector<SurfaceMaterial> surface_materials(const DisplayMesh& mesh);

/// Returns the types of lights that are not distant, in the order in which they first come.
std::vector<LuminaireType> luminaire_types(const DisplayMesh& mesh);

/// The light of surfaces that emit, by material.
struct EmittingMaterial {
  std::string name;
  double area = 0;    ///< m2
  double lumens = 0;  ///< lm, or W in a radiometric scene
};

/// Returns the materials that emit and are on some surface. Nothing if the mesh does not know its faces.
std::vector<EmittingMaterial> emitting_materials(const DisplayMesh& mesh);

/// The electrical power of the luminaires in a room; see room_at().
struct RoomPower {
  std::size_t luminaires = 0;
  double watts = 0;         ///< of those whose power is known
  bool is_complete = true;  ///< the power of all is known
};

/// Returns the lights in each room, of those that are not distant. They are the mesh's.
std::vector<std::vector<const Light*>> lights_in(std::span<const Room> rooms, const DisplayMesh& mesh);

RoomPower power_of(std::span<const Light* const> lights);

}  // namespace alvor
