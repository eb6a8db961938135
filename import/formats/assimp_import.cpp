#include "import/formats/assimp_import.h"

#include "import/base/import_error.h"
#include "import/base/scene_format.h"
#include "import/formats/colour_images.h"
#include "import/formats/emission_textures.h"
#include "import/formats/placement.h"
#include "import/formats/see_through.h"
#include "import/formats/texture_colour.h"
#include "import/formats/unsupported.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <optional>
#include <span>
#include <sstream>

namespace alvor {

namespace {

Vec3 vec3_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

Placement placement_of(const aiMatrix4x4& m) {
  return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

/// Returns the bytes of a texture embedded in encoded form. Returns nothing for raw texels, which only games use.
std::span<const unsigned char> bytes_of_embedded(const aiTexture& texture) {
  if (texture.mHeight != 0) return {};
  return {reinterpret_cast<const unsigned char*>(texture.pcData), texture.mWidth};
}

Wrap wrap_of(int mode) {
  return mode == aiTextureMapMode_Mirror ? Wrap::mirror : mode == aiTextureMapMode_Clamp ? Wrap::clamp : Wrap::repeat;
}

/// Returns a colour that files hold as sRGB of 8 bits.
RgbF linear_of(const aiColor4D& colour) {
  const auto band = [](float x) {
    return static_cast<float>(linear_of_srgb_byte(static_cast<std::uint8_t>(x >= 0 ? std::min(255 * x + 0.5F, 255.0F) : 0)));
  };
  return {band(colour.r), band(colour.g), band(colour.b)};
}

/// Returns whether a material moves or turns its texture of this type, which no two formats do alike.
bool moves_texture(const aiMaterial& source, aiTextureType type) {
  aiUVTransform transform;
  if (source.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) != AI_SUCCESS) return false;
  return transform.mTranslation != aiVector2D(0, 0) || transform.mScaling != aiVector2D(1, 1) || transform.mRotation != 0;
}

/// The up axis and unit of a format's coordinates: given by the file, or usual for programs that write the format.
struct Convention {
  UpAxis up = UpAxis::y;
  double metres_per_unit = 1;
  bool shows_vertex_colours = false;  ///< else they are data that programs keep beside the surface
};

Convention convention_of(const aiScene& source, const std::string& extension) {
  Convention convention;
  // Collada files state their unit and up axis, and Assimp converts the scene to y-up metres.
  if (extension == ".stl" || extension == ".3ds" || extension == ".ply") convention.up = UpAxis::z;
  convention.shows_vertex_colours = extension == ".ply" || extension == ".dae";
  if (extension == ".fbx" && source.mMetaData) {
    int up = 1;
    float centimetres = 1;  // the type in which Assimp stores it; Get() refuses another
    source.mMetaData->Get("UpAxis", up);
    source.mMetaData->Get("UnitScaleFactor", centimetres);
    convention.up = up == 2 ? UpAxis::z : UpAxis::y;
    if (centimetres > 0) convention.metres_per_unit = double{centimetres} / 100;
  }
  return convention;
}

/// Reads one file's materials and meshes into a scene.
class AssimpReader {
 public:
  AssimpReader(const aiScene& source, SceneFiles& files, const Convention& convention)
      : source_(source), files_(files), convention_(convention) {}

  SceneFile read() {
    for (const aiMaterial* material : std::span(source_.mMaterials, source_.mNumMaterials)) add_material(*material);
    if (source_.mRootNode) add_tree(*source_.mRootNode);
    emission_textures_.cut(file_.scene, file_.warnings);
    Unsupported unsupported;
    count_lights(unsupported);
    count_materials(unsupported);
    images_.append_warnings(file_.warnings);
    bare_materials_.append_warnings(file_.scene, file_.warnings);
    unsupported.append_warnings(file_.warnings);
    file_.scene.up = convention_.up;
    return std::move(file_);
  }

