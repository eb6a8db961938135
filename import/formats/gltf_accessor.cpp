#include "import/formats/gltf_accessor.h"

#include "import/base/import_error.h"
#include "import/formats/tiny_gltf.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <limits>

namespace alvor {

namespace {

struct Elements {
  std::span<const unsigned char> bytes;
  std::size_t count, stride, component_size;
  const unsigned char* at(std::size_t element, std::size_t component = 0) const {
    return bytes.data() + element * stride + component * component_size;
  }
};

/// Returns whether the elements lie within their bytes. Divides instead of multiplying, because products of hostile numbers
/// overflow.
bool fits(const Elements& elements, std::size_t element_size) {
  if (elements.count == 0) return true;
  if (elements.bytes.size() < element_size) return false;
  return elements.count - 1 <= (elements.bytes.size() - element_size) / elements.stride;
}

const tinygltf::Accessor& accessor_of(const tinygltf::Model& model, int index, const std::string& place) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) throw ImportError(place, "is not in the file");
  return model.accessors[static_cast<std::size_t>(index)];
}

/// Returns the elements of an accessor, checked to lie in its buffer view. `type` is TINYGLTF_TYPE_SCALAR, _VEC2, _VEC3 or _VEC4.
Elements elements_of(const tinygltf::Model& model, const tinygltf::Accessor& accessor, int type, const std::string& place) {
  if (accessor.sparse.isSparse) throw ImportError(place, "sparse accessors are not supported");
  if (accessor.type != type) throw ImportError(place, "is not of the type its use asks for");
  if (accessor.bufferView < 0) throw ImportError(place, "has no bufferView");
  const auto view = bytes_of_view(model, accessor.bufferView);
  const int component_size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const int stride = accessor.ByteStride(model.bufferViews[static_cast<std::size_t>(accessor.bufferView)]);
  const int element_size = component_size * tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
  if (component_size <= 0 || stride < element_size) throw ImportError(place, "its byteStride does not fit its elements");
  if (accessor.byteOffset > view.size()) throw ImportError(place, "begins beyond its bufferView");
  const Elements elements{view.subspan(accessor.byteOffset), accessor.count, static_cast<std::size_t>(stride),
                          static_cast<std::size_t>(component_size)};
  if (!fits(elements, static_cast<std::size_t>(element_size))) throw ImportError(place, "ends beyond its bufferView");
  return elements;
}

template <class T>
T load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Returns one coordinate from bytes. KHR_mesh_quantization allows integers; a normalized one is a fraction of the type's largest
/// value.
template <class T>
double load_scaled(const unsigned char* bytes, bool normalized) {
  const double value = load<T>(bytes);
  return normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

double load_coordinate(const unsigned char* bytes, const tinygltf::Accessor& accessor, const std::string& place) {
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return load<float>(bytes);
    case TINYGLTF_COMPONENT_TYPE_BYTE: return load_scaled<std::int8_t>(bytes, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return load_scaled<std::uint8_t>(bytes, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return load_scaled<std::int16_t>(bytes, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load_scaled<std::uint16_t>(bytes, accessor.normalized);
  }
  throw ImportError(place, "coordinates cannot have componentType " + std::to_string(accessor.componentType));
}

std::uint32_t load_index(const unsigned char* bytes, int component_type, const std::string& place) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<std::uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return load<std::uint32_t>(bytes);
  }
  throw ImportError(place, "indices cannot have componentType " + std::to_string(component_type));
}

}  // namespace

std::span<const unsigned char> bytes_of_view(const tinygltf::Model& model, int view) {
  const std::string place = "bufferView " + std::to_string(view);
  if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size()) throw ImportError(place, "is not in the file");
  const tinygltf::BufferView& range = model.bufferViews[static_cast<std::size_t>(view)];
  if (range.buffer < 0 || static_cast<std::size_t>(range.buffer) >= model.buffers.size())
    throw ImportError(place, "buffer " + std::to_string(range.buffer) + " is not in the file");
  const std::span<const unsigned char> buffer = model.buffers[static_cast<std::size_t>(range.buffer)].data;
  if (range.byteOffset > buffer.size() || range.byteLength > buffer.size() - range.byteOffset)
    throw ImportError(place,
                      "ends beyond buffer " + std::to_string(range.buffer) + " of " + std::to_string(buffer.size()) + " bytes");
  return buffer.subspan(range.byteOffset, range.byteLength);
}

namespace {

/// Returns the values of an accessor of one of these types. `value` makes one of the elements, the accessor and its place, and
/// the number of the element.
template <class Value>
auto read_all(const tinygltf::Model& model, int accessor, std::initializer_list<int> types, Value value) {
  const std::string place = "accessor " + std::to_string(accessor);
  const tinygltf::Accessor& source = accessor_of(model, accessor, place);
  const bool is_wanted = std::ranges::find(types, source.type) != types.end();
  const Elements elements = elements_of(model, source, is_wanted ? source.type : *types.begin(), place);
  std::vector<decltype(value(elements, source, place, std::size_t{}))> values;
  values.reserve(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) values.push_back(value(elements, source, place, i));
  return values;
}

}  // namespace

std::vector<Vec3> read_positions(const tinygltf::Model& model, int accessor) {
  return read_all(model, accessor, {TINYGLTF_TYPE_VEC3},
                  [](const Elements& elements, const tinygltf::Accessor& source, const std::string& place, std::size_t i) {
                    const auto axis = [&](std::size_t n) { return load_coordinate(elements.at(i, n), source, place); };
                    return Vec3{axis(0), axis(1), axis(2)};
                  });
}

std::vector<TexturePoint> read_texture_points(const tinygltf::Model& model, int accessor) {
  return read_all(model, accessor, {TINYGLTF_TYPE_VEC2},
                  [](const Elements& elements, const tinygltf::Accessor& source, const std::string& place, std::size_t i) {
                    const auto axis = [&](std::size_t n) {
                      return static_cast<float>(load_coordinate(elements.at(i, n), source, place));
                    };
                    return TexturePoint{axis(0), axis(1)};
                  });
}

std::vector<RgbF> read_colours(const tinygltf::Model& model, int accessor) {
  return read_all(model, accessor, {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4},
                  [](const Elements& elements, const tinygltf::Accessor& source, const std::string& place, std::size_t i) {
                    const auto band = [&](std::size_t n) {
                      const double value = load_coordinate(elements.at(i, n), source, place);
                      return value >= 0 ? static_cast<float>(std::min(value, 1.0)) : 0.0F;
                    };
                    return RgbF{band(0), band(1), band(2)};
                  });
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor) {
  return read_all(model, accessor, {TINYGLTF_TYPE_SCALAR},
                  [](const Elements& elements, const tinygltf::Accessor& source, const std::string& place, std::size_t i) {
                    return load_index(elements.at(i), source.componentType, place);
                  });
}

double number_in(const tinygltf::Value& object, const char* name, double otherwise) {
  if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsNumber()) return otherwise;
  return object.Get(name).GetNumberAsDouble();
}

}  // namespace alvor
