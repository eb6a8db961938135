#include "server/archive/content.h"

#include "server/archive/database.h"

namespace alvor {

namespace {

/// Each chunk counts with its length, so that other cuts of the same bytes have another sum.
void add_chunk(std::span<const std::byte> chunk, Sha256& sum) {
  sum.add(std::to_string(chunk.size()) + ":");
  sum.add({reinterpret_cast<const char*>(chunk.data()), chunk.size()});
}

}  // namespace

void for_each_chunk(const Scene& scene, const std::function<void(std::span<const std::byte>)>& body) {
  SceneSlicer slicer(scene);
  for (v1::GeometryChunk chunk; slicer.next(chunk);) {
    const std::string bytes = chunk.SerializeAsString();
    body(std::as_bytes(std::span(bytes)));
  }
}

SceneBytes measure(const Scene& scene) {
  Sha256 sum;
  std::uint64_t bytes = 0;
  for_each_chunk(scene, [&](std::span<const std::byte> chunk) {
    add_chunk(chunk, sum);
    bytes += chunk.size();
  });
  return {sum.digits(), bytes};
}

StatusError damaged_content(const std::string& why) { return data_loss("a scene's content: " + why); }

void ContentReader::add(std::span<const std::byte> chunk) {
  add_chunk(chunk, sum_);
  v1::GeometryChunk message;
  if (!message.ParseFromArray(chunk.data(), static_cast<int>(chunk.size()))) throw damaged_content("is damaged");
  if (const auto fault = assembler_.add(message)) throw damaged_content(fault->text());
}

Scene ContentReader::take(const std::string& sha256) {
  if (sum_.digits() != sha256) throw damaged_content("is not what was stored");
  return assembler_.take();
}

}  // namespace alvor
