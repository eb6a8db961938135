#include "import/formats/obj_materials.h"

#include "import/formats/obj_lines.h"
#include "import/formats/see_through.h"
#include "import/formats/texture_colour.h"
#include "import/formats/unsupported.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace alvor {

namespace {

/// Beside Kd and Ke of MTL there is Td, which is Alvor's own: the diffuse transmittance.
constexpr std::array<std::string_view, 3> colour_lines{"Kd", "Ke", "Td"};
Rgb rgb_of(const tinyobj::real_t (&bands)[3]) { return {bands[0], bands[1], bands[2]}; }

/// Returns the names of the materials in an MTL text that have a line with this key.
std::set<std::string> materials_with(std::string_view key, const std::string& text) {
  std::set<std::string> names;
  std::istringstream lines(text);
  std::string line, word, material;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    if (!(words >> word)) continue;
    if (word == "newmtl") std::getline(words >> std::ws, material);
    else if (word == key) names.insert(material);
  }
  return names;
}

/// Sets the colour factor to 1 where a material has a texture but no colour, as Blender writes it.
void fill_factors(std::span<tinyobj::material_t> materials, const std::string& text) {
  const auto with_diffuse = materials_with("Kd", text), with_emission = materials_with("Ke", text);
  for (tinyobj::material_t& material : materials) {
    if (!material.diffuse_texname.empty() && !with_diffuse.contains(material.name)) std::ranges::fill(material.diffuse, 1.0);
    if (!material.emissive_texname.empty() && !with_emission.contains(material.name)) std::ranges::fill(material.emission, 1.0);
  }
}

std::string with_slashes(std::string path) {
  std::ranges::replace(path, '\\', '/');
  return path;
}

std::string place_of(const std::string& texture, const Material& material) {
  return "material '" + material.name + "': texture '" + with_slashes(texture) + "'";
}

/// Returns the three numbers of a Td line, which clean_lines() has checked; 0 if there is none.
Rgb diffuse_transmittance_of(const tinyobj::material_t& material) {
  Rgb bands;
  if (const auto found = material.unknown_parameter.find("Td"); found != material.unknown_parameter.end())
    std::istringstream(found->second) >> bands.r >> bands.g >> bands.b;
  return bands;
}

std::span<const unsigned char> bytes_in(const std::string* file) {
  if (!file) return {};
  return {reinterpret_cast<const unsigned char*>(file->data()), file->size()};
}

/// Returns the options with which a material's image lies on faces.
const tinyobj::texture_option_t& placing_options(const tinyobj::material_t& material) {
  return material.diffuse_texname.empty() ? material.alpha_texopt : material.diffuse_texopt;
}

/// Returns whether map_d lies on faces as map_Kd does.
bool lie_alike(const tinyobj::texture_option_t& a, const tinyobj::texture_option_t& b) {
  return std::equal(a.origin_offset, a.origin_offset + 2, b.origin_offset) && std::equal(a.scale, a.scale + 2, b.scale) &&
         a.clamp == b.clamp;
}

/// Returns a point of an image after its options -o and -s.
TexturePoint moved(TexturePoint point, const tinyobj::texture_option_t& option) {
  return texture_point(option.scale[0] * point.s + option.origin_offset[0],
                       1 - (option.scale[1] * (1 - point.t) + option.origin_offset[1]));
}

double dissolve_of(const tinyobj::material_t& material) { return std::clamp<double>(material.dissolve, 0, 1); }

}  // namespace

bool MaterialLibrary::operator()(const std::string& file, std::vector<tinyobj::material_t>* materials,
                                 std::map<std::string, int>* index, std::string*, std::string* error) {
  if (file.empty()) return false;
  const std::string* bytes = files_.find(file);
  if (!bytes) {
    missing_.insert(file);
    return false;
  }
  std::istringstream stream(*bytes);
  load(stream, file, materials, index, error);
  return true;
}

const tinyobj::material_t* MaterialLibrary::find(const std::string& name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &found->second;
}

void MaterialLibrary::load(std::istream& stream, const std::string& file, std::vector<tinyobj::material_t>* materials,
                           std::map<std::string, int>* index, std::string* error) {
  const std::string text = clean_lines(stream, colour_lines, file);
  std::istringstream lines(text);
  const std::size_t known = materials->size();
  std::string warning;
  tinyobj::LoadMtl(index, materials, &lines, &warning, error);
  fill_factors(std::span(*materials).subspan(known), text);
  for (std::size_t m = known; m < materials->size(); ++m) by_name_.emplace((*materials)[m].name, (*materials)[m]);
}

void ObjMaterials::fill() {
  Unsupported unsupported;
  for (Material& material : scene_.materials) {
    const tinyobj::material_t* const found = library_.find(material.name);
    if (found) {
      unsupported.metals += found->metallic > 0.5;
      fill(material, *found);
    } else if (!material.name.empty()) {
      warnings_.push_back("material '" + material.name + "' is in no material library: grey, reflectance 0.5");
    } else {
      material.name = "default";
    }
  }
  images_.append_warnings(warnings_);
  unsupported.append_warnings(warnings_);
}

void ObjMaterials::place_textures() {
  for (const Face& face : scene_.faces) {
    const tinyobj::material_t* const found = library_.find(scene_.materials[face.material].name);
    if (!found || !scene_.materials[face.material].texture) continue;
    const tinyobj::texture_option_t& option = placing_options(*found);
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      scene_.texture_points[c] = moved(scene_.texture_points[c], option);
    }
  }
}

