#include "tests/random/shrink.h"

#include "tests/scene_changes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace alvor::test {

namespace {

class Shrinker {
 public:
  Shrinker(Trial trial, const std::function<bool(const Trial&)>& fails) : trial_(std::move(trial)), fails_(fails) {}

  Trial run() {
    for (bool has_shrunk = true; has_shrunk;) {
      has_shrunk = drop_faces();
      has_shrunk |= simplify_options();
      has_shrunk |= simplify_materials();
      has_shrunk |= round_coordinates();
      has_shrunk |= drop_unused();
    }
    return trial_;
  }

 private:
  /// Applies `change` to a copy, and keeps the copy if it differs and still fails.
  template <class Change>
  bool attempt(Change&& change) {
    Trial candidate = trial_;
    if (Clock::now() > end_ || !change(candidate) || !fails_(candidate)) return false;
    trial_ = std::move(candidate);
    return true;
  }
  template <class T>
  static bool set(T& value, const T& to) {
    const bool is_new = !(value == to);
    value = to;
    return is_new;
  }

  bool drop_faces() {
    bool any = false;
    for (std::size_t chunk = std::max<std::size_t>(1, trial_.scene.faces.size() / 2); chunk > 0; chunk /= 2)
      for (std::size_t first = 0; first < trial_.scene.faces.size();) {
        const bool dropped = attempt([&](Trial& t) {
          const auto begin = t.scene.faces.begin() + static_cast<std::ptrdiff_t>(first);
          const auto count = std::min(chunk, t.scene.faces.size() - first);
          t.scene.faces.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
          return !t.scene.faces.empty();
        });
        any |= dropped;
        if (!dropped) first += chunk;
      }
    return any;
  }

  bool simplify_options() {
    const SolveOptions plain;
    bool any = attempt([&](Trial& t) { return set(t.options.strategy, plain.strategy); });
    any |= attempt([&](Trial& t) { return set(t.options.form_factors, plain.form_factors); });
    any |= attempt([&](Trial& t) { return set(t.options.min_edge_m, 0.0); });
    any |= attempt([&](Trial& t) { return set(t.options.threads, 1); });
    any |= attempt([&](Trial& t) { return set(t.options.seed, plain.seed); });
    any |= attempt([&](Trial& t) { return set(t.options.tolerance, plain.tolerance); });
    any |= attempt([&](Trial& t) { return set(t.options.max_leaves, std::uint64_t{100}); });
    for (int depth = 0; depth < trial_.options.max_depth; ++depth)
      any |= attempt([&](Trial& t) { return set(t.options.max_depth, depth); });
    return any;
  }

  bool simplify_materials() {
    bool any = attempt([](Trial& t) { return set(t.scene.absorption, Rgb{}); });
    any |= attempt([](Trial& t) { return !std::exchange(t.scene.corner_colours, {}).empty(); });
    for (std::size_t m = 0; m < trial_.scene.materials.size(); ++m) {
      const auto material = [m](Trial& t) -> Material& { return t.scene.materials[m]; };
      const auto is_lit = [&](Trial& t) { return !material(t).emission.is_zero(); };
      any |= attempt([&](Trial& t) { return set(material(t).two_sided, false); });
      any |= attempt([&](Trial& t) { return std::exchange(material(t).texture, std::nullopt).has_value(); });
      any |= attempt([&](Trial& t) { return set(material(t).regular_transmittance, Rgb{}); });
      if (attempt([&](Trial& t) { return set(material(t).emission, Rgb{}); })) any = true;
      else any |= attempt([&](Trial& t) { return is_lit(t) && set(material(t).emission, Rgb{1, 1, 1}); });
      if (attempt([&](Trial& t) { return set(material(t).reflectance, Rgb{}); })) any = true;
      else if (!(trial_.scene.materials[m].reflectance == Rgb{}))
        any |= attempt([&](Trial& t) { return set(material(t).reflectance, Rgb{0.5, 0.5, 0.5}); });
    }
    return any;
  }

  bool round_coordinates() {
    bool any = false;
    for (const double step : {1.0, 0.25, 1e-2, 1e-4})
      for (std::size_t v = 0; v < trial_.scene.vertices.size(); ++v)
        any |= attempt([&](Trial& t) {
          Vec3& at = t.scene.vertices[v];
          const auto rounded = [step](double x) { return std::round(x / step) * step; };
          return set(at, Vec3{rounded(at.x), rounded(at.y), rounded(at.z)}) && at == at;
        });
    return any;
  }

  /// Drops vertices and materials that no face uses, and corners of removed faces.
  bool drop_unused() {
    return attempt([](Trial& t) {
      const Scene before = t.scene;
      Scene& scene = t.scene;
      scene.vertices.clear(), scene.corners.clear(), scene.faces.clear(), scene.materials.clear(), scene.texture_points.clear(),
          scene.corner_colours.clear();
      std::vector<std::uint32_t> vertex(before.vertices.size(), ~0u), material(before.materials.size(), ~0u);
      const auto kept = [](auto& from, auto& to, std::uint32_t n, std::uint32_t& place) {
        if (place == ~0u) place = static_cast<std::uint32_t>(to.size()), to.push_back(from[n]);
        return place;
      };
      for (std::uint32_t f = 0; f < before.faces.size(); ++f) {
        const Face& face = before.faces[f];
        std::vector<std::uint32_t> ring;
        for (const std::uint32_t v : before.corners_of(face)) ring.push_back(kept(before.vertices, scene.vertices, v, vertex[v]));
        scene.add_face(ring, kept(before.materials, scene.materials, face.material, material[face.material]),
                       points_of(before, f), colours_of(before, f));
      }
      return scene.vertices.size() < before.vertices.size() || scene.corners.size() < before.corners.size() ||
             scene.materials.size() < before.materials.size();
    });
  }

  using Clock = std::chrono::steady_clock;
  Clock::time_point end_ = Clock::now() + std::chrono::minutes(1);
  Trial trial_;
  const std::function<bool(const Trial&)>& fails_;
};

}  // namespace

Trial shrunk(Trial trial, const std::function<bool(const Trial&)>& fails) { return Shrinker(std::move(trial), fails).run(); }

}  // namespace alvor::test
