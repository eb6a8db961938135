#pragma once
// Form factors that are known in closed form, free of cancellation for extreme shapes. All functions return F_12 in [0, 1].
// Lengths are in one unit, > 0.

namespace alvor {

/// Returns the form factor from a disk of radius `r1` to a coaxial parallel disk of radius `r2` at `distance` (Howell, catalogue
/// C-41).
double coaxial_disks(double r1, double r2, double distance);

/// Returns the form factor between two opposed rectangles a x b at `distance`, edges parallel and corners above corners (Howell
/// C-11).
double opposed_rectangles(double a, double b, double distance);

/// Returns the form factor between two perpendicular rectangles that share an edge of length `common`, from the one of depth
/// `from` to the one of depth `to` (Howell C-14).
double perpendicular_rectangles(double from, double to, double common);

}  // namespace alvor
