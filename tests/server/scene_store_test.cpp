#include "server/scenes/scene_store.h"

#include "server/scenes/scene_upload.h"
#include "tests/server/refusal.h"
#include "tests/server/sample_scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

TEST(SceneStore, TellsWhatIsOdd) {
  SceneStore store;
  Scene scene = squares(2);
  scene.materials[0].emission = {};
  scene.add_face(std::array<std::uint32_t, 3>{0, 0, 1}, 0);
  const auto facts = store.add(scene, "dim")->facts;
  EXPECT_EQ(facts.display_name, "dim");
  EXPECT_EQ(facts.face_count, 3u);
  ASSERT_EQ(facts.warnings.size(), 2u);
  EXPECT_EQ(facts.warnings[0], "1 degenerate faces (no area) were left out.");
  EXPECT_EQ(facts.warnings[1], "No face emits light, and there are no lamps: the solution will be dark.");
}

TEST(SceneStore, TellsWhatIsInAScene) {
  SceneStore store;
  Scene scene = squares(2);
  scene.objects = {{"first", std::nullopt, {}, 0, 1}, {"second", 0, {}, 1, 1}};
  scene.lights = {{"bulb", LightKind::point, {1, 1, 1}, {0, 5, 0}}};
  scene.quantity = Quantity::photometric;
  scene.up = UpAxis::z;
  scene.north_degrees = -20;
  const auto facts = store.add(scene, "")->facts;
  EXPECT_EQ(facts.object_count, 2u);
  EXPECT_EQ(facts.light_count, 1u);
  EXPECT_EQ(facts.quantity, Quantity::photometric);
  EXPECT_EQ(facts.up, UpAxis::z);
  EXPECT_EQ(facts.north_degrees, -20);
}

TEST(SceneStore, TakesAReflectanceOfOneForAsMuchAsSurfacesHaveAndSaysSo) {
  SceneStore store;
  Scene scene = squares(1);
  scene.materials[0].name = "chalk";
  scene.materials[0].reflectance = {1, 0.5, 1};
  const auto stored = store.add(scene, "");
  EXPECT_EQ(stored->content()->mesh.material_of(0).reflectance, (Rgb{0.95, 0.5, 0.95}));
  ASSERT_EQ(stored->facts.warnings.size(), 1u);
  EXPECT_EQ(stored->facts.warnings[0], "1 materials have a reflectance of 1, which is taken for 0.95: the first is 'chalk'.");
  scene.materials[0].reflectance.r = 1.0001;
  EXPECT_TRUE(refusal_of(grpc::INVALID_ARGUMENT, [&] { store.add(scene, ""); }).starts_with("material 0"));
}

TEST(SceneStore, TellsOfFacesInThePlaceOfOthers) {
  SceneStore store;
  Scene scene = squares(2);
  const auto corners = scene.corners_of(scene.faces[1]);
  scene.add_face(std::vector(corners.begin(), corners.end()), 0);
  const auto stored = store.add(scene, "");
  EXPECT_EQ(stored->facts.face_count, 3u);
  EXPECT_EQ(stored->content()->mesh.roots().size(), 2u);
  ASSERT_EQ(stored->facts.warnings.size(), 1u);
  EXPECT_EQ(stored->facts.warnings[0],
            "1 faces lie in the place of others and were left out: the first is face 2, in the place of face 1.");
}

TEST(SceneStore, RefusesBadScenesByPlaceAndReason) {
  SceneStore store;
  for (const BadScene& bad : bad_scenes())
    EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { store.add(bad.scene, ""); }).find(bad.reason), 0u) << bad.reason;
  EXPECT_TRUE(store.list({}).items.empty());
}

TEST(SceneStore, KeepsScenesThatAreInUse) {
  SceneStore store;
  const std::string name = store.add(squares(1), "")->facts.name;
  {
    const SceneUse use = store.use(name);
    EXPECT_EQ(refusal_of(grpc::FAILED_PRECONDITION, [&] { store.remove(name); }),
              name + " has solves, or was added to one: delete these first");
  }
  store.remove(name);
  EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { store.find(name); }), name + " does not exist");
}

TEST(SceneStore, ListsNewestFirstInPagesThatNeverOverlap) {
  SceneStore store;
  const PageTokens tokens;
  for (int i = 0; i < 5; ++i) store.add(squares(1), std::to_string(i));
  std::string seen, token;
  do {
    const auto page = store.list(tokens.request(2, token));
    for (const auto& stored : page.items) seen += stored->facts.display_name;
    token = tokens.token(page.next_before);
    store.add(squares(1), "new");  // must not shift the pages that follow
  } while (!token.empty());
  EXPECT_EQ(seen, "43210");
}

TEST(PageTokens, ForeignOnesAreRefused) {
  const PageTokens ours, theirs;
  EXPECT_EQ(ours.request(0, ours.token(7)).before, 7u);
  for (const std::string& token : {theirs.token(7), std::string("7"), std::string(32, 'x'), std::string(32, '0')})
    EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { ours.request(0, token); }), "page_token: was not made by this server");
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { ours.request(-1, ""); }), "page_size: -1 is negative");
  EXPECT_EQ(ours.request(5000, "").size, 1000u);
}

v1::CreateSceneRequest chunk_of(const Scene& scene) {
  v1::CreateSceneRequest message;
  SceneSlicer(scene).next(*message.mutable_chunk());
  return message;
}

v1::CreateSceneRequest header() {
  v1::CreateSceneRequest message;
  message.mutable_scene()->set_display_name("room");
  return message;
}

TEST(SceneUpload, BeginsWithTheScene) {
  SceneStore store;
  SceneUpload upload({});
  const std::string too_late = "scene: the first message must set it";
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { upload.finish(store); }), too_late);
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { upload.add(chunk_of(squares(1))); }), too_late);
  upload.add(header());
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { upload.add(header()); }), "scene: only the first message may set it");
  upload.add(chunk_of(squares(1)));
  EXPECT_EQ(upload.finish(store)->facts.display_name, "room");
}

TEST(SceneUpload, EndsAtTheLimits) {
  const auto upload_with = [](const UploadLimits& limits) {
    SceneUpload upload(limits);
    upload.add(header());
    upload.add(chunk_of(squares(10)));
    upload.add(chunk_of(squares(10)));
  };
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { upload_with({.bytes = 1000}); }),
            "scene: more than 1000 bytes, the limit of this server");
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { upload_with({.corners = 79}); }),
            "scene: more than 79 corners, the limit of this server");
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { upload_with({.materials = 1}); }),
            "scene: more than 1 materials, the limit of this server");
  upload_with({.corners = 80, .materials = 2});
}

TEST(SceneUpload, OfManyLightsEndsAtTheLimits) {
  Scene scene = squares(1);
  scene.lights.resize(3);
  scene.lights[2].name = std::string(20, 'x');
  const auto upload_with = [&](const UploadLimits& limits) {
    SceneUpload upload(limits);
    upload.add(header());
    upload.add(chunk_of(scene));
  };
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { upload_with({.lights = 2}); }),
            "scene: more than 2 lights, the limit of this server");
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { upload_with({.bytes_of_name = 19}); }),
            "scene: more than 19 bytes in a light's name, the limit of this server");
  upload_with({.bytes_of_name = 20, .lights = 3});
}

}  // namespace
}  // namespace alvor
