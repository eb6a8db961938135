#include "server/solves/solve_order.h"

#include "proto/codec.h"
#include "server/archive/content.h"
#include "solution/plain_bytes.h"

#include <stdexcept>
#include <type_traits>

namespace alvor {

namespace {

/// Calls visit(member) for all members that say what is solved: not for the pause between steps.
template <class Options, class Visit>
void for_each_member(Options& options, Visit&& visit) {
  visit(options.tolerance);
  visit(options.area_share);
  visit(options.max_depth);
  visit(options.max_leaves);
  visit(options.min_edge_m);
  visit(options.time_limit_s);
  visit(options.threads);
  visit(options.seed);
  visit(options.strategy);
  visit(options.form_factors);
  visit(options.parts);
  visit(options.forced_on);
}

void put(std::span<const std::byte> bytes, PlainWriter& out) {
  out.put(std::uint64_t{bytes.size()});
  out.put_bytes(bytes);
}

void put(const SolveOptions& options, PlainWriter& out) {
  for_each_member(options, [&](const auto& member) { out.put_bytes(std::as_bytes(std::span(&member, 1))); });
  out.put(std::uint64_t{options.objects.size()});
  for (const std::string& name : options.objects) put(std::as_bytes(std::span(name)), out);
}

SolveOptions get_options(PlainReader& in) {
  SolveOptions options;
  for_each_member(options, [&](auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (std::is_enum_v<Member>) member = static_cast<Member>(in.get<std::underlying_type_t<Member>>());
    else member = in.get<Member>();
  });
  for (auto names = in.get<std::uint64_t>(); names > 0; --names) {
    const auto name = in.get_all<char>();
    options.objects.emplace_back(name.begin(), name.end());
  }
  return options;
}

void put(const Scene& scene, PlainWriter& out) {
  for_each_chunk(scene, [&](std::span<const std::byte> chunk) { put(chunk, out); });
  put(std::span<const std::byte>(), out);
}

Scene get_scene(PlainReader& in) {
  SceneAssembler assembler;
  for (auto bytes = in.get_all<char>(); !bytes.empty(); bytes = in.get_all<char>()) {
    v1::GeometryChunk chunk;
    if (!chunk.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())) || assembler.add(chunk))
      throw std::runtime_error("the scene from the first rank cannot be read");
  }
  return assembler.take();
}

}  // namespace

std::vector<std::byte> bytes_of_order(const SolveOptions& options, std::span<const std::byte> checkpoint, const Scene& submitted,
                                      const Scene* edited, const AddedScenes& added) {
  return plain_bytes([&](PlainWriter& out) {
    put(options, out);
    put(checkpoint, out);
    put(submitted, out);
    out.put(std::uint8_t{edited != nullptr});
    if (edited) put(*edited, out);
    out.put(std::uint64_t{added.size()});
    for (const auto& [name, scene] : added) {
      out.put_all(std::span(name));
      put(*scene, out);
    }
  });
}

SolveOrder read_order(std::span<const std::byte> bytes) {
  PlainReader in(bytes);
  SolveOrder order;
  order.options = get_options(in);
  order.checkpoint = in.get_all<char>();
  order.submitted = get_scene(in);
  if (in.get<std::uint8_t>() != 0) order.edited = get_scene(in);
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    const auto name = in.get_all<char>();
    order.added[std::string(name.begin(), name.end())] = std::make_shared<const Scene>(get_scene(in));
  }
  return order;
}

}  // namespace alvor
