#include "client/verify/emitter_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace alvor {

namespace {

std::array<Vec3, 3> corners_of(const EmittingTriangle& light) {
  return {light.corner, light.corner + light.side_u, light.corner + light.side_v};
}

struct Box {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

  void add(Vec3 p) {
    low = lower(low, p);
    high = upper(high, p);
  }
  Vec3 centre() const { return lerp(low, high, 0.5); }
  double Vec3::*longest_axis() const {
    const Vec3 size = high - low;
    if (size.x >= size.y && size.x >= size.z) return &Vec3::x;
    return size.y >= size.z ? &Vec3::y : &Vec3::z;
  }
};

bool faces(const EmittingTriangle& light, Vec3 point) { return light.two_sided || dot(light.normal, point - light.corner) > 0; }

double power_of(const EmittingTriangle& light) { return light.area * light.emission.sum() * (light.two_sided ? 2 : 1); }

}  // namespace

EmitterTree::EmitterTree(std::vector<EmittingTriangle> lights) : lights_(std::move(lights)), leaf_of_(lights_.size()) {
  if (lights_.empty()) return;
  std::vector<std::uint32_t> order(lights_.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * lights_.size());
  nodes_.emplace_back();
  build(0, order.data(), order.data() + order.size());
}

void EmitterTree::build(std::uint32_t node, std::uint32_t* first, std::uint32_t* last) {
  Box box;
  for (const std::uint32_t* light = first; light != last; ++light) {
    for (const Vec3& corner : corners_of(lights_[*light])) box.add(corner);
    nodes_[node].power += power_of(lights_[*light]);
  }
  nodes_[node].centre = box.centre();
  nodes_[node].radius = 0.5 * length(box.high - box.low);
  if (last - first == 1) {
    nodes_[node].light = *first;
    leaf_of_[*first] = node;
    return;
  }

  const auto axis = box.longest_axis();
  std::uint32_t* middle = first + (last - first) / 2;
  const auto height = [&](std::uint32_t light) {
    return 3 * (lights_[light].corner.*axis) + lights_[light].side_u.*axis + lights_[light].side_v.*axis;
  };
  std::ranges::nth_element(first, middle, last, {}, height);
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first_child = child;
  nodes_.resize(nodes_.size() + 2);
  nodes_[child].parent = nodes_[child + 1].parent = node;
  build(child, first, middle);
  build(child + 1, middle, last);
}

// Returns an estimate of what the lights of a node send to a point. A single light sends nothing to points behind its plane.
double EmitterTree::importance(const Node& node, Vec3 point, Vec3 normal) const {
  const Vec3 towards = node.centre - point;
  const double height = dot(normal, towards) + node.radius;
  if (height <= 0) return 0;
  if (node.first_child == 0 && !faces(lights_[node.light], point)) return 0;
  const double distance = std::sqrt(std::max(dot(towards, towards), node.radius * node.radius));
  return node.power * std::min(height, distance) / (distance * distance * distance);
}

double EmitterTree::first_share(std::uint32_t first_child, Vec3 point, Vec3 normal) const {
  const double first = importance(nodes_[first_child], point, normal);
  const double second = importance(nodes_[first_child + 1], point, normal);
  return first + second > 0 ? first / (first + second) : -1;
}

std::optional<EmitterTree::Choice> EmitterTree::choose(Vec3 point, Vec3 normal, double random) const {
  if (lights_.empty()) return std::nullopt;
  double probability = 1;
  std::uint32_t node = 0;
  while (const std::uint32_t child = nodes_[node].first_child) {
    const double share = first_share(child, point, normal);
    if (share < 0) return std::nullopt;
    const bool is_first = random < share;
    const double chance = is_first ? share : 1 - share;
    random = std::min((is_first ? random : random - share) / chance, 0x1.fffffffffffffp-1);
    probability *= chance;
    node = is_first ? child : child + 1;
  }
  return Choice{nodes_[node].light, probability, random};
}

double EmitterTree::probability(Vec3 point, Vec3 normal, std::uint32_t light) const {
  double probability = 1;
  for (std::uint32_t node = leaf_of_[light]; node != 0; node = nodes_[node].parent) {
    const bool is_first = node % 2 == 1;
    const double share = first_share(is_first ? node : node - 1, point, normal);
    probability *= share < 0 ? 0 : is_first ? share : 1 - share;
  }
  return probability;
}

}  // namespace alvor
