#pragma once
// The report about the lighting of a scene: what is computed, and the files that it is written to.

#include "client/picture/png_file.h"
#include "client/report/glare.h"
#include "client/report/illuminance.h"
#include "client/report/luminaire_list.h"
#include "client/report/rooms.h"
#include "client/verify/verification.h"

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace alvor {

struct ReportOptions {
  PlaneHeights heights;
  double border = 0.5;              ///< metres from the walls that are not assessed; at most 15 % of a room's local width
  std::optional<double> spacing;    ///< largest distance of grid points, metres; empty: that of EN 12464-1
  double maintenance_factor = 1;    ///< by which illuminances of the report are those of the solution, in (0, 1]
  std::vector<Observer> observers;  ///< whose glare is computed; empty: four of each room, who look across it
  Rgb absorption;                   ///< of a medium that fills the scene, 1/m per band
};

/// An observer, and the glare that is seen.
struct ObservedGlare {
  Observer observer;
  std::optional<Glare> glare;  ///< empty inside a solid
};

/// Daylight factors of a room: shares of the light of an open horizontal surface under an overcast sky (EN 17037).
struct DaylightFactors {
  std::vector<std::optional<double>> at_points;  ///< of the grid
  double mean = 0, minimum = 0;
  double median = 0;         ///< reached on half of the points
  double on_95_percent = 0;  ///< reached on 95 % of the points
};

struct RoomReport {
  Room room;
  WorkGrid grid;
  std::vector<PointLight> light;                           ///< at the grid's points
  std::optional<PlaneStatistics> horizontal, cylindrical;  ///< nothing if all points are inside solids
  RoomPower power;
  std::vector<ObservedGlare> glare;  ///< photometric solutions only
  std::optional<DaylightFactors> daylight;

  /// Returns the illuminance on the work plane at each point of the grid.
  std::vector<std::optional<double>> horizontal_values() const;
};

struct Report {
  std::string title;
  std::string source;  ///< whence the report comes: file, date and program, one line; may be empty
  Quantity quantity = Quantity::radiometric;
  ReportOptions options;
  std::vector<RoomReport> rooms;
  std::vector<LuminaireType> luminaires;
  std::vector<EmittingMaterial> emitting;
  std::vector<SurfaceMaterial> surfaces;     ///< the largest first
  bool has_distant_light = false;            ///< a sun, a sky or an environment shines
  std::optional<double> told_error;          ///< told relative error of the solution
  std::optional<Verification> verification;  ///< by path tracing, if it was made
  std::vector<std::string> remarks;          ///< one sentence each
  std::vector<std::string> plans;            ///< isolux pictures by room, PNG
};

/// Thrown where a report cannot be made. what() is one line.
struct ReportError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A solution of the same scene under an overcast sky, without other light.
struct DaylightSolution {
  const DisplayMesh& mesh;
  double outside = 0;  ///< irradiance of an open horizontal surface, > 0
};

/// Returns the rooms that a report of these surfaces is about; their light does not matter, so that this can be asked before a
/// solve. Throws ReportError if there is no floor, or the grid is too fine.
std::vector<Room> find_rooms(const DisplayMesh& mesh, const ReportOptions& options);

/// Computes a report of rooms from a solution of their surfaces. Uses all cores; the same arguments give the same report. Title
/// and verification are left to the caller. Requires: find_rooms() returned the rooms, for the same surfaces and options.
Report make_report(const DisplayMesh& mesh, std::span<const Room> rooms, const ReportOptions& options,
                   const std::optional<DaylightSolution>& overcast = std::nullopt);

/// Returns the report as one JSON object.
std::string report_json(const Report& report);
/// Returns a CSV text with a header and one line per room.
std::string rooms_csv(const Report& report);
/// Returns a CSV text with a header and one line per point of all grids.
std::string points_csv(const Report& report);
/// Returns a page that needs no other file, in HTML.
std::string report_page(const Report& report);

}  // namespace alvor
