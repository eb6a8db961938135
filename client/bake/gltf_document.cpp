#include "client/bake/gltf_document.h"

#include "client/bake/gltf_parts.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <algorithm>
#include <limits>

namespace alvor {

namespace {

using nlohmann::json;

constexpr std::size_t most_bytes = std::numeric_limits<std::uint32_t>::max();
constexpr int signed_byte = 5120, unsigned_byte = 5121, signed_short = 5122, unsigned_short = 5123;

std::string place_of(const char* list, std::size_t index) { return std::string(list) + " " + std::to_string(index); }

std::size_t component_size(std::size_t type, const std::string& place) {
  switch (type) {
    case signed_byte:
    case unsigned_byte: return 1;
    case signed_short:
    case unsigned_short: return 2;
    case glb::uint_component:
    case glb::float_component: return 4;
  }
  throw BakeError(place, "componentType " + std::to_string(type) + " is unknown");
}

std::size_t component_count(const std::string& type, const std::string& place) {
  constexpr std::pair<std::string_view, std::size_t> counts[]{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
  for (const auto& [name, count] : counts)
    if (name == type) return count;
  throw BakeError(place, "type '" + type + "' has no place at a vertex");
}

/// Returns a component as a number; normalised integers as shares of the largest.
float component(std::string_view bytes, std::size_t type, bool normalised) {
  const auto share = [&](auto value) {
    return normalised ? std::max(static_cast<float>(value) / std::numeric_limits<decltype(value)>::max(), -1.0f)
                      : static_cast<float>(value);
  };
  switch (type) {
    case signed_byte: return share(value_at<std::int8_t>(bytes, 0));
    case unsigned_byte: return share(value_at<std::uint8_t>(bytes, 0));
    case signed_short: return share(value_at<std::int16_t>(bytes, 0));
    case unsigned_short: return share(value_at<std::uint16_t>(bytes, 0));
    case glb::uint_component: return share(value_at<std::uint32_t>(bytes, 0));
    default: return value_at<float>(bytes, 0);
  }
}

std::uint32_t index_at(std::string_view bytes, std::size_t size) {
  if (size == 1) return value_at<std::uint8_t>(bytes, 0);
  return size == 2 ? value_at<std::uint16_t>(bytes, 0) : value_at<std::uint32_t>(bytes, 0);
}

void append_chunk(std::string& glb, std::uint32_t type, std::string_view bytes, char filler) {
  const std::size_t size = (bytes.size() + 3) / 4 * 4;
  append_value(glb, static_cast<std::uint32_t>(size));
  append_value(glb, type);
  glb.append(bytes).append(size - bytes.size(), filler);
}

}  // namespace

void add_extra_to(json& part, const std::string& name, json extra) {
  json& extras = part["extras"];
  if (!extras.is_object() && !extras.is_null()) extras = {{"extras", extras}};
  extras[name] = std::move(extra);
}

void drop_compression(json& primitive) {
  if (!primitive.contains("extensions")) return;
  primitive["extensions"].erase("KHR_draco_mesh_compression");
  if (primitive["extensions"].empty()) primitive.erase("extensions");
}

bool is_index(const json& value) {
  return value.is_number_integer() && (value.is_number_unsigned() || value.get<std::int64_t>() >= 0);
}

std::size_t index_in(const json& object, const char* name, const std::string& place, std::optional<std::size_t> otherwise) {
  const auto member = object.find(name);
  if (member == object.end() && otherwise) return *otherwise;
  if (member == object.end() || !is_index(*member)) throw BakeError(place, std::string("its ") + name + " is no index");
  return member->get<std::size_t>();
}

GltfDocument::GltfDocument() : root_{{"asset", {{"version", "2.0"}, {"generator", "Alvor"}}}} {}

GltfDocument::GltfDocument(std::string_view bytes, const FileFinder& find) {
  const GltfParts parts = parts_of(bytes);
  root_ = parse_gltf(parts.text);
  take_in_buffers(find, parts.binary);
  take_in_images(find);
}

const json& GltfDocument::element(const char* list, std::size_t index) const {
  const auto found = root_.find(list);
  if (found == root_.end() || !found->is_array() || index >= found->size() || !(*found)[index].is_object())
    throw BakeError(place_of(list, index), "is not in the file");
  return (*found)[index];
}

std::size_t GltfDocument::append(const char* list, json element) {
  json& elements = root_[list];
  elements.push_back(std::move(element));
  return elements.size() - 1;
}

/// Puts all buffers behind each other and moves the views.
void GltfDocument::take_in_buffers(const FileFinder& find, std::optional<std::string_view> chunk) {
  std::vector<std::size_t> begin, length;
  if (root_.contains("buffers"))
    for (const json& buffer : root_["buffers"]) {
      const std::string place = place_of("buffer", begin.size());
      const auto uri = buffer.find("uri");
      begin.push_back(binary_.size());
      if (uri != buffer.end() && uri->is_string()) binary_ += bytes_of(uri->get<std::string>(), find, place);
      else if (chunk && begin.size() == 1) binary_ += *chunk;
      else throw BakeError(place, "has no bytes");
      length.push_back(std::min(binary_.size() - begin.back(), index_in(buffer, "byteLength", place)));
      binary_.resize((binary_.size() + 3) / 4 * 4);
      if (binary_.size() > most_bytes) throw BakeError(place, "is beyond the 4 GB of a GLB file");
    }
  root_.erase("buffers");
  if (!root_.contains("bufferViews")) return;
  std::size_t number = 0;
  for (json& of : root_["bufferViews"]) {
    const std::string place = place_of("bufferView", number++);
    const std::size_t buffer = index_in(of, "buffer", place), offset = index_in(of, "byteOffset", place, 0),
                      size = index_in(of, "byteLength", place);
    if (buffer >= begin.size() || offset > length[buffer] || size > length[buffer] - offset)
      throw BakeError(place, "is not within its buffer");
    of["buffer"] = 0;
    of["byteOffset"] = begin[buffer] + offset;
  }
}

void GltfDocument::take_in_images(const FileFinder& find) {
  if (!root_.contains("images")) return;
  std::size_t number = 0;
  for (json& image : root_["images"]) {
    const std::string place = place_of("image", number++);
    const auto uri = image.find("uri");
    if (uri == image.end() || !uri->is_string()) continue;
    const std::string bytes = bytes_of(uri->get<std::string>(), find, place);
    image.erase("uri");
    image["mimeType"] = std::string_view(bytes).starts_with("\xff\xd8")           ? "image/jpeg"
                        : std::string_view(bytes).substr(0, 12).ends_with("WEBP") ? "image/webp"
                                                                                  : "image/png";
    image["bufferView"] = add_view(bytes, std::nullopt);
  }
}

std::string_view GltfDocument::view(std::size_t index, std::size_t& stride) const {
  const json& of = element("bufferViews", index);
  const std::string place = place_of("bufferView", index);
  stride = index_in(of, "byteStride", place, 0);
  return std::string_view(binary_).substr(index_in(of, "byteOffset", place, 0), index_in(of, "byteLength", place));
}

DenseElements GltfDocument::read(std::size_t accessor) const {
  const json& of = element("accessors", accessor);
  const std::string place = place_of("accessor", accessor);
  const std::size_t type = index_in(of, "componentType", place);
  DenseElements elements;
  elements.count = index_in(of, "count", place);
  elements.element_size = component_size(type, place) * component_count(of.value("type", ""), place);
  if (elements.count > most_bytes / elements.element_size) throw BakeError(place, "is too long");
  const auto copy = [&](const json& from, std::size_t count, std::size_t size, auto put) {
    std::size_t stride = 0;
    const std::string_view bytes = view(index_in(from, "bufferView", place), stride);
    if (stride == 0) stride = size;
    const std::size_t begin = index_in(from, "byteOffset", place, 0);
    if (count > 0 && (begin > bytes.size() || (count - 1) > (bytes.size() - begin) / stride ||
                      size > bytes.size() - begin - (count - 1) * stride))
      throw BakeError(place, "is not within its bufferView");
    for (std::size_t n = 0; n < count; ++n) put(n, bytes.substr(begin + n * stride, size));
  };
  const auto put = [&](std::size_t n, std::string_view bytes) {
    std::copy(bytes.begin(), bytes.end(), elements.bytes.begin() + static_cast<std::ptrdiff_t>(n * elements.element_size));
  };
  if (!of.contains("bufferView") && elements.count > binary_.size()) throw BakeError(place, "has more zeros than the file bytes");
  elements.bytes.resize(elements.count * elements.element_size);
  if (of.contains("bufferView")) copy(of, elements.count, elements.element_size, put);
  if (const auto sparse = of.find("sparse"); sparse != of.end()) {
    const std::size_t count = index_in(*sparse, "count", place);
    const json &indices = sparse->at("indices"), &values = sparse->at("values");
    const std::size_t size = component_size(index_in(indices, "componentType", place), place);
    std::vector<std::size_t> at;
    copy(indices, count, size, [&](std::size_t, std::string_view bytes) { at.push_back(index_at(bytes, size)); });
    copy(values, count, elements.element_size, [&](std::size_t n, std::string_view bytes) {
      if (at[n] >= elements.count) throw BakeError(place, "its sparse indices are beyond its elements");
      put(at[n], bytes);
    });
  }
  return elements;
}

template <std::size_t size>
std::vector<std::array<float, size>> GltfDocument::read_vectors(std::size_t accessor, const char* type) const {
  const DenseElements elements = read(accessor);
  const json& of = element("accessors", accessor);
  const std::string place = place_of("accessor", accessor);
  if (of.value("type", "") != type) throw BakeError(place, std::string("is no ") + type);
  const std::size_t kind = index_in(of, "componentType", place), bytes = component_size(kind, place);
  const bool normalised = of.value("normalized", false);
  std::vector<std::array<float, size>> vectors(elements.count);
  for (std::size_t n = 0; n < elements.count; ++n)
    for (std::size_t axis = 0; axis < size; ++axis)
      vectors[n][axis] = component(elements.at(n).substr(axis * bytes, bytes), kind, normalised);
  return vectors;
}

std::vector<std::array<float, 3>> GltfDocument::read_positions(std::size_t accessor) const {
  return read_vectors<3>(accessor, "VEC3");
}

std::vector<std::array<float, 2>> GltfDocument::read_points(std::size_t accessor) const {
  return read_vectors<2>(accessor, "VEC2");
}

std::vector<std::array<float, 4>> GltfDocument::read_colours(std::size_t accessor) const {
  if (element("accessors", accessor).value("type", "") == "VEC4") return read_vectors<4>(accessor, "VEC4");
  std::vector<std::array<float, 4>> colours;
  for (const auto& [r, g, b] : read_vectors<3>(accessor, "VEC3")) colours.push_back({r, g, b, 1});
  return colours;
}

std::vector<std::uint32_t> GltfDocument::read_indices(std::size_t accessor) const {
  const DenseElements elements = read(accessor);
  if (element("accessors", accessor).value("type", "") != "SCALAR")
    throw BakeError(place_of("accessor", accessor), "holds no indices");
  std::vector<std::uint32_t> indices(elements.count);
  for (std::size_t n = 0; n < elements.count; ++n) indices[n] = index_at(elements.at(n), elements.element_size);
  return indices;
}

std::size_t GltfDocument::add_view(std::string_view bytes, std::optional<int> target) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  json of{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target) of["target"] = *target;
  binary_ += bytes;
  return append("bufferViews", std::move(of));
}

std::size_t GltfDocument::add_accessor(json like, std::string_view bytes, std::size_t count, int target) {
  for (const char* gone : {"sparse", "byteOffset", "min", "max"}) like.erase(gone);
  like["count"] = count;
  // Elements of vertices begin at multiples of four bytes.
  const std::size_t size = count > 0 ? bytes.size() / count : 0, stride = (size + 3) / 4 * 4;
  if (target == glb::array_buffer && stride != size) {
    std::string spread(count * stride, '\0');
    for (std::size_t n = 0; n < count; ++n)
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(n * size), size,
                  spread.begin() + static_cast<std::ptrdiff_t>(n * stride));
    like["bufferView"] = add_view(spread, target);
    root_["bufferViews"].back()["byteStride"] = stride;
  } else {
    like["bufferView"] = add_view(bytes, target);
  }
  return append("accessors", std::move(like));
}

