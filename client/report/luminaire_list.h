#pragma once
// The luminaires of a scene, as a schedule lists them.

#include "client/report/rooms.h"
#include "meshing/display_mesh.h"

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

/// The electrical power of the luminaires in a room. A luminaire is in the room over whose floor its middle is.
struct RoomPower {
  std::size_t luminaires = 0;
  double watts = 0;         ///< of those whose power is known
  bool is_complete = true;  ///< the power of all is known
};

RoomPower power_in(const Room& room, const DisplayMesh& mesh);

/// Returns whether a light is in a room.
bool is_in(const Room& room, const Light& light);

}  // namespace alvor
