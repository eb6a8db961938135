#pragma once
// A glTF 2.0 file that is read to be changed: its JSON with everything that is in it, and all of its binary data in one buffer.

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// Thrown where a file cannot be baked. what() is "place: reason", without the file's name.
struct BakeError : std::runtime_error {
  using std::runtime_error::runtime_error;
  BakeError(const std::string& place, const std::string& reason) : std::runtime_error(place + ": " + reason) {}
};

/// Returns the bytes of a file that the document names; nothing if there is none.
using FileFinder = std::function<std::optional<std::string>(const std::string& name)>;

/// Elements of an accessor without gaps between them.
struct DenseElements {
  std::string bytes;
  std::size_t count = 0;
  std::size_t element_size = 0;  ///< bytes

  std::string_view at(std::size_t index) const { return std::string_view(bytes).substr(index * element_size, element_size); }
};

class GltfDocument {
 public:
  /// Reads a .gltf or .glb file. Buffers and images outside it are taken into the one buffer, so that it stands alone. Throws
  /// BakeError, also for what is beyond GLB's 4 GB.
  GltfDocument(std::string_view bytes, const FileFinder& find);
  /// Begins an empty document.
  GltfDocument();

  nlohmann::json& root() { return root_; }
  const nlohmann::json& root() const { return root_; }

  /// Returns an element of one of the root's lists: element("meshes", 3). Throws BakeError if there is none.
  const nlohmann::json& element(const char* list, std::size_t index) const;
  /// Appends to one of the root's lists and returns the index.
  std::size_t append(const char* list, nlohmann::json element);

  /// Returns all elements of an accessor, the sparse ones put in their places. Throws BakeError if it is not within its buffer.
  DenseElements read(std::size_t accessor) const;
  /// Returns the elements of a FLOAT or normalised VEC3 accessor. Throws BakeError.
  std::vector<std::array<float, 3>> read_positions(std::size_t accessor) const;
  /// Returns the elements of a FLOAT or normalised VEC2 accessor. Throws BakeError.
  std::vector<std::array<float, 2>> read_points(std::size_t accessor) const;
  /// Returns the elements of a FLOAT or normalised VEC3 or VEC4 accessor; opacity 1 if it has none. Throws BakeError.
  std::vector<std::array<float, 4>> read_colours(std::size_t accessor) const;
  /// Returns the elements of an unsigned SCALAR accessor. Throws BakeError.
  std::vector<std::uint32_t> read_indices(std::size_t accessor) const;

  /// Appends an accessor like `like` whose elements are `bytes`. `target`: 34962 for vertices, 34963 for indices.
  std::size_t add_accessor(nlohmann::json like, std::string_view bytes, std::size_t count, int target);
  /// Appends an accessor of vertices like that of number `accessor`, with its bounds: `bytes` are elements of it or lie between
  /// them.
  std::size_t add_accessor_like(std::size_t accessor, std::string_view bytes, std::size_t count);
  /// Appends an accessor of the vertices of triangles.
  std::size_t add_indices(std::span<const std::array<std::uint32_t, 3>> triangles);
  /// Appends the bytes of a PNG file as an image; returns its index.
  std::size_t add_png(std::string_view bytes, const std::string& name);

  /// Adds a name to "extensionsUsed", once.
  void use_extension(const char* name);

  /// Adds a member to the file's extras, see add_extra_to().
  void add_extra(const std::string& name, nlohmann::json extra);

  /// Returns the bytes of the GLB file. Throws BakeError if it would have 4 GB or more.
  std::string encode() const;

 private:
  template <std::size_t size>
  std::vector<std::array<float, size>> read_vectors(std::size_t accessor, const char* type) const;
  void take_in_buffers(const FileFinder& find, std::optional<std::string_view> chunk);
  void take_in_images(const FileFinder& find);
  std::size_t add_view(std::string_view bytes, std::optional<int> target);
  std::string_view view(std::size_t index, std::size_t& stride) const;

  nlohmann::json root_;
  std::string binary_;
};

/// Adds a member to the "extras" of a part of a file. Extras that are no object become the member "extras" of one.
void add_extra_to(nlohmann::json& part, const std::string& name, nlohmann::json extra);

/// Takes from a primitive what says that its old vertices are compressed, as it has new ones.
void drop_compression(nlohmann::json& primitive);

/// Returns whether a value is a whole number not below 0.
bool is_index(const nlohmann::json& value);
/// Returns a member that is a whole number not below 0; `otherwise` if it is missing. Throws BakeError that names `place`.
std::size_t index_in(const nlohmann::json& object, const char* name, const std::string& place,
                     std::optional<std::size_t> otherwise = std::nullopt);

}  // namespace alvor
