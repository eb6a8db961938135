#pragma once
// Solves on a server that are edited.

#include "client/rpc/client.h"
#include "meshing/patch_place.h"
#include "proto/codec.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/server/alvord_process.h"
#include "tests/server/refusal.h"
#include "tests/server/test_server.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace alvor::test {

inline v1::EditStep recolour(const std::string& material, double r, double g, double b) {
  v1::EditStep step;
  v1::MaterialEdit& edit = *step.add_edits()->mutable_material();
  edit.set_name(material);
  *edit.mutable_reflectance() = encode(Rgb{r, g, b});
  return step;
}

inline v1::EditStep dim_light(const std::string& light, double dim) {
  v1::EditStep step;
  step.add_edits()->mutable_light()->set_name(light);
  step.mutable_edits(0)->mutable_light()->set_dim(dim);
  return step;
}

inline v1::EditStep moved(const std::string& object, double x, double y, double z) {
  v1::EditStep step;
  step.add_edits()->mutable_object()->set_name(object);
  v1::Vector3& move = *step.mutable_edits(0)->mutable_object()->mutable_move();
  move.set_x(x), move.set_y(y), move.set_z(z);
  return step;
}

inline v1::EditStep copied(const std::string& name, const std::string& of, double x, double y, double z) {
  v1::EditStep step = moved(name, x, y, z);
  v1::ObjectCopy& copy = *step.add_edits()->mutable_copy();
  copy.set_name(name);
  copy.set_of(of);
  return step;
}

inline v1::EditStep undo() {
  v1::EditStep step;
  step.set_kind(v1::EditStep::UNDO);
  return step;
}
inline v1::EditStep redo() {
  v1::EditStep step;
  step.set_kind(v1::EditStep::REDO);
  return step;
}

/// Returns a room whose materials, lights and objects have names: the block on the floor, and two lamps of one material.
inline Scene room() {
  Scene scene = room_with_lamps_and_sun();
  for (std::size_t n = 0; n < scene.materials.size(); ++n) scene.materials[n].name = "m" + std::to_string(n);
  const auto first = static_cast<std::uint32_t>(scene.faces.size());
  add_polygon(scene, {{0.2, 2.9, 0.2}, {0.6, 2.9, 0.2}, {0.6, 2.9, 0.6}, {0.2, 2.9, 0.6}}, 1);
  add_polygon(scene, {{3.2, 2.9, 0.2}, {3.6, 2.9, 0.2}, {3.6, 2.9, 0.6}, {3.2, 2.9, 0.6}}, 1);
  for (std::uint32_t n = 0; n < 2; ++n) {
    SceneObject lamp;
    lamp.name = "lamp." + std::to_string(n);
    lamp.first_face = first + n;
    lamp.face_count = 1;
    scene.objects.push_back(lamp);
  }
  return scene;
}

inline v1::SolveSpec coarse() {
  v1::SolveSpec spec;
  spec.set_tolerance(0.1);
  spec.set_max_elements(3000);
  return spec;
}

inline ServiceOptions live_options() {
  ServiceOptions options;
  options.solves.keeping.keeps_live = true;
  return options;
}

inline double mean(const Scene& scene, const std::vector<LeafValue>& leaves) {
  const BaseMesh mesh(scene);
  double sum = 0, area = 0;
  for (const LeafValue& leaf : leaves) {
    const double own = area_of(mesh, shape_of(mesh, leaf.patch));
    sum += own * leaf.irradiance.mean();
    area += own;
  }
  return sum / area;
}

class EditingTest : public testing::Test {
 protected:
  EditingTest() {
    scene_name = client.create_scene(room(), "").name();
    solve = client.create_solve(scene_name, coarse()).name();
    end();
  }
  /// Waits for the end of the solve and returns its leaves.
  std::vector<LeafValue> end() {
    Client::Watch watch;
    last = client.watch_solve(solve, watch, [](auto&) {});
    return watch.mirror.leaves();
  }
  std::string refusal(const v1::EditStep& step, std::optional<std::uint64_t> base = std::nullopt) {
    return error_of([&] { client.edit_solve(solve, step, base); });
  }

  TestServer server{live_options()};
  Client client{server.channel()};
  std::string scene_name, solve;
  v1::Solve last;
};

class KeptEditsTest : public testing::Test {
 protected:
  KeptEditsTest() { std::filesystem::remove_all(directory); }
  ~KeptEditsTest() override { std::filesystem::remove_all(directory); }
  std::vector<std::string> arguments() const {
    return {"--listen", "127.0.0.1:0", "--data", directory.string(), "--checkpoint-interval", "0.05"};
  }
  static Client client_of(Alvord& alvord) {
    return Client(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
  }
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() /
      ("alvor_edits_" + std::to_string(getpid()) + "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace alvor::test