 private:
  void add_material(const aiMaterial& source) {
    const std::string given_name = source.GetName().C_Str();
    // For files without materials Assimp makes one with this name or none, in a colour of its own choice.
    const bool made_up = given_name.empty() || given_name == AI_DEFAULT_MATERIAL_NAME;
    const std::string name = made_up ? "default" : given_name;
    int two_sided = 0;
    source.Get(AI_MATKEY_TWOSIDED, two_sided);
    const Rgb grey = default_reflectance;
    // Formats disagree on whether 0 or 1 is opaque, so 0 counts as opaque: nobody sends what cannot be seen.
    float opacity = 1;
    source.Get(AI_MATKEY_OPACITY, opacity);
    const bool has_holes = opacity > 0 && opacity < 1;
    Material material{name, {}, grey, two_sided != 0};
    if (!made_up && (has_holes || !cover(source, material)))
      material.reflectance = colour(source, name, AI_MATKEY_COLOR_DIFFUSE, aiTextureType_DIFFUSE, grey);
    emit(source, material);
    if (has_holes) leave(material, opacity);
    file_.scene.materials.push_back(std::move(material));
    is_made_up_.push_back(made_up);
  }

  /// Sets the emission of a material, in the mean over its texture.
  void emit(const aiMaterial& source, Material& material) {
    aiColor3D found;
    if (source.Get(AI_MATKEY_COLOR_EMISSIVE, found) == AI_SUCCESS) material.emission = {found.r, found.g, found.b};
    material.emission = emission_of_radiance(material.emission);
    aiString texture;
    if (material.emission.is_zero() || source.GetTexture(aiTextureType_EMISSIVE, 0, &texture) != AI_SUCCESS) return;
    const auto mean = mean_texel(bytes_of(texture));
    const std::string place = "material '" + material.name + "': texture '" + texture.C_Str() + "'";
    if (!mean) file_.warnings.push_back(place + " cannot be read and is left out");
    if (mean) material.emission = mean->colour * material.emission;
    const auto image = mean ? images_.decoded(texture.C_Str(), bytes_of(texture)) : nullptr;
    if (!image || has_equal_texels(*image)) return;
    if (moves_texture(source, aiTextureType_EMISSIVE)) {
      file_.warnings.push_back(place + " counts by its mean colour");
      return;
    }
    emission_textures_.set(static_cast<std::uint32_t>(file_.scene.materials.size()), image,
                           wrap_of(mapping_mode(source, aiTextureType_EMISSIVE, true)),
                           wrap_of(mapping_mode(source, aiTextureType_EMISSIVE, false)));
  }

