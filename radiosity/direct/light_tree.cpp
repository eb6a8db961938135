#include "radiosity/direct/light_tree.h"

#include <algorithm>
#include <cassert>
#include <numbers>

namespace alvor {

namespace {

// A cluster whose bound is below this share of the sum of all bounds is sampled, not computed one by one. Chosen; not measured.
constexpr double small_share = 0.02;
// Most emitters that one receiver computes one by one. Chosen; not measured.
constexpr std::size_t most_single = 48;

Vec3 lower(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 upper(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

double along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Returns the largest dot(direction, p) over the points p of the box.
double reach(Vec3 low, Vec3 high, Vec3 direction) {
  return std::max(direction.x * low.x, direction.x * high.x) + std::max(direction.y * low.y, direction.y * high.y) +
         std::max(direction.z * low.z, direction.z * high.z);
}

}  // namespace

LightTree::LightTree(const LocalScene& scene, std::span<const Emitter> emitters) : scene_(scene), emitters_(emitters) {
  std::vector<std::uint32_t> all(emitters.size());
  for (std::uint32_t e = 0; e < all.size(); ++e) all[e] = e;
  nodes_.reserve(2 * all.size());
  nodes_.emplace_back();
  if (!all.empty()) build(0, all);
}

void LightTree::build(std::uint32_t node, std::span<std::uint32_t> emitters) {
  if (emitters.size() > 1) return split(node, emitters);
  const Emitter& emitter = emitters_[emitters[0]];
  const auto corners = scene_.corners(emitter.root);
  const double scale = scene_.frame().metres_per_unit;
  Node leaf{
      corners[0], corners[0], scene_.mesh().roots()[emitter.root].normal, emitter.power / (scale * scale), emitter.emission.sum(),
      0,          emitters[0]};
  for (const Vec3 corner : corners) leaf.low = lower(leaf.low, corner), leaf.high = upper(leaf.high, corner);
  nodes_[node] = leaf;
}

void LightTree::split(std::uint32_t node, std::span<std::uint32_t> emitters) {
  const auto place = [&](std::uint32_t e) { return scene_.corners(emitters_[e].root)[0]; };
  Vec3 low = place(emitters[0]), high = low;
  for (const std::uint32_t e : emitters) low = lower(low, place(e)), high = upper(high, place(e));
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = emitters.size() / 2;
  std::ranges::nth_element(emitters, emitters.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [&](std::uint32_t e) { return along(place(e), axis); });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  build(left, emitters.first(half));
  build(left + 1, emitters.subspan(half));
  const Node &a = nodes_[left], &b = nodes_[left + 1];
  const bool is_parallel = dot(a.normal, b.normal) > 1 - 1e-9;
  nodes_[node] = {lower(a.low, b.low),
                  upper(a.high, b.high),
                  is_parallel ? a.normal : Vec3{},
                  a.power + b.power,
                  std::max(a.emission, b.emission),
                  left,
                  0};
}

double LightTree::bound(std::uint32_t node, Vec3 centre, double radius, Vec3 normal) const {
  const Node& n = nodes_[node];
  const double above = reach(n.low, n.high, normal) - dot(centre, normal) + radius;
  const double before = dot(centre, n.normal) + reach(n.low, n.high, -n.normal) + radius;
  const bool faces_away = dot(n.normal, n.normal) > 0 && before <= 0;
  if (above <= 0 || faces_away) return 0;
  const Vec3 outside = upper(upper(n.low - centre, centre - n.high), Vec3{});
  const double distance = std::max(0.0, length(outside) - radius), squared = distance * distance;
  const double cosines = std::min(1.0, above / std::max(distance, 1e-12)) *
                         (dot(n.normal, n.normal) > 0 ? std::min(1.0, before / std::max(distance, 1e-12)) : 1);
  return n.power * cosines < n.emission * std::numbers::pi * squared ? n.power * cosines / (std::numbers::pi * squared)
                                                                     : n.emission;
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
      choice.single.push_back(node.emitter);
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
  return {nodes_[node].emitter, probability};
}

}  // namespace alvor
