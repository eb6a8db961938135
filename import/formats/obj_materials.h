#pragma once
// The materials of OBJ files: their libraries (MTL) and textures.

#include "import/base/scene_files.h"
#include "import/formats/colour_images.h"
#include "import/formats/emission_textures.h"
#include "import/formats/tiny_obj.h"

#include <functional>
#include <istream>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Reads MTL files; checks their lines before tinyobjloader parses them. Borrows the files.
class MaterialLibrary : public tinyobj::MaterialReader {
 public:
  explicit MaterialLibrary(SceneFiles& files) : files_(files) {}

  /// Called by tinyobjloader for each file named by a `mtllib` line.
  bool operator()(const std::string& file, std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* index,
                  std::string*, std::string* error) override;

  const tinyobj::material_t* find(const std::string& name) const;
  const std::set<std::string>& missing() const { return missing_; }

 private:
  void load(std::istream& stream, const std::string& file, std::vector<tinyobj::material_t>* materials,
            std::map<std::string, int>* index, std::string* error);

  SceneFiles& files_;
  std::map<std::string, tinyobj::material_t> by_name_;
  std::set<std::string> missing_;
};

/// Reads the materials that the faces of a scene name. Borrows all.
class ObjMaterials {
 public:
  ObjMaterials(Scene& scene, std::vector<std::string>& warnings, const MaterialLibrary& library, SceneFiles& files)
      : scene_(scene), warnings_(warnings), library_(library), files_(files) {}

  /// Fills in the colours and textures of the materials, which have only names.
  void fill();
  /// Moves the texture points of the scene as the options -o and -s of map_Kd say; of map_d where there is no map_Kd. Requires:
  /// all corners have one, or none.
  void place_textures();
  /// Notes where the faces with emissive textures lie on these. `points_of` returns the texture points of a face's corners, or
  /// none if they are not known. Requires: all faces have the material that they have in the file.
  void place_emission(const std::function<std::vector<TexturePoint>(const Face&)>& points_of);
  /// Cuts the faces whose emission changes from place to place.
  void cut_emission() { emission_textures_.cut(scene_, warnings_); }

 private:
  void fill(Material& material, const tinyobj::material_t& found);
  void emit(Material& material, const tinyobj::material_t& found);
  const std::string* bytes_of(const std::string& texture);
  Rgb under_texture(const Rgb& factor, const std::string& texture, const Material& material);
  double cover(const tinyobj::material_t& found, Material& material);
  std::shared_ptr<const ColourImage> cut_out(const tinyobj::material_t& found);
  double mean_opacity(const tinyobj::material_t& found, const Material& material);

  Scene& scene_;
  std::vector<std::string>& warnings_;
  const MaterialLibrary& library_;
  SceneFiles& files_;
  ColourImages images_;
  EmissionTextures emission_textures_;
};

}  // namespace alvor