  static int mapping_mode(const aiMaterial& source, aiTextureType type, bool across) {
    int mode = aiTextureMapMode_Wrap;
    if (across) source.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), mode);
    else source.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), mode);
    return mode;
  }

  /// Gives a material the texture of its diffuse colour. Returns false if it has none that counts by place.
  bool cover(const aiMaterial& source, Material& material) {
    aiString texture;
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &texture) != AI_SUCCESS || moves_texture(source, aiTextureType_DIFFUSE))
      return false;
    const auto image = images_.decoded(texture.C_Str(), bytes_of(texture));
    if (!image) return false;
    aiColor3D found;
    const Rgb factor =
        source.Get(AI_MATKEY_COLOR_DIFFUSE, found) == AI_SUCCESS ? Rgb{found.r, found.g, found.b} : default_reflectance;
    images_.cover(material, factor, image, wrap_of(mapping_mode(source, aiTextureType_DIFFUSE, true)),
                  wrap_of(mapping_mode(source, aiTextureType_DIFFUSE, false)));
    return true;
  }

  Rgb colour(const aiMaterial& source, const std::string& name, const char* key, unsigned type, unsigned index, aiTextureType map,
             const Rgb& fallback) {
    aiColor3D found;
    const Rgb factor = source.Get(key, type, index, found) == AI_SUCCESS ? Rgb{found.r, found.g, found.b} : fallback;
    aiString texture;
    if (factor.is_zero() || source.GetTexture(map, 0, &texture) != AI_SUCCESS) return factor;
    const std::string place = "material '" + name + "': texture '" + texture.C_Str() + "'";
    return textured(factor, mean_texel(bytes_of(texture)), place, file_.warnings);
  }

  std::span<const unsigned char> bytes_of(const aiString& texture) const {
    if (const aiTexture* embedded = source_.GetEmbeddedTexture(texture.C_Str())) return bytes_of_embedded(*embedded);
    const std::string* const found = files_.find(texture.C_Str());
    if (!found) return {};
    return {reinterpret_cast<const unsigned char*>(found->data()), found->size()};
  }

  /// Walks the tree depth first without recursion: a file could make it deep enough to overflow the stack.
  void add_tree(const aiNode& root) {
    struct Pending {
      const aiNode* node;
      Placement parent_placement;
      std::optional<std::uint32_t> parent;  // its object
    };
    const double unit = convention_.metres_per_unit;
    std::vector<Pending> stack{{&root, {{unit, 0, 0}, {0, unit, 0}, {0, 0, unit}, {}}, std::nullopt}};
    while (!stack.empty()) {
      const Pending next = stack.back();
      stack.pop_back();
      const Placement placement = next.parent_placement * placement_of(next.node->mTransformation);
      // Assimp makes a root of its own above all nodes of the file.
      const bool is_made_up = next.node == &root && root.mNumMeshes == 0;
      std::optional<std::uint32_t> object;
      if (!is_made_up) object = add_object(file_.scene, next.node->mName.C_Str(), next.parent, placement);
      for (const unsigned mesh : std::span(next.node->mMeshes, next.node->mNumMeshes)) add_mesh(mesh, placement);
      if (object) take_new_faces(file_.scene, *object);
      for (unsigned c = next.node->mNumChildren; c-- > 0;) stack.push_back({next.node->mChildren[c], placement, object});
    }
  }

  void add_mesh(unsigned index, const Placement& placement) {
    if (index >= source_.mNumMeshes) throw ImportError("mesh " + std::to_string(index), "is not in the file");
    const aiMesh& mesh = *source_.mMeshes[index];
    std::vector<Vec3> vertices;
    for (const aiVector3D& vertex : std::span(mesh.mVertices, mesh.mNumVertices)) vertices.push_back(vec3_of(vertex));
    const std::uint32_t first = add_placed_vertices(file_.scene, vertices, placement);
    // Colours are all that a file without materials says of its surfaces.
    if (const std::uint32_t material = material_of(mesh);
        colours_of(mesh) && material < is_made_up_.size() && is_made_up_[material])
      file_.scene.materials[material].reflectance = reflectance_of_texel(255) * Rgb{1, 1, 1};
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) add_face(face, mesh, first, placement);
  }

  void add_face(const aiFace& face, const aiMesh& mesh, std::uint32_t first_vertex, const Placement& placement) {
    if (face.mNumIndices < 3) return;
    std::vector<std::uint32_t> polygon;
    std::vector<TexturePoint> points;
    std::vector<RgbF> colours;
    std::vector<TexturePoint> light_points;
    std::uint32_t material = material_of(mesh);
    const bool has_texture = file_.scene.materials[material].texture.has_value();
    const aiVector3D* const coordinates = has_texture ? texture_coordinates_of(mesh, aiTextureType_DIFFUSE) : nullptr;
    const aiVector3D* const on_light =
        emission_textures_.has(material) ? texture_coordinates_of(mesh, aiTextureType_EMISSIVE) : nullptr;
    const aiColor4D* const colour = colours_of(mesh);
    for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
      if (index >= mesh.mNumVertices)
        throw ImportError("face " + std::to_string(file_.scene.faces.size()),
                          "vertex index " + std::to_string(index) + " is out of range, there are " +
                              std::to_string(mesh.mNumVertices) + " vertices");
      polygon.push_back(first_vertex + index);
      // Assimp counts t from the lower edge of images.
      if (coordinates) points.push_back(texture_point(coordinates[index].x, 1 - coordinates[index].y));
      if (on_light) light_points.push_back(texture_point(on_light[index].x, 1 - on_light[index].y));
      if (colour) colours.push_back(linear_of(colour[index]));
    }
    if (!coordinates && has_texture) material = bare_materials_.of(file_.scene, material);
    add_placed_face(file_.scene, polygon, material, placement, points, colours);
    if (on_light) emission_textures_.place(file_.scene, light_points, placement);
  }

  /// Returns the colours of a mesh's vertices; null if they are none of its surface.
  const aiColor4D* colours_of(const aiMesh& mesh) const { return convention_.shows_vertex_colours ? mesh.mColors[0] : nullptr; }

  /// Returns the coordinates of a mesh's vertices on its material's texture of this type; null if there are none.
  const aiVector3D* texture_coordinates_of(const aiMesh& mesh, aiTextureType type) {
    int set = 0;
    source_.mMaterials[material_of(mesh)]->Get(AI_MATKEY_UVWSRC(type, 0), set);
    return set >= 0 && set < AI_MAX_NUMBER_OF_TEXTURECOORDS ? mesh.mTextureCoords[set] : nullptr;
  }

  std::uint32_t material_of(const aiMesh& mesh) {
    if (mesh.mMaterialIndex < source_.mNumMaterials) return mesh.mMaterialIndex;
    if (!default_material_) default_material_ = add_default_material(file_.scene);
    return *default_material_;
  }

  void count_lights(Unsupported& unsupported) const {
    for (const aiLight* light : std::span(source_.mLights, source_.mNumLights)) switch (light->mType) {
        case aiLightSource_POINT: ++unsupported.point_lights; break;
        case aiLightSource_SPOT: ++unsupported.spot_lights; break;
        case aiLightSource_DIRECTIONAL: ++unsupported.directional_lights; break;
        case aiLightSource_AREA: ++unsupported.area_lights; break;
        default: ++unsupported.other_lights;
      }
  }

  void count_materials(Unsupported& unsupported) const {
    const std::vector<bool> used = used_materials(file_.scene);
    for (unsigned m = 0; m < source_.mNumMaterials; ++m) {
      if (!used[m]) continue;
      float metallic = 0;
      source_.mMaterials[m]->Get(AI_MATKEY_METALLIC_FACTOR, metallic);
      unsupported.metals += metallic > 0.5F;
    }
  }

  const aiScene& source_;
  SceneFiles& files_;
  Convention convention_;
  ColourImages images_;
  EmissionTextures emission_textures_;
  BareMaterials bare_materials_;
  SceneFile file_;
  std::vector<bool> is_made_up_;  // by material: Assimp made it for a file without materials
  std::optional<std::uint32_t> default_material_;
};

