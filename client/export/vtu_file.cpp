#include "client/export/vtu_file.h"

#include "meshing/face_object.h"
#include "client/picture/units.h"
#include "import/base/bytes.h"

#include <cstdint>

namespace alvor {

namespace {

constexpr std::uint8_t vtk_triangle = 5;

/// The XML of a file, and the binary data to which it points.
class VtuWriter {
 public:
  void text(const std::string& xml) { xml_ += xml; }

  /// Adds an array. Its bytes follow their number.
  template <class T>
  void array(const std::string& name, const char* type, int components, const std::vector<T>& values) {
    xml_ += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
            std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data_.size()) + "\"/>\n";
    append_value(data_, static_cast<std::uint64_t>(values.size() * sizeof(T)));
    for (const T& value : values) append_value(data_, value);
  }

  std::string file() const { return xml_ + "<AppendedData encoding=\"raw\">\n_" + data_ + "\n</AppendedData>\n</VTKFile>\n"; }

 private:
  std::string xml_, data_;
};

std::vector<float> bands_of(const std::vector<RgbF>& values) {
  std::vector<float> bands;
  bands.reserve(3 * values.size());
  for (const RgbF& value : values) bands.insert(bands.end(), {value.r, value.g, value.b});
  return bands;
}

std::vector<double> coordinates_of(const DisplayMesh& mesh) {
  std::vector<double> coordinates;
  coordinates.reserve(3 * mesh.positions.size());
  for (const Vec3& p : mesh.positions) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  return coordinates;
}

void add_points(const DisplayMesh& mesh, VtuWriter& out) {
  out.text("<PointData Scalars=\"irradiance\">\n");
  out.array("irradiance", "Float32", 3, bands_of(mesh.irradiance));
  out.array("radiosity", "Float32", 3, bands_of(mesh.radiosity));
  if (!mesh.errors.empty()) out.array("error", "Float32", 1, mesh.errors);
  out.text("</PointData>\n<Points>\n");
  out.array("points", "Float64", 3, coordinates_of(mesh));
  out.text("</Points>\n");
}

void add_cell_data(const DisplayMesh& mesh, VtuWriter& out) {
  std::vector<std::int32_t> faces, materials, objects;
  for (const FaceTriangles& run : mesh.faces) {
    faces.insert(faces.end(), run.count, static_cast<std::int32_t>(run.faces.first));
    materials.insert(materials.end(), run.count, static_cast<std::int32_t>(run.material));
    const auto object = object_of_face(mesh.objects, run.faces.first);
    objects.insert(objects.end(), run.count, object ? static_cast<std::int32_t>(*object) : -1);
  }
  for (auto* list : {&faces, &materials, &objects}) list->resize(mesh.triangles.size(), -1);
  out.text("<CellData>\n");
  out.array("face", "Int32", 1, faces);
  out.array("material", "Int32", 1, materials);
  out.array("object", "Int32", 1, objects);
  if (!mesh.errors.empty()) {
    std::vector<float> errors;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      errors.push_back(static_cast<float>(error_at(mesh, t, 1.0 / 3, 1.0 / 3)));
    out.array("error", "Float32", 1, errors);
  }
  out.text("</CellData>\n");
}

void add_cells(const DisplayMesh& mesh, VtuWriter& out) {
  std::vector<std::int64_t> corners, ends;
  for (const auto& triangle : mesh.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  out.text("<Cells>\n");
  out.array("connectivity", "Int64", 1, corners);
  out.array("offsets", "Int64", 1, ends);
  out.array("types", "UInt8", 1, std::vector<std::uint8_t>(mesh.triangles.size(), vtk_triangle));
  out.text("</Cells>\n");
}

}  // namespace

std::string encode_vtu(const DisplayMesh& mesh) {
  VtuWriter out;
  out.text("<?xml version=\"1.0\"?>\n<!-- Alvor solution: metres, " + std::string(irradiance_unit(mesh.quantity)) +
           " -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
           "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
           std::to_string(mesh.positions.size()) + "\" NumberOfCells=\"" + std::to_string(mesh.triangles.size()) + "\">\n");
  add_points(mesh, out);
  add_cell_data(mesh, out);
  add_cells(mesh, out);
  out.text("</Piece>\n</UnstructuredGrid>\n");
  return out.file();
}

}  // namespace alvor