std::size_t GltfDocument::add_accessor_like(std::size_t accessor, std::string_view bytes, std::size_t count) {
  const json like = element("accessors", accessor);
  const std::size_t made = add_accessor(like, bytes, count, glb::array_buffer);
  for (const char* bound : {"min", "max"})
    if (like.contains(bound)) root_["accessors"][made][bound] = like[bound];
  return made;
}

std::size_t GltfDocument::add_indices(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::string bytes;
  for (const auto& triangle : triangles)
    for (const std::uint32_t vertex : triangle) append_value(bytes, vertex);
  return add_accessor({{"componentType", glb::uint_component}, {"type", "SCALAR"}}, bytes, 3 * triangles.size(),
                      glb::element_array_buffer);
}

std::size_t GltfDocument::add_png(std::string_view bytes, const std::string& name) {
  const std::size_t of = add_view(bytes, std::nullopt);
  return append("images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", of}});
}

void GltfDocument::use_extension(const char* name) {
  json& used = root_["extensionsUsed"];
  if (std::ranges::find(used, name) == used.end()) used.push_back(name);
}

void GltfDocument::add_extra(const std::string& name, json extra) { add_extra_to(root_, name, std::move(extra)); }

std::string GltfDocument::encode() const {
  json root = root_;
  if (!binary_.empty()) root["buffers"] = json::array({{{"byteLength", binary_.size()}}});
  const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  const std::size_t size =
      glb::file_header_size + 2 * glb::chunk_header_size + (text.size() + 3) / 4 * 4 + (binary_.size() + 3) / 4 * 4;
  if (size > most_bytes) throw BakeError("file", "would have more than the 4 GB of a GLB file");
  std::string glb;
  glb.reserve(size);
  append_value(glb, glb::magic);
  append_value(glb, std::uint32_t{2});
  append_value(glb, static_cast<std::uint32_t>(binary_.empty() ? size - glb::chunk_header_size : size));
  append_chunk(glb, glb::json_chunk, text, ' ');
  if (!binary_.empty()) append_chunk(glb, glb::binary_chunk, binary_, '\0');
  return glb;
}

}  // namespace alvor