void ObjMaterials::place_emission(const std::function<std::vector<TexturePoint>(const Face&)>& points_of) {
  for (std::uint32_t f = 0; f < scene_.faces.size(); ++f) {
    const Face& face = scene_.faces[f];
    if (!emission_textures_.has(face.material)) continue;
    std::vector<TexturePoint> points = points_of(face);
    for (TexturePoint& point : points) point = moved(point, library_.find(scene_.materials[face.material].name)->emissive_texopt);
    if (!points.empty()) emission_textures_.place(f, std::move(points));
  }
}

void ObjMaterials::fill(Material& material, const tinyobj::material_t& found) {
  const double opacity = cover(found, material);
  emit(material, found);
  make_translucent(material, diffuse_transmittance_of(found));
  if (opacity < 1) leave(material, opacity);
}

/// Sets the emission of a material, in the mean over its texture.
void ObjMaterials::emit(Material& material, const tinyobj::material_t& found) {
  const std::string& texture = found.emissive_texname;
  material.emission = emission_of_radiance(rgb_of(found.emission));
  if (texture.empty() || material.emission.is_zero()) return;
  const auto mean = mean_texel(bytes_of(texture));
  if (!mean) {
    warnings_.push_back(place_of(texture, material) + " cannot be read and is left out");
    return;
  }
  material.emission = mean->colour * material.emission;
  const auto image = images_.decoded(texture, bytes_of(texture));
  const Wrap wrap = found.emissive_texopt.clamp ? Wrap::clamp : Wrap::repeat;
  if (image && !has_equal_texels(*image))
    emission_textures_.set(static_cast<std::uint32_t>(&material - scene_.materials.data()), image, wrap, wrap);
}

/// Sets the reflectance of a material and cuts out its holes, by place if it has a texture. Returns the share of the surface that
/// is there if it is the same everywhere, else 1.
double ObjMaterials::cover(const tinyobj::material_t& found, Material& material) {
  const Rgb diffuse = rgb_of(found.diffuse);
  const Wrap wrap = placing_options(found).clamp ? Wrap::clamp : Wrap::repeat;
  if (const auto image = cut_out(found)) {
    // Without map_Kd the image is white, which stands for slightly less than 1.
    const Rgb factor = found.diffuse_texname.empty() ? diffuse * (1 / reflectance_of_texel(255)) : diffuse;
    return images_.cover(material, factor, image, wrap, wrap);
  }
  const double opacity = mean_opacity(found, material);
  const bool is_covered = opacity == 1 && !diffuse.is_zero() && !found.diffuse_texname.empty();
  const auto image = is_covered ? images_.decoded(found.diffuse_texname, bytes_of(found.diffuse_texname)) : nullptr;
  if (image) return images_.cover(material, diffuse, image, wrap, wrap);
  material.reflectance = under_texture(diffuse, found.diffuse_texname, material);
  return opacity;
}

/// Returns the image of map_Kd, or a white one if there is none, with the opacity of map_d, times `d`. Returns null if there is
/// no map_d, if it does not lie as map_Kd does, or if one of the images cannot be read.
std::shared_ptr<const ColourImage> ObjMaterials::cut_out(const tinyobj::material_t& found) {
  const std::string &colour = found.diffuse_texname, &alpha = found.alpha_texname;
  if (alpha.empty() || (!colour.empty() && !lie_alike(found.diffuse_texopt, found.alpha_texopt))) return nullptr;
  const std::string* const colour_bytes = colour.empty() ? nullptr : bytes_of(colour);
  const std::string* const alpha_bytes = bytes_of(alpha);
  const auto make = [&]() -> std::optional<ColourImage> {
    auto opacity = decode_opacity(bytes_in(alpha_bytes), dissolve_of(found));
    if (!opacity || colour.empty()) return opacity;
    const auto colours = decode_colours(bytes_in(colour_bytes));
    return colours ? std::optional(with_opacity(*colours, *opacity)) : std::nullopt;
  };
  const std::string use = "map_d " + std::to_string(dissolve_of(found)) + " " + alpha;
  return images_.made(colour.empty() ? alpha : colour, colour.empty() ? "without map_Kd " + use : use, make);
}

const std::string* ObjMaterials::bytes_of(const std::string& texture) { return files_.find(with_slashes(texture)); }

Rgb ObjMaterials::under_texture(const Rgb& factor, const std::string& texture, const Material& material) {
  if (texture.empty() || factor.is_zero()) return factor;
  return textured(factor, mean_texel(bytes_of(texture)), place_of(texture, material), warnings_);
}

/// Returns the share of a material's surface that is there: `d`, times the mean of `map_d`: of the image's alpha if it has any,
/// else of its values.
double ObjMaterials::mean_opacity(const tinyobj::material_t& found, const Material& material) {
  const double factor = dissolve_of(found);
  if (found.alpha_texname.empty()) return factor;
  const auto mean = mean_texel(bytes_of(found.alpha_texname), {AlphaUse::Kind::blended});
  warnings_.push_back(place_of(found.alpha_texname, material) +
                      (mean ? " counts by its mean opacity" : " cannot be read and is left out"));
  if (!mean) return factor;
  return factor * (mean->has_alpha ? mean->opacity : mean->level);
}

}  // namespace alvor
