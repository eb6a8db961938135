#pragma once
// Reads form_factors.csv: exact form factors of many geometries.

#include "meshing/scene.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace alvor::test {

using Polygon = std::vector<Vec3>;

struct ReferenceFormFactor {
  std::string name, kind, parameters;
  double value = 0, uncertainty = 0;
  Polygon from, to;
  std::vector<Polygon> blockers;

  /// Returns a number of the parameters: number("r1=") of "r1=2 r2=1" is 2.
  double number(const std::string& key) const { return std::stod(parameters.substr(parameters.find(key) + key.size())); }
  bool has_polygons() const { return from.size() > 2; }
};

inline std::vector<std::string> split(const std::string& text, char between) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, between);) parts.push_back(part);
  return parts;
}

inline Polygon polygon_of(const std::string& text) {
  Polygon polygon;
  for (const std::string& corner : split(text, ';')) {
    Vec3 p;
    if (std::sscanf(corner.c_str(), "%lf %lf %lf", &p.x, &p.y, &p.z) == 3) polygon.push_back(p);
  }
  return polygon;
}

inline std::vector<ReferenceFormFactor> read_reference_form_factors(const std::filesystem::path& path) {
  std::vector<ReferenceFormFactor> rows;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);  // skips the header
  while (std::getline(in, line)) {
    auto cells = split(line, ',');
    cells.resize(10);
    ReferenceFormFactor row{
        cells[0], cells[1], cells[2], std::stod(cells[3]), std::stod(cells[4]), polygon_of(cells[6]), polygon_of(cells[7]), {}};
    for (const std::string& blocker : split(cells[8], '/')) row.blockers.push_back(polygon_of(blocker));
    rows.push_back(row);
  }
  return rows;
}

/// Returns a scene whose face 0 is `from` and face 1 `to`; the blockers follow.
inline Scene scene_of(const ReferenceFormFactor& row) {
  Scene scene;
  scene.materials.emplace_back();
  scene.add_polygon(row.from, 0);
  scene.add_polygon(row.to, 0);
  for (const Polygon& blocker : row.blockers) scene.add_polygon(blocker, 0);
  return scene;
}

}  // namespace alvor::test
