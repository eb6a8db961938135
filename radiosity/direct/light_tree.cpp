#include "radiosity/direct/light_tree.h"

#include <algorithm>
#include <cassert>
#include <numbers>

namespace alvor {

namespace {

// A cluster whose bound is below this share of the sum of all bounds is sampled, not computed one by one. Chosen; half: error
// same, rays +2 %, double: error same, rays -2 % (docs/design/constants.md).
constexpr double small_share = 0.02;
// Most lights that one receiver computes one by one. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::size_t most_single = 48;

double along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Returns the largest dot(direction, p) over the points p of the box.
double reach(Vec3 low, Vec3 high, Vec3 direction) {
  return std::max(direction.x * low.x, direction.x * high.x) + std::max(direction.y * low.y, direction.y * high.y) +
         std::max(direction.z * low.z, direction.z * high.z);
}

}  // namespace

LightTree::LightTree(LightSources lights) : lights_(lights) {
  std::vector<std::uint32_t> all(lights.size());
  std::vector<LightExtent> extents;
  for (std::uint32_t l = 0; l < all.size(); ++l) {
    all[l] = l;
    const auto extent = lights[l]->extent();
    assert(extent);
    extents.push_back(*extent);
  }
  nodes_.reserve(2 * all.size());
  nodes_.emplace_back();
  if (!all.empty()) build(0, all, extents);
}

void LightTree::build(std::uint32_t node, std::span<std::uint32_t> lights, std::span<const LightExtent> extents) {
  if (lights.size() > 1) return split(node, lights, extents);
  nodes_[node] = {extents[lights[0]], 0, lights[0]};
}

void LightTree::split(std::uint32_t node, std::span<std::uint32_t> lights, std::span<const LightExtent> extents) {
  Vec3 low = extents[lights[0]].place, high = low;
  for (const std::uint32_t l : lights) low = lower(low, extents[l].place), high = upper(high, extents[l].place);
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = lights.size() / 2;
  std::ranges::nth_element(lights, lights.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [&](std::uint32_t l) { return along(extents[l].place, axis); });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  build(left, lights.first(half), extents);
  build(left + 1, lights.subspan(half), extents);
  const LightExtent &a = nodes_[left].extent, &b = nodes_[left + 1].extent;
  const bool is_parallel = dot(a.normal, b.normal) > 1 - 1e-9;
  nodes_[node] = {{a.place, lower(a.low, b.low), upper(a.high, b.high), is_parallel ? a.normal : Vec3{}, a.power + b.power,
                   std::max(a.brightest, b.brightest)},
                  left,
                  0};
}

double LightTree::bound(std::uint32_t node, Vec3 centre, double radius, Vec3 normal) const {
  const LightExtent& n = nodes_[node].extent;
  const double above = reach(n.low, n.high, normal) - dot(centre, normal) + radius;
  const double before = dot(centre, n.normal) + reach(n.low, n.high, -n.normal) + radius;
  const bool faces_away = dot(n.normal, n.normal) > 0 && before <= 0;
  if (above <= 0 || faces_away) return 0;
  const Vec3 outside = upper(upper(n.low - centre, centre - n.high), Vec3{});
  const double distance = std::max(0.0, length(outside) - radius), squared = distance * distance;
  const double cosines = std::min(1.0, above / std::max(distance, 1e-12)) *
                         (dot(n.normal, n.normal) > 0 ? std::min(1.0, before / std::max(distance, 1e-12)) : 1);
  return n.power * cosines < n.brightest * std::numbers::pi * squared ? n.power * cosines / (std::numbers::pi * squared)
                                                                      : n.brightest;
}

LightChoice LightTree::choose(Vec3 centre, double radius, Vec3 normal) const {
  LightChoice choice;
  auto& heap = choice.rest;
  const auto weaker = [](const LightChoice::Cluster& a, const LightChoice::Cluster& b) { return a.bound < b.bound; };
  double sum = 0;
  const auto add = [&](std::uint32_t node) {
    const double b = bound(node, centre, radius, normal);
    if (b <= 0) return;
    heap.push_back({node, b});
    std::ranges::push_heap(heap, weaker);
    choice.rest_bound += b;
  };
  add(0);
  while (!heap.empty() && choice.single.size() < most_single && heap.front().bound > small_share * (sum + choice.rest_bound)) {
    std::ranges::pop_heap(heap, weaker);
    const LightChoice::Cluster top = heap.back();
    heap.pop_back();
    choice.rest_bound -= top.bound;
    const Node& node = nodes_[top.node];
    if (node.left != 0) {
      add(node.left);
      add(node.left + 1);
    } else {
      choice.single.push_back(node.light);
      sum += top.bound;
    }
  }
  choice.rest_bound = 0;
  for (const LightChoice::Cluster& cluster : heap) choice.rest_bound += cluster.bound;
  return choice;
}

LightTree::Drawn LightTree::draw(const LightChoice& choice, Vec3 centre, double radius, Vec3 normal, RandomStream& random) const {
  assert(choice.rest_bound > 0);
  double x = random.next() * choice.rest_bound;
  std::size_t c = 0;
  while (c + 1 < choice.rest.size() && x >= choice.rest[c].bound) x -= choice.rest[c++].bound;
  std::uint32_t node = choice.rest[c].node;
  double probability = choice.rest[c].bound / choice.rest_bound;
  while (nodes_[node].left != 0) {
    const std::uint32_t left = nodes_[node].left;
    const double a = bound(left, centre, radius, normal), b = bound(left + 1, centre, radius, normal);
    if (a + b <= 0) return {};
    const bool goes_left = random.next() * (a + b) < a;
    probability *= (goes_left ? a : b) / (a + b);
    node = goes_left ? left : left + 1;
  }
  return {nodes_[node].light, probability};
}

}  // namespace alvor
