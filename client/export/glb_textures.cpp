#include "client/export/glb_textures.h"

#include "client/export/solution_file.h"
#include "client/picture/png_file.h"
#include "import/base/whole_file.h"

#include <map>
#include <memory>

namespace alvor {

namespace {

using nlohmann::json;

constexpr std::size_t most_groups = 1000;     // of half a kilobyte of JSON each
constexpr std::size_t most_texels = 1 << 26;  // of all images, as in a scene: a small file can hold large ones

int mode_of(Wrap wrap) {
  return wrap == Wrap::mirror ? glb::mirrored_repeat : wrap == Wrap::clamp ? glb::clamp_to_edge : glb::repeat;
}

Wrap wrap_of(const json& mode) {
  if (mode == glb::repeat) return Wrap::repeat;
  if (mode == glb::mirrored_repeat) return Wrap::mirror;
  if (mode == glb::clamp_to_edge) return Wrap::clamp;
  throw SolutionFileError("its wrap mode is not known");
}

std::string encode(const ColourImage& image) {
  return encode_png({static_cast<int>(image.columns), static_cast<int>(image.rows), image.texels, image.has_opacity}, "texture");
}

std::shared_ptr<const ColourImage> decode(std::string_view bytes) {
  Image picture = decode_png(bytes, ColourImage::most_columns, ColourImage::most_rows);
  return std::make_shared<const ColourImage>(ColourImage{static_cast<std::uint32_t>(picture.width),
                                                         static_cast<std::uint32_t>(picture.height), std::move(picture.rgb),
                                                         picture.has_opacity});
}

std::size_t whole_number(const json& value) {
  if (!value.is_number_unsigned()) throw SolutionFileError("one of its numbers is not a whole number");
  return value.get<std::size_t>();
}

/// The images that were read, by their numbers in the file.
struct KnownImages {
  std::map<std::size_t, std::shared_ptr<const ColourImage>> images;
  std::size_t texels = 0;
};

/// Reads an element of the list, with the images that were read before.
void read_texture(const json& source, const std::function<std::string_view(std::size_t)>& image_bytes, DisplayMesh& mesh,
                  KnownImages& known) {
  const std::size_t material = whole_number(source.at("material")), image = whole_number(source.at("image"));
  if (material >= mesh.materials.size()) throw SolutionFileError("there is no material " + std::to_string(material));
  const auto [found, is_new] = known.images.try_emplace(image);
  if (is_new) known.texels += (found->second = decode(image_bytes(image)))->texel_count();
  if (known.texels > most_texels) throw SolutionFileError("the images have more than 67108864 texels");
  const auto [r, g, b] = source.at("factor").get<std::array<double, 3>>();
  for (const double band : {r, g, b})
    if (!(band >= 0 && band <= 1)) throw SolutionFileError("its factor is outside [0, 1]");
  mesh.materials[material].texture =
      Texture{found->second, {r, g, b}, wrap_of(source.at("wrap_s")), wrap_of(source.at("wrap_t"))};
}

}  // namespace

TriangleGroups group_by_texture(const DisplayMesh& mesh) {
  std::map<std::optional<std::uint32_t>, std::vector<std::pair<std::size_t, const FaceTriangles*>>> runs;  // with first triangles
  std::size_t first = 0;
  for (const FaceTriangles& run : mesh.faces) {
    const bool has_texture = !mesh.texture_points.empty() && mesh.materials[run.material].texture;
    runs[has_texture ? std::optional(run.material) : std::nullopt].emplace_back(first, &run);
    first += run.count;
  }
  if (runs.size() < 2 || runs.size() > most_groups + 1) {
    const auto material = runs.size() == 1 ? runs.begin()->first : std::nullopt;
    return {{{material, mesh.triangles.size()}}, mesh.triangles, mesh.faces, {}, {}};
  }
  TriangleGroups all;
  for (const auto& [material, of_material] : runs) {
    all.groups.push_back({material, 0});
    for (const auto& [start, run] : of_material) {
      const auto begin = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(start);
      all.reordered_triangles.insert(all.reordered_triangles.end(), begin, begin + static_cast<std::ptrdiff_t>(run->count));
      all.reordered_faces.push_back(*run);
      all.groups.back().count += run->count;
    }
  }
  all.triangles = all.reordered_triangles, all.faces = all.reordered_faces;
  return all;
}

void write_textures(const DisplayMesh& mesh, const TriangleGroups& groups, BinaryChunk& chunk, json& root, json& extras) {
  std::map<const ColourImage*, std::size_t> images;
  for (const auto& [material, count] : groups.groups) {
    if (!material) continue;
    const Texture& texture = *mesh.materials[*material].texture;
    const auto [image, is_new] = images.try_emplace(texture.image.get(), images.size());
    if (is_new) root["images"].push_back({{"mimeType", "image/png"}, {"bufferView", chunk.add_file(encode(*texture.image))}});
    const std::size_t number = root["textures"].size();
    root["samplers"].push_back({{"wrapS", mode_of(texture.wrap_s)}, {"wrapT", mode_of(texture.wrap_t)}});
    root["textures"].push_back({{"source", image->second}, {"sampler", number}});
    const Rgb& factor = texture.factor;
    json shown = root["materials"][0];
    shown["name"] = "solution " + std::to_string(number);
    shown["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", number}};
    shown["pbrMetallicRoughness"]["baseColorFactor"] = {factor.r, factor.g, factor.b, 1};
    root["materials"].push_back(std::move(shown));
    extras[glb::textures_key].push_back({{"material", *material},
                                         {"image", image->second},
                                         {"factor", {factor.r, factor.g, factor.b}},
                                         {"wrap_s", mode_of(texture.wrap_s)},
                                         {"wrap_t", mode_of(texture.wrap_t)}});
  }
}

void read_textures(const json& list, const std::function<std::string_view(std::size_t)>& image_bytes, DisplayMesh& mesh) {
  KnownImages known;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = "texture " + std::to_string(i) + ": ";
    try {
      read_texture(list[i], image_bytes, mesh, known);
    } catch (const json::exception&) {
      throw SolutionFileError(place + "not as Alvor writes it");
    } catch (const FileError& error) {
      throw SolutionFileError(place + error.what());
    } catch (const SolutionFileError& error) {
      throw SolutionFileError(place + error.what());
    }
  }
}

}  // namespace alvor
