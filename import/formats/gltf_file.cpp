#include "import/formats/gltf_file.h"

#include "import/base/bytes.h"
#include "import/base/glb_format.h"
#include "import/base/import_error.h"
#include "import/formats/gltf_material.h"
#include "import/formats/named_file.h"
#include "import/formats/tiny_gltf.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace alvor {

namespace {

using nlohmann::json;

constexpr int max_depth = 200;

/// Returns whether an extension changes neither shapes nor places, so that a file may require it.
bool is_harmless(const std::string& extension) {
  if (extension == "KHR_materials_pbrSpecularGlossiness") return false;  // it has its own reflectance
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_texture_") ||
         extension.starts_with("EXT_texture_") || extension == "KHR_mesh_quantization" || extension == "KHR_lights_punctual" ||
         extension == "EXT_lights_ies";
}

void refuse_unknown_extensions(const tinygltf::Model& model) {
  for (const std::string& extension : model.extensionsRequired)
    if (!is_harmless(extension)) throw ImportError("file", "requires the extension " + extension + ", which is not supported");
}

/// The two parts of a glTF file. A text file has no binary part.
struct Container {
  std::string_view text;
  std::optional<std::string_view> binary;
};

/// Removes the next chunk from the front of a GLB's `rest` and returns it.
std::string_view take_chunk(std::string_view& rest, std::uint32_t type, const char* name) {
  if (rest.size() < glb::chunk_header_size || value_at<std::uint32_t>(rest, 4) != type)
    throw ImportError("file", std::string("has no ") + name + " chunk");
  const std::size_t size = value_at<std::uint32_t>(rest, 0);
  if (size > rest.size() - glb::chunk_header_size) throw ImportError("file", std::string("ends within its ") + name + " chunk");
  const std::string_view chunk = rest.substr(glb::chunk_header_size, size);
  rest.remove_prefix(glb::chunk_header_size + size);
  return chunk;
}

Container container_of(std::string_view content) {
  if (!content.starts_with("glTF")) return {content, {}};
  if (content.size() < glb::file_header_size) throw ImportError("file", "ends within its header");
  if (const auto version = value_at<std::uint32_t>(content, 4); version != 2)
    throw ImportError("file", "is GLB of version " + std::to_string(version) + ", only 2 is supported");
  std::string_view rest = content.substr(glb::file_header_size);
  Container container{take_chunk(rest, glb::json_chunk, "JSON"), {}};
  if (!rest.empty()) container.binary = take_chunk(rest, glb::binary_chunk, "BIN");
  return container;
}

/// Refuses JSON that is nested too deeply: tinygltf copies values by recursion, and a megabyte of brackets would overflow the
/// stack.
void refuse_deep(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') ++i;
    else if (c == '"') quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++depth > max_depth) throw ImportError("file", "its JSON is nested too deeply");
    else if (!quoted && (c == ']' || c == '}')) --depth;
  }
}

json parse(std::string_view text) {
  refuse_deep(text);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    throw ImportError("file", "its JSON is broken at byte " + std::to_string(error.byte));
  }
}

/// Limits the bytes read for one scene: a few bytes of JSON can name a large file many times.
class ByteBudget {
 public:
  void spend(std::size_t bytes, const std::string& place) {
    if (bytes > left_) throw ImportError(place, "is beyond the 4 GB that the files beside a scene may have");
    left_ -= bytes;
  }

 private:
  std::size_t left_ = std::size_t{1} << 32;
};

bool is_data_uri(const std::string& uri) { return uri.starts_with("data:"); }

std::string uri_of(const json& element) {
  const auto uri = element.find("uri");
  return uri != element.end() && uri->is_string() ? uri->get<std::string>() : std::string();
}