/// Refuses PLY headers that Assimp's reader cannot handle: it waits for ever for a missing end, and allocates as many elements as
/// the header promises.
void check_ply_header(std::istream& stream, std::uintmax_t file_size) {
  std::string word, name;
  while (stream >> word && word != "end_header") {
    if (word == "comment" || word == "obj_info") std::getline(stream, word);
    std::uintmax_t count = 0;
    if (word == "element" && stream >> name >> count && count > file_size)
      throw ImportError("element " + name, "the file is too short for " + std::to_string(count) + " of them");
  }
  if (word != "end_header") throw ImportError("file", "its header has no end_header");
}

void refuse_what_assimp_cannot_survive(std::istream& stream, std::uintmax_t file_size) {
  std::string first;
  std::getline(stream, first);
  first.resize(std::min<std::size_t>(first.size(), 3));  // Assimp looks only at these, in either case
  std::ranges::transform(first, first.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (first == "ply") check_ply_header(stream, file_size);
}

/// No post-processing: every step of Assimp that joins, sorts or triangulates loses the file's faces or their order.
constexpr unsigned as_it_is = 0;

/// Gives Assimp the files of a scene, and no others.
class MemoryFiles : public Assimp::IOSystem {
 public:
  explicit MemoryFiles(const SceneFiles& files) : files_(files) {}

  bool Exists(const char* name) const override { return find(name) != nullptr; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    const std::string* const bytes = mode[0] == 'r' ? find(name) : nullptr;
    if (!bytes) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  /// Formats look for files that need not exist. So what is not found here does not count as missing.
  const std::string* find(const char* name) const {
    const std::string plain = plain_name(name);
    if (plain == files_.scene()) return &files_.bytes();
    const auto found = files_.beside().find(plain);
    return found == files_.beside().end() ? nullptr : &found->second;
  }

  const SceneFiles& files_;
};

}  // namespace

SceneFile import_by_assimp(SceneFiles& files) {
  std::istringstream stream(files.bytes());
  refuse_what_assimp_cannot_survive(stream, files.bytes().size());
  Assimp::Importer importer;
  importer.SetIOHandler(new MemoryFiles(files));                          // the importer deletes it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);  // else each pivot is a node of its own
  const aiScene* const source = importer.ReadFile(files.scene(), as_it_is);
  if (!source) throw ImportError("file", importer.GetErrorString());
  return AssimpReader(*source, files, convention_of(*source, lower_case_extension(files.scene()))).read();
}

}  // namespace alvor