/// The bytes of the buffers outside the JSON. tinygltf asks for them by the buffer's number.
class Buffers {
 public:
  /// Takes the files that the JSON's buffers name, and replaces each URI by the buffer's number.
  Buffers(json& gltf, std::optional<std::string_view> binary, SceneFiles& files, ByteBudget& budget) {
    const auto buffers = gltf.find("buffers");
    if (buffers == gltf.end() || !buffers->is_array()) return;
    for (json& buffer : *buffers) {
      bytes_.emplace_back();
      if (!buffer.is_object()) continue;
      const std::string place = "buffer " + std::to_string(bytes_.size() - 1), uri = uri_of(buffer);
      if (is_data_uri(uri)) continue;
      if (!uri.empty()) bytes_.back() = file_of_uri(files, uri, place);
      else if (binary && bytes_.size() == 1) bytes_.back() = *binary;
      else throw ImportError(place, "names no file");
      budget.spend(bytes_.back().size(), place);
      cut_to_length(bytes_.back(), buffer, place + (uri.empty() ? "" : " '" + uri + "'"));
      buffer["uri"] = std::to_string(bytes_.size() - 1);
    }
  }

  tinygltf::FsCallbacks callbacks() {
    return {[](const std::string& name, void* self) { return of(self).find(name) != nullptr; },
            [](const std::string& name, void*) { return name; },
            [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* self) {
              const std::string* found = of(self).find(name);
              if (found) out->assign(found->begin(), found->end());
              return found != nullptr;
            },
            [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }, this};
  }

 private:
  static Buffers& of(void* self) { return *static_cast<Buffers*>(self); }

  /// Cuts the bytes to the buffer's byteLength. Throws ImportError if there are fewer.
  static void cut_to_length(std::string& bytes, const json& buffer, const std::string& place) {
    const auto length = buffer.find("byteLength");
    if (length == buffer.end() || !length->is_number_unsigned()) throw ImportError(place, "has no byteLength");
    const auto needed = length->get<std::uint64_t>();
    if (needed > bytes.size())
      throw ImportError(place, "is too short: " + std::to_string(bytes.size()) + " of " + std::to_string(needed) + " bytes");
    bytes.resize(needed);
    bytes.shrink_to_fit();
  }

  const std::string* find(const std::string& name) const {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool known = error == std::errc() && end == name.data() + name.size() && number < bytes_.size();
    return known ? &bytes_[number] : nullptr;
  }

  std::vector<std::string> bytes_;
};

/// Keeps an image of the JSON encoded until a material asks for it. Images in buffer views stay there, because tinygltf does not
/// check their range.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                  void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// Returns the element of an object, or null if there is none or `object` is none.
const json* member(const json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found == object.end() ? nullptr : &*found;
}

/// Returns the element whose index is `object[name]` in the file's list, or null.
const json* element_of(const json& gltf, const char* list, const json& object, const char* name) {
  const json* const index = member(object, name);
  const json* const elements = member(gltf, list);
  if (!index || !index->is_number_unsigned() || !elements || !elements->is_array()) return nullptr;
  const auto number = index->get<std::uint64_t>();
  return number < elements->size() ? &(*elements)[number] : nullptr;
}

/// Asks for a file, so that `files` remembers it if it is missing. Faulty names are refused later.
void ask_for(const json& element, SceneFiles& files) {
  const std::string uri = element.is_object() ? uri_of(element) : "";
  if (!uri.empty() && !is_data_uri(uri)) files.find(decoded_uri(uri));
}

/// Asks for the images that give materials a colour, see colour_textures().
void ask_for_images(const json& gltf, SceneFiles& files) {
  const json* const materials = member(gltf, "materials");
  if (!materials || !materials->is_array()) return;
  const auto ask_for_texture = [&](const json* texture_use) {
    const json* const texture = texture_use ? element_of(gltf, "textures", *texture_use, "index") : nullptr;
    if (!texture) return;
    const json* const extensions = member(*texture, "extensions");
    const json* const webp = extensions ? member(*extensions, "EXT_texture_webp") : nullptr;
    for (const json* const shown : {webp, texture})
      if (const json* const image = shown ? element_of(gltf, "images", *shown, "source") : nullptr) ask_for(*image, files);
  };
  for (const json& material : *materials) {
    const json* const surface = member(material, "pbrMetallicRoughness");
    ask_for_texture(surface ? member(*surface, "baseColorTexture") : nullptr);
    ask_for_texture(member(material, "emissiveTexture"));
    const json* const extensions = member(material, "extensions");
    const json* const scattering = extensions ? member(*extensions, "KHR_materials_diffuse_transmission") : nullptr;
    if (!scattering) continue;
    ask_for_texture(member(*scattering, "diffuseTransmissionTexture"));
    ask_for_texture(member(*scattering, "diffuseTransmissionColorTexture"));
  }
}

/// Asks for all files that are needed, because the first missing one ends the reading.
void ask_for_files(const json& gltf, SceneFiles& files) {
  const json* const buffers = member(gltf, "buffers");
  if (buffers && buffers->is_array())
    for (const json& buffer : *buffers) ask_for(buffer, files);
  ask_for_images(gltf, files);
  const json* const extensions = member(gltf, "extensions");
  const json* const luminaires = extensions ? member(*extensions, "EXT_lights_ies") : nullptr;
  const json* const profiles = luminaires ? member(*luminaires, "lights") : nullptr;
  if (profiles && profiles->is_array())
    for (const json& profile : *profiles) ask_for(profile, files);
}

/// Returns the textures that give materials a colour. Images of others (bump maps, roughness) may be missing.
std::set<int> colour_textures(const tinygltf::Model& model) {
  std::set<int> textures;
  for (const tinygltf::Material& material : model.materials)
    for (const int texture : textures_of(material))
      if (texture >= 0 && texture < static_cast<int>(model.textures.size())) textures.insert(texture);
  return textures;
}

/// Reads an image from its file, if it has one and was not read before. Returns whether there is such an image. Throws
/// MissingFileError.
bool read_image(tinygltf::Model& model, int number, SceneFiles& files, ByteBudget& budget) {
  if (number < 0 || number >= static_cast<int>(model.images.size())) return false;
  tinygltf::Image& image = model.images[static_cast<std::size_t>(number)];
  if (image.bufferView >= 0 || image.uri.empty() || !image.image.empty()) return true;
  const std::string place = "image " + std::to_string(number);
  const std::string& bytes = file_of_uri(files, image.uri, place);
  budget.spend(bytes.size(), place);
  image.image.assign(bytes.begin(), bytes.end());
  return true;
}

/// Reads the images that a texture may show, see images_of(). Throws MissingFileError if all of them are missing: one is enough.
void read_images_of(const tinygltf::Texture& texture, tinygltf::Model& model, SceneFiles& files, ByteBudget& budget) {
  std::optional<MissingFileError> first_missing;
  bool is_one_here = false;
  for (const int number : images_of(texture)) try {
      if (read_image(model, number, files, budget)) is_one_here = true;
    } catch (const MissingFileError& error) {
      if (!first_missing) first_missing = error;
    }
  if (first_missing && !is_one_here) throw *first_missing;
}

void read_images(tinygltf::Model& model, SceneFiles& files, ByteBudget& budget) {
  for (const int texture : colour_textures(model))
    read_images_of(model.textures[static_cast<std::size_t>(texture)], model, files, budget);
}

/// Gives all images in data URIs the media type of plain bytes, as tinygltf does not know image/webp. What an image is, its bytes
/// tell.
void rename_media_types(json& gltf) {
  constexpr std::string_view image_type = "data:image/", encoding = ";base64";
  const auto images = gltf.find("images");
  if (images == gltf.end() || !images->is_array()) return;
  for (json& image : *images) {
    if (!image.is_object()) continue;
    const std::string uri = uri_of(image), header = uri.substr(0, uri.find(','));
    if (header.starts_with(image_type) && header.ends_with(encoding))
      image["uri"] = "data:application/octet-stream;base64" + uri.substr(header.size());
  }
}

}  // namespace

tinygltf::Model load_gltf(SceneFiles& files) {
  const Container container = container_of(files.bytes());
  json gltf = parse(container.text);
  ask_for_files(gltf, files);
  rename_media_types(gltf);
  ByteBudget budget;
  Buffers buffers(gltf, container.binary, files, budget);
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, nullptr);
  loader.SetFsCallbacks(buffers.callbacks());
  const std::string text = gltf.dump(-1, ' ', false, json::error_handler_t::replace);
  tinygltf::Model model;
  std::string error, warning;
  if (!loader.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), ""))
    throw ImportError("file", error.empty() ? "is not glTF" : error);
  refuse_unknown_extensions(model);
  read_images(model, files, budget);
  return model;
}

}  // namespace alvor
